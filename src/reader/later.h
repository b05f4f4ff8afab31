/* SPDX-License-Identifier: MIT
 * Elements and types of later years that this version does not know how to draw. They are told
 * apart from misspellings, so that a file of those years gets one plain sentence for each. What is
 * added to the tables of element.c leaves this one. */
#pragma once

#include "reader/element.h"

typedef struct GiLater {
    const char *name;
    GiKind kind;       /* of the types; GI_KIND_SCENE: an element */
    unsigned evidence; /* a set of GiEvidence */
} GiLater;

/* Name in any case; null when it is none of these elements. */
const GiLater *gi_later_element(const char *name);

/* Name exact, without the package; null when the kind has no such type in later years. */
const GiLater *gi_later_type(const char *name, GiKind kind);
