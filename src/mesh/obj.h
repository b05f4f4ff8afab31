/* SPDX-License-Identifier: MIT
 * The two passes over a Wavefront OBJ file, and what they share: lines and their keywords.
 */
#pragma once

#include "mesh/input.h"

#include <string.h>

/* How far ahead of what is read the text is fetched, in bytes: left to itself, a processor waits
 * for the memory for two thirds of the first pass. */
enum { GI_OBJ_AHEAD = 2048 };

/* ---------------------------------------------------------------- lines */

/* The length of a `\` with the end of line that it hides; 0 when there is none at p. */
static inline size_t gi_obj_continuation(const char *p, const char *end) {
    if (p == end || *p != '\\') return 0;
    if (end - p >= 2 && p[1] == '\n') return 2;
    return end - p >= 3 && p[1] == '\r' && p[2] == '\n' ? 3 : 0;
}

static inline const char *gi_obj_skip_blanks(const char *p, const char *end) {
    for (;;) {
        while (p < end && gi_mesh_is_blank(*p)) p++;
        size_t length = gi_obj_continuation(p, end);
        if (length == 0) return p;
        p += length;
    }
}

/* Where what counts of a line ends. */
static inline bool gi_obj_is_line_end(const char *p, const char *end) {
    return p == end || *p == '\n' || *p == '#';
}

static inline bool gi_obj_is_word_end(const char *p, const char *end) {
    return p == end || gi_mesh_is_space(*p) || gi_obj_continuation(p, end) > 0;
}

static inline const char *gi_obj_after_newline(const char *p, const char *end) {
    const char *newline = memchr(p, '\n', (size_t)(end - p));
    return newline != NULL ? newline + 1 : end;
}

/* Whether p, which follows a newline, begins a line that does not continue another. */
static inline bool gi_obj_begins_line(const char *text, const char *p) {
    const char *last = p - 1;
    if (last > text && last[-1] == '\r') last--;
    return last == text || last[-1] != '\\';
}

/* From within a line to the beginning of the next. */
static inline const char *gi_obj_skip_line(const char *p, const char *end) {
    if (p < end && *p == '\n') return p + 1;
    const char *text = p;
    do p = gi_obj_after_newline(p, end);
    while (p < end && !gi_obj_begins_line(text, p));
    return p;
}

/* From the beginning of a line to its keyword; past empty lines and comments. A line that is all
 * comment ends at its newline even after a `\`, since the names of folders end so. */
static inline const char *gi_obj_find_keyword(const char *p, const char *end) {
    for (;;) {
        p = gi_obj_skip_blanks(p, end);
        if (!gi_obj_is_line_end(p, end) || p == end) return p;
        p = gi_obj_after_newline(p, end);
    }
}

typedef enum GiObjKeyword {
    GI_OBJ_POSITION,
    GI_OBJ_NORMAL_VECTOR,
    GI_OBJ_TEXTURE,
    GI_OBJ_FACE,
    GI_OBJ_IGNORED,
    GI_OBJ_UNKNOWN
} GiObjKeyword;

/* Of all others: GI_OBJ_IGNORED or GI_OBJ_UNKNOWN. */
GiObjKeyword gi_obj_rare_keyword(const char *word, size_t length);

/* Reads the keyword at *p and moves past it. */
static inline GiObjKeyword gi_obj_read_keyword(const char **p, const char *end) {
    const char *word = *p, *q = word + 1;
    while (!gi_obj_is_word_end(q, end)) q++;
    *p = q;
    if (q - word == 1 && *word == 'v') return GI_OBJ_POSITION;
    if (q - word == 1 && *word == 'f') return GI_OBJ_FACE;
    if (q - word == 2 && word[0] == 'v' && word[1] == 'n') return GI_OBJ_NORMAL_VECTOR;
    if (q - word == 2 && word[0] == 'v' && word[1] == 't') return GI_OBJ_TEXTURE;
    return gi_obj_rare_keyword(word, (size_t)(q - word));
}

/* ---------------------------------------------------------------- counting */

/* What the lines of a chunk hold, and where the corners of its first face begin; null without one.
 * A chunk with a face of fewer than three corners, which is a fault, may count as having fewer
 * triangles than it has. */
GiMeshCounts gi_obj_count(const char *begin, const char *end, const char **face);

/* ---------------------------------------------------------------- parsing */

/* What faces do with an attribute, as bits. */
enum {
    GI_OBJ_NOT_USED = 1,   /* a face without it */
    GI_OBJ_USED_ALIKE = 2, /* a face whose positions have the same indices */
    GI_OBJ_USED_APART = 4
};

enum { GI_OBJ_NORMAL, GI_OBJ_TEXCOORD, GI_OBJ_ATTRIBUTE_COUNT };

typedef struct GiObj {
    GiMeshInput *input;
    GiMeshChunks chunks;
    GiMeshCounts *before; /* of each chunk, what lies before it; at the end the totals */
    GiMeshRoom room;
    uint32_t first_position, first[GI_OBJ_ATTRIBUTE_COUNT]; /* in the scene-wide arrays */
    GiCorners *own_corners[GI_OBJ_ATTRIBUTE_COUNT];         /* null: none yet */
    _Atomic unsigned use[GI_OBJ_ATTRIBUTE_COUNT];
} GiObj;

static inline bool gi_obj_needs_own_corners(unsigned use) {
    return (use & GI_OBJ_USED_APART) != 0 || use == (GI_OBJ_NOT_USED | GI_OBJ_USED_ALIKE);
}

/* The second pass: a chunk into its part of the room. A GiMeshChunkFn whose context is the GiObj;
 * false when something was refused, or own corners turned out to be needed. */
bool gi_obj_parse_chunk(void *obj, size_t chunk, int worker);
