/* SPDX-License-Identifier: MIT
 * Elements that are like one another. A large scene is the same few elements over and over, with
 * other numbers in them, and other names that they refer to:
 *
 *     <surface type="Sphere"><shader ref="m3"/><center>1 2 3</center><radius>4</radius></surface>
 *                                         ~~           ~~~~~         ~           ~
 *
 * The scanner remembers such an element by what it has on the tape, as a pattern with holes. Where
 * the next one has the same bytes between the holes it is well-formed, and its tokens are known;
 * the tape then only says which pattern it is like, and what stands in the holes. */
#pragma once

#include "reader/token.h"

#include <stdbool.h>
#include <stddef.h>

enum { GI_PATTERN_LIMIT = 32, GI_HOLE_LIMIT = 8, GI_PATTERN_ENTRY_LIMIT = 80 };

typedef struct GiHole {
    uint16_t begin, end; /* in bytes from where the element begins */
    uint8_t count;       /* of the numbers in it; 0: it is the value of an attribute */
} GiHole;

typedef struct GiPattern {
    uint32_t first; /* entry of the tape: the element's start tag */
    uint16_t size;  /* of the element, in bytes */
    uint8_t entry_count, hole_count;
    GiHole holes[GI_HOLE_LIMIT]; /* in the order of the file */
} GiPattern;

/* Makes a pattern of the entries from `first` on, up to `end`. False when they are anything but an
 * element of values and references: children that hold numbers, or are one tag with one
 * attribute. */
bool gi_pattern_learn(GiPattern *pattern, const GiTapeEntry *entries, size_t first, size_t end);

/* The entries that an element would have if it were like no other; `like` is what it has instead.
 * Of an end tag only the end is right, which is all that counts. Returns how many there are. */
int gi_pattern_expand(const GiPattern *pattern, const GiTapeEntry *entries, const GiTapeEntry *like,
    GiTapeEntry expanded[GI_PATTERN_ENTRY_LIMIT]);
