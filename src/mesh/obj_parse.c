/* SPDX-License-Identifier: MIT
 * The second pass over a Wavefront OBJ file: lines to positions, normals, texture coordinates and
 * triangles. Lines as nearly all are written take a shorter way, which refuses nothing: what it
 * does not take is left to the other. */
#include "mesh/obj.h"

#include "base/prefetch.h"
#include "math/bytes.h"
#include "math/digits.h"
#include "mesh/decimal.h"

typedef struct Parser {
    GiObj *obj;
    GiMeshInput *input;
    int worker;
    const char *p, *end;
    GiMeshCounts at, limit, total;
    unsigned use[GI_OBJ_ATTRIBUTE_COUNT];
} Parser;

/* Indices from 0 within the file; GI_SHAPE_NONE where there is none. */
typedef struct Corner {
    uint32_t position, other[GI_OBJ_ATTRIBUTE_COUNT];
} Corner;

/* Both passes count alike, unless another program writes to the file meanwhile. */
static bool has_room(Parser *parser, size_t at, size_t limit) {
    if (at < limit) return true;
    return gi_mesh_refuse(
        parser->input, parser->worker, parser->p, "the file changed while it was read");
}

/* Reads `wanted` numbers and checks that no more than `most` follow on the line. */
static bool read_numbers(Parser *parser, int wanted, int fewest, int most, float *values) {
    const char *p = parser->p;
    int count = 0;
    for (;; count++) {
        p = gi_obj_skip_blanks(p, parser->end);
        if (gi_obj_is_line_end(p, parser->end)) break;
        if (count == most) {
            return gi_mesh_refuse(parser->input, parser->worker, p,
                "expected the end of the line, found \"%s\"", gi_mesh_quote(p, parser->end).text);
        }
        float value;
        const char *number_end =
            gi_mesh_number(parser->input, parser->worker, p, parser->end, &value);
        if (number_end == NULL) return false;
        if (!gi_obj_is_word_end(number_end, parser->end)) {
            return gi_mesh_no_number(parser->input, parser->worker, p, parser->end);
        }
        if (count < wanted) values[count] = value;
        p = number_end;
    }
    parser->p = p;
    if (count >= fewest) return true;
    return gi_mesh_refuse(parser->input, parser->worker, p, "expected %d number%s, found %d",
        fewest, fewest == 1 ? "" : "s", count);
}

/* One index, which counts from 1, or from the end of what there is so far when negative. */
static bool read_index(
    Parser *parser, const char *what, int number, size_t so_far, size_t total, uint32_t *index) {
    const char *p = parser->p, *first = p;
    bool negative = p < parser->end && *p == '-';
    p += negative;
    const char *digits = p;
    uint64_t value = 0;
    p = gi_digits_read(p, parser->end, &value);
    if (p - digits > 18) value = INT64_MAX; /* it may have wrapped */
    if (p == digits) {
        return gi_mesh_refuse(parser->input, parser->worker, first,
            "face corner %d: expected a number, found \"%s\"", number,
            gi_mesh_quote(first, parser->end).text);
    }
    parser->p = p;
    size_t place = negative ? so_far - (size_t)value : (size_t)value - 1;
    if (value != 0 && place < total && (!negative || value <= so_far)) {
        *index = (uint32_t)place;
        return true;
    }
    if (value == 0) {
        return gi_mesh_refuse(parser->input, parser->worker, first,
            "face corner %d names %s 0, but they count from 1", number, what);
    }
    return gi_mesh_refuse(parser->input, parser->worker, first,
        "face corner %d names %s %s, but there are %zu%s", number, what,
        gi_mesh_quote(first, p).text, negative ? so_far : total, negative ? " so far" : "");
}

/* a, a/b, a//c or a/b/c; b and c may be empty. */
static inline bool read_corner(Parser *parser, int number, Corner *corner) {
    const char *end = parser->end, *word = parser->p;
    corner->other[GI_OBJ_NORMAL] = corner->other[GI_OBJ_TEXCOORD] = GI_SHAPE_NONE;
    if (!read_index(parser, "vertex", number, parser->at.positions, parser->total.positions,
            &corner->position)) {
        return false;
    }
    if (parser->p < end && *parser->p == '/') {
        parser->p++;
        if (!gi_obj_is_word_end(parser->p, end) && *parser->p != '/' &&
            !read_index(parser, "texture coordinate", number, parser->at.texcoords,
                parser->total.texcoords, &corner->other[GI_OBJ_TEXCOORD])) {
            return false;
        }
        if (parser->p < end && *parser->p == '/') {
            parser->p++;
            if (!gi_obj_is_word_end(parser->p, end) &&
                !read_index(parser, "normal", number, parser->at.normals, parser->total.normals,
                    &corner->other[GI_OBJ_NORMAL])) {
                return false;
            }
        }
    }
    if (gi_obj_is_word_end(parser->p, end)) return true;
    return gi_mesh_refuse(parser->input, parser->worker, word,
        "face corner %d is not a, a/b, a//c or a/b/c: \"%s\"", number,
        gi_mesh_quote(word, end).text);
}

/* ---------------------------------------------------------------- faces */

static inline void put_row(GiCorners *row, uint32_t first, uint32_t a, uint32_t b, uint32_t c) {
    (*row)[0] = first + a;
    (*row)[1] = first + b;
    (*row)[2] = first + c;
}

/* A face that is being read, as far as it is read. */
typedef struct Face {
    size_t begin; /* its first triangle */
    Corner first, last;
    bool missing[GI_OBJ_ATTRIBUTE_COUNT], apart[GI_OBJ_ATTRIBUTE_COUNT];
    int count; /* of corners */
} Face;

/* The first pass may have missed triangles where a face has too few corners: such a face is refused
 * when it is met, and until then what has no room is not kept. */
static inline void add_corner(Parser *parser, Face *face, const Corner *corner) {
    GiObj *obj = parser->obj;
    size_t at = parser->at.triangles;
    for (int i = 0; i < GI_OBJ_ATTRIBUTE_COUNT; i++) {
        face->missing[i] |= corner->other[i] == GI_SHAPE_NONE;
        face->apart[i] |= corner->other[i] != corner->position;
    }
    if (face->count == 0) face->first = *corner;
    if (face->count++ >= 2) {
        parser->at.triangles++;
        if (at < parser->limit.triangles) {
            put_row(&obj->room.corners[at], obj->first_position, face->first.position,
                face->last.position, corner->position);
            for (int i = 0; i < GI_OBJ_ATTRIBUTE_COUNT; i++) {
                if (obj->own_corners[i] == NULL) continue;
                put_row(&obj->own_corners[i][at], obj->first[i], face->first.other[i],
                    face->last.other[i], corner->other[i]);
            }
        }
    }
    face->last = *corner;
}

static inline void end_face(Parser *parser, const Face *face) {
    GiObj *obj = parser->obj;
    for (int i = 0; i < GI_OBJ_ATTRIBUTE_COUNT; i++) {
        parser->use[i] |= face->missing[i] ? GI_OBJ_NOT_USED
                          : face->apart[i] ? GI_OBJ_USED_APART
                                           : GI_OBJ_USED_ALIKE;
        if (!face->missing[i] || obj->own_corners[i] == NULL) continue;
        size_t end = parser->at.triangles, limit = parser->limit.triangles;
        for (size_t at = face->begin; at < end && at < limit; at++) {
            obj->own_corners[i][at][0] = GI_SHAPE_NONE;
        }
    }
}

static bool read_face(Parser *parser) {
    const char *line = parser->p;
    Face face = {.begin = parser->at.triangles};
    for (;;) {
        Corner corner;
        parser->p = gi_obj_skip_blanks(parser->p, parser->end);
        if (gi_obj_is_line_end(parser->p, parser->end)) break;
        if (!read_corner(parser, face.count + 1, &corner)) return false;
        add_corner(parser, &face, &corner);
    }
    if (face.count < 3) {
        return gi_mesh_refuse(parser->input, parser->worker, line,
            "a face has at least 3 corners, not %d", face.count);
    }
    end_face(parser, &face);
    return true;
}

/* ---------------------------------------------------------------- any line */

static bool read_line(Parser *parser) {
    GiObj *obj = parser->obj;
    GiMeshCounts *at = &parser->at, *limit = &parser->limit;
    const char *word = parser->p;
    float unused[3];
    switch (gi_obj_read_keyword(&parser->p, parser->end)) {
    case GI_OBJ_POSITION:
        /* Then a weight, a colour, or both. */
        return has_room(parser, at->positions, limit->positions) &&
               read_numbers(parser, 3, 3, 7, obj->room.positions[at->positions++]);
    case GI_OBJ_NORMAL_VECTOR:
        return has_room(parser, at->normals, limit->normals) &&
               read_numbers(parser, 3, 3, 3, obj->room.normals[at->normals++]);
    case GI_OBJ_TEXTURE:
        if (!has_room(parser, at->texcoords, limit->texcoords)) return false;
        unused[1] = 0;
        if (!read_numbers(parser, 2, 1, 3, unused)) return false;
        memcpy(obj->room.texcoords[at->texcoords++], unused, sizeof obj->room.texcoords[0]);
        return true;
    case GI_OBJ_FACE: return read_face(parser);
    case GI_OBJ_IGNORED: return true;
    case GI_OBJ_UNKNOWN: break;
    }
    return gi_mesh_refuse(parser->input, parser->worker, word, "unknown keyword \"%s\"",
        gi_mesh_quote(word, parser->p).text);
}

/* ---------------------------------------------------------------- plain lines
 * "v -1.5 0.25 3", "f 1/2/3 4/5/6 7/8/9": a keyword and words, each behind one blank, to the end of
 * the line. Where the words end is found for 64 bytes at once. A word begins where the mask says,
 * not where the reading of the word before it ended: so the processor need not wait for that, and
 * reads several at a time. */

typedef struct Words {
    const char *base;
    uint64_t spaces; /* in the 64 bytes from there; the lowest is before the next word */
} Words;

/* What is read at most from where a block begins: its last word may begin at its end. */
enum { LOOK_AHEAD = GI_BYTES + GI_DECIMAL_LOOK };

static inline bool begin_words(Words *words, const char *base, const char *end) {
    if (end - base < LOOK_AHEAD) return false;
    *words = (Words){base, gi_bytes_space(gi_bytes_load(base))};
    return words->spaces != 0;
}

/* The next word and its end, which is white space; false when it is too long or the file too
 * short. */
static inline bool next_word(
    Words *words, const char *end, const char **word, const char **word_end) {
    *word = words->base + __builtin_ctzll(words->spaces) + 1;
    words->spaces &= words->spaces - 1;
    if (words->spaces == 0 && !begin_words(words, *word, end)) return false;
    *word_end = words->base + __builtin_ctzll(words->spaces);
    return true;
}

/* Whether the line ends here, and where the next begins. */
static inline bool ends_line(const char *p, const char **next) {
    bool carriage_return = *p == '\r';
    *next = p + carriage_return + 1;
    return p[carriage_return] == '\n';
}

static inline bool read_plain_numbers(Parser *parser, Words words, int count, float *values) {
    const char *word, *word_end = parser->p, *next;
    for (int i = 0; i < count; i++) {
        /* What stands on the next line is no number of this one. */
        if (*word_end == '\n' || !next_word(&words, parser->end, &word, &word_end) ||
            gi_decimal_read_plain(word, &values[i]) != word_end) {
            return false;
        }
    }
    if (!ends_line(word_end, &next)) return false;
    parser->p = next;
    return true;
}

/* An index of one to seven digits, of something that there is. */
static inline bool read_plain_index(const char **p, size_t total, uint32_t *index) {
    uint64_t value;
    int count = gi_digits_eight(gi_eight_load(*p), &value);
    *p += count;
    *index = (uint32_t)value - 1;
    return count < 8 && *index < total; /* not without digits either, since -1 is large then */
}

/* a, a/b, a//c or a/b/c */
static inline bool read_plain_corner(
    const Parser *parser, const char *p, const char *end, Corner *corner) {
    corner->other[GI_OBJ_NORMAL] = corner->other[GI_OBJ_TEXCOORD] = GI_SHAPE_NONE;
    if (!read_plain_index(&p, parser->total.positions, &corner->position)) return false;
    if (*p != '/') return p == end;
    p++;
    if (*p != '/' &&
        !read_plain_index(&p, parser->total.texcoords, &corner->other[GI_OBJ_TEXCOORD])) {
        return false;
    }
    if (*p != '/') return p == end;
    p++;
    return read_plain_index(&p, parser->total.normals, &corner->other[GI_OBJ_NORMAL]) && p == end;
}

static inline bool read_plain_face(Parser *parser, Words words) {
    Face face = {.begin = parser->at.triangles};
    const char *word, *word_end, *next;
    do {
        Corner corner;
        if (!next_word(&words, parser->end, &word, &word_end) ||
            !read_plain_corner(parser, word, word_end, &corner)) {
            parser->at.triangles = face.begin;
            return false;
        }
        add_corner(parser, &face, &corner);
    } while (!ends_line(word_end, &next));
    if (face.count < 3) return false;
    end_face(parser, &face);
    parser->p = next;
    return true;
}

/* Takes the line at parser->p, where a line begins. False, and nothing has happened, when it is not
 * a plain one. */
static inline bool read_plain_line(Parser *parser) {
    GiMeshRoom *room = &parser->obj->room;
    GiMeshCounts *at = &parser->at, *limit = &parser->limit;
    const char *p = parser->p;
    Words words;
    bool taken = false;
    if (!begin_words(&words, p, parser->end)) return false;
    if (p[0] == 'f' && p[1] == ' ') return read_plain_face(parser, words);
    if (p[0] != 'v') return false;
    if (p[1] == ' ' && at->positions < limit->positions) {
        taken = read_plain_numbers(parser, words, 3, room->positions[at->positions]);
        at->positions += taken;
    } else if (p[1] == 'n' && p[2] == ' ' && at->normals < limit->normals) {
        taken = read_plain_numbers(parser, words, 3, room->normals[at->normals]);
        at->normals += taken;
    } else if (p[1] == 't' && p[2] == ' ' && at->texcoords < limit->texcoords) {
        taken = read_plain_numbers(parser, words, 2, room->texcoords[at->texcoords]);
        at->texcoords += taken;
    }
    return taken;
}

/* ---------------------------------------------------------------- the whole */

bool gi_obj_parse_chunk(void *context, size_t chunk, int worker) {
    GiObj *obj = context;
    const char *begin = obj->chunks.begin[chunk];
    Parser parser = {.obj = obj,
        .input = obj->input,
        .worker = worker,
        .p = begin,
        .end = obj->chunks.begin[chunk + 1],
        .at = obj->before[chunk],
        .limit = obj->before[chunk + 1],
        .total = obj->before[obj->chunks.count]};
    for (;;) {
        while (read_plain_line(&parser)) gi_prefetch_ahead(parser.p, GI_OBJ_AHEAD);
        parser.p = gi_obj_find_keyword(parser.p, parser.end);
        if (parser.p == parser.end) break;
        if (!read_line(&parser)) return false;
        parser.p = gi_obj_skip_line(parser.p, parser.end);
    }
    gi_mesh_forget(obj->input, begin, parser.end);
    bool guess_holds = true;
    for (int i = 0; i < GI_OBJ_ATTRIBUTE_COUNT; i++) {
        unsigned use = atomic_fetch_or(&obj->use[i], parser.use[i]) | parser.use[i];
        if (gi_obj_needs_own_corners(use) && obj->own_corners[i] == NULL) guess_holds = false;
    }
    return guess_holds &&
           (memcmp(&parser.at, &parser.limit, sizeof parser.at) == 0 || has_room(&parser, 1, 0));
}
