/* SPDX-License-Identifier: MIT
 * Wavefront OBJ, read twice. The first pass counts what each chunk holds, so that the second knows
 * where each chunk's results go and what its relative indices count from: all chunks are parsed at
 * once, straight into arrays of the right size.
 *
 * Most files give a corner one index for position, normal and texcoord; such need no corners of
 * their own for the latter. Whether that is so is known at the end only: it is guessed before the
 * second pass, and where the guess was wrong the pass is repeated with room for those corners. */
#include "mesh/obj.h"

#include "base/prefetch.h"
#include "mesh/digits.h"

/* What faces do with an attribute, as bits. */
enum {
    NOT_USED = 1,   /* a face without it */
    USED_ALIKE = 2, /* a face whose positions have the same indices */
    USED_APART = 4
};

enum { NORMAL, TEXCOORD, ATTRIBUTE_COUNT };

typedef struct Obj {
    GiMeshInput *input;
    GiMeshChunks chunks;
    GiMeshCounts *before; /* of each chunk, what lies before it; at the end the totals */
    GiMeshRoom room;
    uint32_t first_position, first[ATTRIBUTE_COUNT]; /* in the scene-wide arrays */
    GiCorners *own_corners[ATTRIBUTE_COUNT];         /* null: none yet */
    _Atomic unsigned use[ATTRIBUTE_COUNT];
} Obj;

/* ---------------------------------------------------------------- counting */

/* Whether a corner has different indices, as far as text tells. */
static bool is_apart(const char *p, const char *end, int attribute) {
    const char *part[3] = {p, NULL, NULL}; /* position, texcoord, normal */
    size_t length[3] = {0};
    int count = 0;
    for (; !gi_obj_is_word_end(p, end) && count < 3; p++) {
        if (*p != '/') {
            length[count]++;
        } else if (++count < 3) {
            part[count] = p + 1;
        }
    }
    int other = attribute == NORMAL ? 2 : 1;
    return length[other] > 0 &&
           (length[other] != length[0] || memcmp(part[0], part[other], length[0]) != 0);
}

static bool count_chunk(void *context, size_t chunk, int worker) {
    Obj *obj = context;
    const char *begin = obj->chunks.begin[chunk], *end = obj->chunks.begin[chunk + 1], *face;
    obj->before[chunk] = gi_obj_count(begin, end, &face);
    /* A look at one face of each chunk is enough to guess. */
    for (int i = 0; i < ATTRIBUTE_COUNT && face != NULL; i++) {
        if (is_apart(gi_obj_skip_blanks(face, end), end, i)) {
            atomic_store(&obj->use[i], USED_APART);
        }
    }
    gi_mesh_forget(obj->input, begin, end);
    (void)worker;
    return true;
}

static void add_up(GiMeshCounts *before, size_t chunk_count) {
    GiMeshCounts sum = {0};
    for (size_t i = 0; i <= chunk_count; i++) {
        GiMeshCounts counts = i < chunk_count ? before[i] : (GiMeshCounts){0};
        before[i] = sum;
        sum.positions += counts.positions;
        sum.normals += counts.normals;
        sum.texcoords += counts.texcoords;
        sum.triangles += counts.triangles;
    }
}

/* ---------------------------------------------------------------- parsing */

typedef struct Parser {
    Obj *obj;
    GiMeshInput *input;
    int worker;
    const char *p, *end;
    GiMeshCounts at, limit, total;
    unsigned use[ATTRIBUTE_COUNT];
} Parser;

/* Indices from 0 within the file; GI_SHAPE_NONE where there is none. */
typedef struct Corner {
    uint32_t position, other[ATTRIBUTE_COUNT];
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

/* Whether all of a corner is an index that was just read, from `word` to p, and // and the same
 * digits: mostly a vertex has a normal of its own. It need not be so where this says no. */
static inline bool repeats_index(const char *word, const char *p, const char *end) {
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    ptrdiff_t length = p - word;
    if (length > 8 || end - p < 10 || *word == '-' || p[0] != '/' || p[1] != '/') return false;
    uint64_t first, second;
    memcpy(&first, word, sizeof first);
    memcpy(&second, p + 2, sizeof second);
    return (first ^ second) << (64 - 8 * length) == 0 && gi_obj_is_word_end(p + 2 + length, end);
#else
    (void)word, (void)p, (void)end;
    return false;
#endif
}

/* a, a/b, a//c or a/b/c; b and c may be empty. */
static inline bool read_corner(Parser *parser, int number, Corner *corner) {
    const char *end = parser->end, *word = parser->p;
    corner->other[NORMAL] = corner->other[TEXCOORD] = GI_SHAPE_NONE;
    if (!read_index(parser, "vertex", number, parser->at.positions, parser->total.positions,
            &corner->position)) {
        return false;
    }
    if (repeats_index(word, parser->p, end) && corner->position < parser->total.normals) {
        corner->other[NORMAL] = corner->position;
        parser->p += 2 + (parser->p - word);
        return true;
    }
    if (parser->p < end && *parser->p == '/') {
        parser->p++;
        if (!gi_obj_is_word_end(parser->p, end) && *parser->p != '/' &&
            !read_index(parser, "texture coordinate", number, parser->at.texcoords,
                parser->total.texcoords, &corner->other[TEXCOORD])) {
            return false;
        }
        if (parser->p < end && *parser->p == '/') {
            parser->p++;
            if (!gi_obj_is_word_end(parser->p, end) &&
                !read_index(parser, "normal", number, parser->at.normals, parser->total.normals,
                    &corner->other[NORMAL])) {
                return false;
            }
        }
    }
    if (gi_obj_is_word_end(parser->p, end)) return true;
    return gi_mesh_refuse(parser->input, parser->worker, word,
        "face corner %d is not a, a/b, a//c or a/b/c: \"%s\"", number,
        gi_mesh_quote(word, end).text);
}

static inline void put_row(GiCorners *row, uint32_t first, uint32_t a, uint32_t b, uint32_t c) {
    (*row)[0] = first + a;
    (*row)[1] = first + b;
    (*row)[2] = first + c;
}

static inline void put_triangle(
    Parser *parser, size_t at, const Corner *first, const Corner *last, const Corner *corner) {
    Obj *obj = parser->obj;
    put_row(&obj->room.corners[at], obj->first_position, first->position, last->position,
        corner->position);
    for (int i = 0; i < ATTRIBUTE_COUNT; i++) {
        if (obj->own_corners[i] == NULL) continue;
        put_row(&obj->own_corners[i][at], obj->first[i], first->other[i], last->other[i],
            corner->other[i]);
    }
}

static bool read_face(Parser *parser) {
    Obj *obj = parser->obj;
    const char *line = parser->p;
    size_t begin = parser->at.triangles;
    Corner first = {0}, last = {0}, corner;
    bool missing[ATTRIBUTE_COUNT] = {false}, apart[ATTRIBUTE_COUNT] = {false};
    int count = 0;
    for (;; count++) {
        parser->p = gi_obj_skip_blanks(parser->p, parser->end);
        if (gi_obj_is_line_end(parser->p, parser->end)) break;
        if (!read_corner(parser, count + 1, &corner)) return false;
        for (int i = 0; i < ATTRIBUTE_COUNT; i++) {
            missing[i] |= corner.other[i] == GI_SHAPE_NONE;
            apart[i] |= corner.other[i] != corner.position;
        }
        if (count == 0) first = corner;
        if (count >= 2) {
            /* The first pass may have missed some where a face has too few corners: that face is
             * refused when it is met. */
            size_t at = parser->at.triangles++;
            if (at < parser->limit.triangles) put_triangle(parser, at, &first, &last, &corner);
        }
        last = corner;
    }
    if (count < 3) {
        return gi_mesh_refuse(
            parser->input, parser->worker, line, "a face has at least 3 corners, not %d", count);
    }
    for (int i = 0; i < ATTRIBUTE_COUNT; i++) {
        parser->use[i] |= missing[i] ? NOT_USED : apart[i] ? USED_APART : USED_ALIKE;
        if (!missing[i] || obj->own_corners[i] == NULL) continue;
        for (size_t at = begin; at < parser->at.triangles && at < parser->limit.triangles; at++) {
            obj->own_corners[i][at][0] = GI_SHAPE_NONE;
        }
    }
    return true;
}

static bool read_line(Parser *parser) {
    Obj *obj = parser->obj;
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

static bool needs_own_corners(unsigned use) {
    return (use & USED_APART) != 0 || use == (NOT_USED | USED_ALIKE);
}

static bool parse_chunk(void *context, size_t chunk, int worker) {
    Obj *obj = context;
    const char *begin = obj->chunks.begin[chunk];
    Parser parser = {.obj = obj,
        .input = obj->input,
        .worker = worker,
        .p = begin,
        .end = obj->chunks.begin[chunk + 1],
        .at = obj->before[chunk],
        .limit = obj->before[chunk + 1],
        .total = obj->before[obj->chunks.count]};
    while ((parser.p = gi_obj_find_keyword(parser.p, parser.end)) < parser.end) {
        gi_prefetch_ahead(parser.p, GI_OBJ_AHEAD);
        if (!read_line(&parser)) return false;
        parser.p = gi_obj_skip_line(parser.p, parser.end);
    }
    gi_mesh_forget(obj->input, begin, parser.end);
    bool guess_holds = true;
    for (int i = 0; i < ATTRIBUTE_COUNT; i++) {
        unsigned use = atomic_fetch_or(&obj->use[i], parser.use[i]) | parser.use[i];
        if (needs_own_corners(use) && obj->own_corners[i] == NULL) guess_holds = false;
    }
    return guess_holds &&
           (memcmp(&parser.at, &parser.limit, sizeof parser.at) == 0 || has_room(&parser, 1, 0));
}

/* ---------------------------------------------------------------- the whole */

static bool is_border(const GiMeshInput *input, const char *p) {
    return p[-1] == '\n' && gi_obj_begins_line(input->text, p);
}

/* Bytes; not 0 even for the faces without triangles of a faulty file. */
static size_t own_size(size_t triangle_count) {
    return (triangle_count > 0 ? triangle_count : 1) * sizeof(GiCorners);
}

static GlintStatus allocate_own_corners(Obj *obj, size_t triangle_count, bool *added) {
    *added = false;
    for (int i = 0; i < ATTRIBUTE_COUNT; i++) {
        if (!needs_own_corners(atomic_load(&obj->use[i])) || obj->own_corners[i] != NULL) continue;
        obj->own_corners[i] = gi_memory_allocate(obj->input->memory, own_size(triangle_count));
        if (obj->own_corners[i] == NULL) {
            return gi_mesh_fault(obj->input->fault, GLINT_ERROR_MEMORY, "not enough memory");
        }
        *added = true;
    }
    return GLINT_OK;
}

/* The second pass, again while a guess was wrong. */
static GlintStatus parse(Obj *obj, size_t triangle_count) {
    GiMeshInput *input = obj->input;
    for (;;) {
        bool added;
        GlintStatus status = allocate_own_corners(obj, triangle_count, &added);
        if (status != GLINT_OK) return status;
        for (int i = 0; i < ATTRIBUTE_COUNT; i++) atomic_store(&obj->use[i], 0);
        memset(input->findings, 0, (size_t)input->worker_count * sizeof *input->findings);
        gi_mesh_run(input, obj->chunks.count, parse_chunk, obj);
        bool again = false;
        for (int i = 0; i < ATTRIBUTE_COUNT; i++) {
            again |= needs_own_corners(atomic_load(&obj->use[i])) && obj->own_corners[i] == NULL;
        }
        if (!again || atomic_load(&input->stop) != GLINT_OK) return gi_mesh_input_status(input);
    }
}

static void free_own_corners(Obj *obj, int attribute, size_t triangle_count) {
    gi_memory_free(obj->input->memory, obj->own_corners[attribute], own_size(triangle_count));
    obj->own_corners[attribute] = NULL;
}

static GlintStatus build(Obj *obj, GiMeshStore *store, uint32_t *index) {
    GiMeshInput *input = obj->input;
    const GiMeshCounts *totals = &obj->before[obj->chunks.count];
    GiMesh mesh;
    GlintStatus status =
        gi_mesh_begin(store, input->memory, totals, &mesh, &obj->room, input->fault);
    if (status != GLINT_OK) return status;
    obj->first_position = mesh.first_position;
    obj->first[NORMAL] = mesh.first_normal;
    obj->first[TEXCOORD] = mesh.first_texcoord;
    status = parse(obj, totals->triangles);
    bool used[ATTRIBUTE_COUNT];
    for (int i = 0; i < ATTRIBUTE_COUNT; i++) {
        unsigned use = atomic_load(&obj->use[i]);
        used[i] = (use & (USED_ALIKE | USED_APART)) != 0;
        if (status != GLINT_OK || !needs_own_corners(use)) {
            free_own_corners(obj, i, totals->triangles);
        }
    }
    if (status != GLINT_OK) return status;
    status = gi_mesh_check_triangles(totals->triangles, input->fault);
    if (status != GLINT_OK) return status;
    mesh.smooth = used[NORMAL];
    mesh.textured = used[TEXCOORD];
    mesh.normal_corners = obj->own_corners[NORMAL];
    mesh.texcoord_corners = obj->own_corners[TEXCOORD];
    *index = gi_mesh_end(store, input->memory, totals, &mesh);
    return GLINT_OK;
}

GlintStatus gi_mesh_parse_obj(GiMeshInput *input, GiMeshStore *store, uint32_t *mesh) {
    Obj obj = {.input = input};
    GlintStatus status = gi_mesh_chunks_init(&obj.chunks, input, input->text, is_border);
    if (status != GLINT_OK) return status;
    size_t size = (obj.chunks.count + 1) * sizeof *obj.before;
    obj.before = gi_memory_allocate(input->memory, size);
    if (obj.before == NULL) {
        status = gi_mesh_fault(input->fault, GLINT_ERROR_MEMORY, "not enough memory");
    } else {
        gi_mesh_run(input, obj.chunks.count, count_chunk, &obj);
        status = gi_mesh_input_status(input);
        add_up(obj.before, obj.chunks.count);
        if (status == GLINT_OK) status = build(&obj, store, mesh);
    }
    gi_memory_free(input->memory, obj.before, size);
    gi_mesh_chunks_reset(&obj.chunks, input);
    return status;
}
