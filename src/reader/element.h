/* SPDX-License-Identifier: MIT
 * What a scene may contain, as two tables: the elements and the types of the elements that have
 * one. The reader is driven by them; so are the schema, the documentation of the format and shell
 * completion, which is why a row also carries its default as text and a line of help. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The places an element can stand in: the scene, the camera, and one per type that has children. */
typedef enum GiContext {
    GI_IN_SCENE = 1 << 0,
    GI_IN_CAMERA = 1 << 1,
    GI_IN_SPHERE = 1 << 2,
    GI_IN_BOX = 1 << 3,
    GI_IN_CYLINDER = 1 << 4,
    GI_IN_CONE = 1 << 5,
    GI_IN_PLANE = 1 << 6,
    GI_IN_DISC = 1 << 7,
    GI_IN_GROUP = 1 << 8,
    GI_IN_LAMBERTIAN = 1 << 9,
    GI_IN_PHONG = 1 << 10,
    GI_IN_RGB_NORMALS = 1 << 11,
    GI_IN_POINT_LIGHT = 1 << 12,
    GI_IN_AMBIENT_LIGHT = 1 << 13,
    GI_IN_CONSTANT_LIGHT = 1 << 14,
    GI_IN_NORMAL_LIGHT = 1 << 15
} GiContext;

#define GI_IN_ANY_SURFACE ((1u << 9) - (1u << 2))
#define GI_IN_ANY_SHADER  ((1u << 12) - (1u << 9))
#define GI_IN_ANY_LIGHT   ((1u << 16) - (1u << 12))

typedef enum GiKind {
    GI_KIND_REAL,
    GI_KIND_INTEGER,
    GI_KIND_INTEGER_PAIR,
    GI_KIND_VECTOR,
    GI_KIND_POINT,
    GI_KIND_COLOR,
    GI_KIND_CHOICE, /* one of the words in `choices`; its value is the number of the word */
    GI_KIND_SCENE,  /* from here on: elements with children */
    GI_KIND_CAMERA,
    GI_KIND_SURFACE,
    GI_KIND_SHADER,
    GI_KIND_LIGHT
} GiKind;

typedef enum GiCheck {
    GI_CHECK_NONE,
    GI_CHECK_POSITIVE,
    GI_CHECK_SAMPLES, /* at most GI_SAMPLES_LIMIT; 0 is read as 1 */
    GI_CHECK_LENGTH,  /* a vector that is not zero */
    GI_CHECK_NO_ZERO, /* no component is zero */
    GI_CHECK_ANGLE,   /* between 0 and 180, both excluded */
    GI_CHECK_IMAGE_SIZE
} GiCheck;

/* Where a value goes. Aliases share a slot. */
typedef enum GiSlot {
    GI_SLOT_NONE,
    GI_SLOT_VIEW_POINT,
    GI_SLOT_VIEW_DIR,
    GI_SLOT_VIEW_UP,
    GI_SLOT_PROJ_NORMAL,
    GI_SLOT_PROJ_DISTANCE,
    GI_SLOT_VIEW_WIDTH,
    GI_SLOT_VIEW_HEIGHT,
    GI_SLOT_CENTER,
    GI_SLOT_RADIUS,
    GI_SLOT_HEIGHT,
    GI_SLOT_TIPZ,
    GI_SLOT_THETA,
    GI_SLOT_MIN_PT,
    GI_SLOT_MAX_PT,
    GI_SLOT_POINT,
    GI_SLOT_NORMAL,
    GI_SLOT_DIFFUSE,
    GI_SLOT_SPECULAR,
    GI_SLOT_EXPONENT,
    GI_SLOT_POSITION,
    GI_SLOT_INTENSITY,
    GI_SLOT_FALLOFF,
    GI_SLOT_IMAGE,
    GI_SLOT_SAMPLES,
    GI_SLOT_BACK_COLOR,
    GI_SLOT_EXPOSURE,
    GI_SLOT_TRANSLATE,
    GI_SLOT_ROTATE,
    GI_SLOT_SCALE,
    GI_SLOT_COUNT
} GiSlot;

typedef struct GiElement {
    const char *name; /* as documented; files may write it in any case */
    uint32_t contexts;
    GiKind kind;
    GiSlot slot;
    const char *default_text; /* null: required, or nothing */
    GiCheck check;
    unsigned evidence;    /* a set of GiEvidence: which year it points to */
    const char *choices;  /* words separated by spaces */
    const char *alias_of; /* null, or the name of the main row */
    const char *help;
} GiElement;

typedef struct GiType {
    const char *name; /* exact */
    GiKind kind;
    uint32_t context; /* of its children */
    int value;        /* GlintSurfaceType and so on */
    unsigned evidence;
    const char *alias_of;
    const char *help;
} GiType;

extern const GiElement gi_elements[]; /* ends with a null name; row 0 is the scene */
extern const GiType gi_types[];       /* the same */

/* A hash of the element names, made once per reader. */
enum { GI_ELEMENT_LIMIT = 64, GI_ELEMENT_SLOT_COUNT = 128 };
typedef struct GiElementIndex {
    uint8_t first[GI_ELEMENT_SLOT_COUNT]; /* row + 1 */
    uint8_t next[GI_ELEMENT_LIMIT];       /* row + 1 */
    uint8_t after[GI_ELEMENT_LIMIT + 1];  /* row + 1 of what came after a row last time */
    uint8_t last;                         /* row + 1 */
} GiElementIndex;

void gi_element_index_init(GiElementIndex *index);

/* The element of that name (in any case) that may stand in one of the contexts, or null. */
const GiElement *gi_element_find(const GiElementIndex *index, const char *name, uint32_t contexts);

/* The same for the next element of a file: elements mostly follow each other as they did before. */
const GiElement *gi_element_guess(GiElementIndex *index, const char *name, uint32_t contexts);

/* Name exact, without the package. Null when the kind has no such type. */
const GiType *gi_type_find(const char *name, GiKind kind);

/* "a point", "a surface", ... */
const char *gi_kind_text(GiKind kind);
/* How many numbers a value of that kind has; 0 for objects. */
int gi_kind_count(GiKind kind);
/* All contexts of the types of a kind of object. */
uint32_t gi_kind_contexts(GiKind kind);

static inline bool gi_kind_is_object(GiKind kind) { return kind >= GI_KIND_SCENE; }

/* "the scene", "a Sphere, Cylinder or Cone surface, a camera or a Group surface". */
void gi_context_text(uint32_t contexts, char *buffer, size_t size);
/* "Sphere, Box or Cone": all types of a kind but aliases. */
void gi_type_list_text(GiKind kind, char *buffer, size_t size);

static inline char gi_lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c + 32) : c; }
