/* SPDX-License-Identifier: MIT
 * The first pass over a Wavefront OBJ file: how many there are of what. Nearly all chunks are of
 * plain lines, each on its own and beginning with its keyword; those are counted 64 bytes at a
 * time, the others line by line. */
#include "mesh/obj.h"

#include "base/prefetch.h"
#include "math/bytes.h"

GiObjKeyword gi_obj_rare_keyword(const char *word, size_t length) {
    /* Names, materials and hints; then lines, points and what belongs to curves. */
    static const char ignored[][13] = {"o", "g", "s", "mg", "usemtl", "mtllib", "usemap", "maplib",
        "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "l", "p", "vp"};
    for (size_t i = 0; i < sizeof ignored / sizeof ignored[0]; i++) {
        if (strlen(ignored[i]) == length && memcmp(ignored[i], word, length) == 0)
            return GI_OBJ_IGNORED;
    }
    return GI_OBJ_UNKNOWN;
}

/* ---------------------------------------------------------------- any lines */

/* Stops at the end of the line. */
static size_t count_words(const char **line, const char *end) {
    const char *p = *line;
    size_t count = 0;
    for (;; count++) {
        p = gi_obj_skip_blanks(p, end);
        if (gi_obj_is_line_end(p, end)) break;
        do p++;
        while (!gi_obj_is_word_end(p, end));
    }
    *line = p;
    return count;
}

static GiMeshCounts count_lines(const char *p, const char *end, const char **face) {
    GiMeshCounts counts = {0};
    *face = NULL;
    while ((p = gi_obj_find_keyword(p, end)) < end) {
        switch (gi_obj_read_keyword(&p, end)) {
        case GI_OBJ_POSITION: counts.positions++; break;
        case GI_OBJ_NORMAL_VECTOR: counts.normals++; break;
        case GI_OBJ_TEXTURE: counts.texcoords++; break;
        case GI_OBJ_FACE: {
            if (*face == NULL) *face = p;
            size_t words = count_words(&p, end);
            counts.triangles += words > 2 ? words - 2 : 0;
            break;
        }
        case GI_OBJ_IGNORED:
        case GI_OBJ_UNKNOWN: break;
        }
        p = gi_obj_skip_line(p, end);
    }
    return counts;
}

/* ---------------------------------------------------------------- plain lines */

/* What reaches from one block of 64 bytes into the next, each 0 or 1, and what was counted. */
typedef struct Counter {
    uint64_t begins_line, after_space, after_backslash, in_face;
    GiMeshCounts counts;           /* but of the triangles */
    size_t face_count, word_count; /* words of faces, with the keywords */
    const char *face;
} Counter;

/* The line that begins at p, of which three bytes may be read. False when it is indented. */
static inline bool count_line(Counter *counter, const char *p, bool *is_face) {
    *is_face = *p == 'f' && gi_mesh_is_space(p[1]);
    if (*is_face) {
        counter->face_count++;
    } else if (*p == 'v') {
        bool word_ends = gi_mesh_is_space(p[2]);
        counter->counts.positions += gi_mesh_is_space(p[1]);
        counter->counts.normals += p[1] == 'n' && word_ends;
        counter->counts.texcoords += p[1] == 't' && word_ends;
    } else if (gi_mesh_is_blank(*p)) {
        return *p == '\r' && p[1] == '\n';
    }
    return true;
}

/* The block at p, of which two bytes more than that may be read; `text` is where it stands in the
 * file. False when its lines are not plain. */
static bool count_block(Counter *counter, const char *p, const char *text) {
    GiBytes bytes = gi_bytes_load(p);
    uint64_t newline = gi_bytes_equal(bytes, '\n'), space = gi_bytes_space(bytes);
    uint64_t backslash = gi_bytes_equal(bytes, '\\'), comment = gi_bytes_equal(bytes, '#');
    if (((backslash << 1 | counter->after_backslash) & space) != 0) return false;
    uint64_t faces = counter->in_face; /* where they begin */
    for (uint64_t rest = newline << 1 | counter->begins_line; rest != 0; rest &= rest - 1) {
        int i = __builtin_ctzll(rest);
        bool is_face;
        if (!count_line(counter, p + i, &is_face)) return false;
        faces |= (uint64_t)is_face << i;
        if (is_face && counter->face == NULL) counter->face = text + i + 1;
    }
    /* Each bit of a face borrows from the next newline, so that all between them are set. */
    uint64_t inside = newline - faces;
    uint64_t words = ~space & (space << 1 | counter->after_space);
    if ((comment & inside) != 0) return false;
    counter->word_count += (size_t)gi_bytes_count(words & inside);
    counter->in_face = faces > newline;
    counter->begins_line = newline >> (GI_BYTES - 1);
    counter->after_space = space >> (GI_BYTES - 1);
    counter->after_backslash = backslash >> (GI_BYTES - 1);
    return true;
}

/* False when not all lines are plain, or a face has fewer than two corners, as far as that can be
 * seen from their sum. */
static bool count_plain(
    const char *begin, const char *end, GiMeshCounts *counts, const char **face) {
    enum { LOOK_AHEAD = 2 };
    Counter counter = {.begins_line = 1, .after_space = 1};
    for (const char *p = begin; p < end; p += GI_BYTES) {
        char last[GI_BYTES + LOOK_AHEAD];
        bool whole = end - p >= GI_BYTES + LOOK_AHEAD;
        gi_prefetch_ahead(p, GI_OBJ_AHEAD);
        if (!whole) {
            memset(last, '\n', sizeof last);
            memcpy(last, p, (size_t)(end - p));
        }
        if (!count_block(&counter, whole ? p : last, p)) return false;
    }
    if (counter.word_count < 3 * counter.face_count) return false;
    *counts = counter.counts;
    counts->triangles = counter.word_count - 3 * counter.face_count;
    *face = counter.face;
    return true;
}

/* ---------------------------------------------------------------- the whole */

GiMeshCounts gi_obj_count(const char *begin, const char *end, const char **face) {
    GiMeshCounts counts;
    return count_plain(begin, end, &counts, face) ? counts : count_lines(begin, end, face);
}
