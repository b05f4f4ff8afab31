/* SPDX-License-Identifier: MIT
 * What `name` attributes have named so far: a hash map from the name to what it stands for. */
#pragma once

#include "base/array.h"
#include "reader/element.h"
#include "reader/span.h"
#include "shape/shape.h"

typedef struct GiNamed {
    uint32_t text; /* into the map's text */
    uint32_t size; /* of the name */
    uint32_t hash;
    uint8_t kind;   /* GiKind */
    bool broken;    /* its definition has an error, which is reported: a use of it is not another */
    uint32_t index; /* of the values, cameras, shaders, lights, meshes or pictures */
    GiShapeRef shape;
} GiNamed;

typedef struct GiNames {
    GiMemory *memory;
    uint32_t seed; /* of the hash: a file cannot know which names will collide */
    GI_ARRAY(char) text;
    GI_ARRAY(GiNamed) entries;
    GI_ARRAY(GiVec) values; /* of value elements */
    uint32_t *slots;        /* entry + 1; a power of two of them, at most half full */
    size_t slot_count;
} GiNames;

void gi_names_init(GiNames *names, GiMemory *memory);
void gi_names_reset(GiNames *names);

/* Remembers, or replaces. False when memory is short. */
bool gi_names_set(GiNames *names, GiSpan name, GiNamed named);

/* Null when there is none. Valid until the next set. */
const GiNamed *gi_names_get(const GiNames *names, GiSpan name);

/* The number of the name's entry, which it gets now when there is none. False when memory is short.
 */
bool gi_names_intern(GiNames *names, GiSpan name, uint32_t *number);

/* The nearest name, or null. */
const char *gi_names_suggest(const GiNames *names, GiSpan name);
