/* SPDX-License-Identifier: MIT
 * Wavefront OBJ, read twice. The first pass counts what each chunk holds, so that the second knows
 * where each chunk's results go and what its relative indices count from: all chunks are parsed at
 * once, straight into arrays of the right size.
 *
 * Most files give a corner one index for position, normal and texcoord; such need no corners of
 * their own for the latter. Whether that is so is known at the end only: it is guessed before the
 * second pass, and where the guess was wrong the pass is repeated with room for those corners. */
#include "mesh/digits.h"
#include "mesh/input.h"

#include <string.h>

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

/* ---------------------------------------------------------------- lines */

/* The length of a `\` with the end of line that it hides; 0 when there is none at p. */
static inline size_t continuation(const char *p, const char *end) {
    if (p == end || *p != '\\') return 0;
    if (end - p >= 2 && p[1] == '\n') return 2;
    return end - p >= 3 && p[1] == '\r' && p[2] == '\n' ? 3 : 0;
}

static inline const char *skip_blanks(const char *p, const char *end) {
    for (;;) {
        while (p < end && gi_mesh_is_blank(*p)) p++;
        size_t length = continuation(p, end);
        if (length == 0) return p;
        p += length;
    }
}

/* Where what counts of a line ends. */
static inline bool is_line_end(const char *p, const char *end) {
    return p == end || *p == '\n' || *p == '#';
}

static inline bool is_word_end(const char *p, const char *end) {
    return p == end || gi_mesh_is_space(*p) || continuation(p, end) > 0;
}

static const char *after_newline(const char *p, const char *end) {
    const char *newline = memchr(p, '\n', (size_t)(end - p));
    return newline != NULL ? newline + 1 : end;
}

/* Whether p, which follows a newline, begins a line that does not continue another. */
static bool begins_line(const char *text, const char *p) {
    const char *last = p - 1;
    if (last > text && last[-1] == '\r') last--;
    return last == text || last[-1] != '\\';
}

static bool is_border(const GiMeshInput *input, const char *p) {
    return p[-1] == '\n' && begins_line(input->text, p);
}

/* From within a line to the beginning of the next. */
static inline const char *skip_line(const char *p, const char *end) {
    if (p < end && *p == '\n') return p + 1;
    const char *text = p;
    do p = after_newline(p, end);
    while (p < end && !begins_line(text, p));
    return p;
}

/* From the beginning of a line to its keyword; past empty lines and comments. A line that is all
 * comment ends at its newline even after a `\`, since the names of folders end so. */
static inline const char *find_keyword(const char *p, const char *end) {
    for (;;) {
        p = skip_blanks(p, end);
        if (!is_line_end(p, end) || p == end) return p;
        p = after_newline(p, end);
    }
}

typedef enum Keyword { POSITION, NORMAL_VECTOR, TEXTURE, FACE, IGNORED, UNKNOWN } Keyword;

static Keyword rare_keyword(const char *word, size_t length) {
    /* Names, materials and hints; then lines, points and what belongs to curves. */
    static const char ignored[][13] = {"o", "g", "s", "mg", "usemtl", "mtllib", "usemap", "maplib",
        "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "l", "p", "vp"};
    for (size_t i = 0; i < sizeof ignored / sizeof ignored[0]; i++) {
        if (strlen(ignored[i]) == length && memcmp(ignored[i], word, length) == 0) return IGNORED;
    }
    return UNKNOWN;
}

/* Reads the keyword at *p and moves past it. */
static inline Keyword read_keyword(const char **p, const char *end) {
    const char *word = *p, *q = word + 1;
    while (!is_word_end(q, end)) q++;
    *p = q;
    if (q - word == 1 && *word == 'v') return POSITION;
    if (q - word == 1 && *word == 'f') return FACE;
    if (q - word == 2 && word[0] == 'v' && word[1] == 'n') return NORMAL_VECTOR;
    if (q - word == 2 && word[0] == 'v' && word[1] == 't') return TEXTURE;
    return rare_keyword(word, (size_t)(q - word));
}

/* ---------------------------------------------------------------- counting */

/* The same for a line of words and blanks alone, eight bytes at a time: where words end need not be
 * guessed then. False where the line has anything else, or the chunk ends too soon. */
static bool count_plain_words(const char **line, const char *end, size_t *count) {
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    /* High bits tell of bytes. `equal` may also set some above the lowest that it should. */
    const uint64_t ones = UINT64_C(0x0101010101010101), high = 0x80 * ones;
#define EQUAL(c) (((bytes ^ (c)*ones) - ones) & ~(bytes ^ (c)*ones) & high)
    uint64_t blank_before = 0x80, bytes;
    for (const char *p = *line; end - p >= 8; p += 8) {
        memcpy(&bytes, p, sizeof bytes);
        uint64_t newline = EQUAL('\n'), before_it = (newline - 1) & ~newline & high;
        uint64_t control = ~((bytes | high) - 0x20 * ones);
        if (((EQUAL('#') | EQUAL('\\') | control | bytes) & before_it) != 0) return false;
        uint64_t word = (bytes ^ ' ' * ones) + 0x7f * ones; /* exact, as no byte has its high bit */
        uint64_t begins = word & (~word << 8 | blank_before) & before_it;
        *count += ((begins >> 7) * ones) >> 56;
        if (newline != 0) {
            *line = p + __builtin_ctzll(newline) / 8;
            return true;
        }
        blank_before = (~word & high) >> 56;
    }
#undef EQUAL
#endif
    (void)line, (void)end, (void)count;
    return false;
}

/* Stops at the end of the line. */
static size_t count_words(const char **line, const char *end) {
    const char *p = *line;
    size_t count = 0;
    if (count_plain_words(line, end, &count)) return count;
    count = 0;
    for (;; count++) {
        p = skip_blanks(p, end);
        if (is_line_end(p, end)) break;
        do p++;
        while (!is_word_end(p, end));
    }
    *line = p;
    return count;
}

/* Whether a corner has different indices, as far as text tells. */
static bool is_apart(const char *p, const char *end, int attribute) {
    const char *part[3] = {p, NULL, NULL}; /* position, texcoord, normal */
    size_t length[3] = {0};
    int count = 0;
    for (; !is_word_end(p, end) && count < 3; p++) {
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
    GiMeshCounts counts = {0};
    const char *p = obj->chunks.begin[chunk], *end = obj->chunks.begin[chunk + 1];
    while ((p = find_keyword(p, end)) < end) {
        switch (read_keyword(&p, end)) {
        case POSITION: counts.positions++; break;
        case NORMAL_VECTOR: counts.normals++; break;
        case TEXTURE: counts.texcoords++; break;
        case FACE: {
            /* A look at one face of each chunk is enough to guess. */
            const char *corner = skip_blanks(p, end);
            for (int i = 0; i < ATTRIBUTE_COUNT && counts.triangles == 0; i++) {
                if (is_apart(corner, end, i)) atomic_store(&obj->use[i], USED_APART);
            }
            size_t words = count_words(&p, end);
            counts.triangles += words > 2 ? words - 2 : 0;
            break;
        }
        default: break;
        }
        p = skip_line(p, end);
    }
    obj->before[chunk] = counts;
    gi_mesh_forget(obj->input, obj->chunks.begin[chunk], end);
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
        p = skip_blanks(p, parser->end);
        if (is_line_end(p, parser->end)) break;
        if (count == most) {
            return gi_mesh_refuse(parser->input, parser->worker, p,
                "expected the end of the line, found \"%s\"", gi_mesh_quote(p, parser->end).text);
        }
        float value;
        const char *number_end =
            gi_mesh_number(parser->input, parser->worker, p, parser->end, &value);
        if (number_end == NULL) return false;
        if (!is_word_end(number_end, parser->end)) {
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
    return (first ^ second) << (64 - 8 * length) == 0 && is_word_end(p + 2 + length, end);
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
        if (!is_word_end(parser->p, end) && *parser->p != '/' &&
            !read_index(parser, "texture coordinate", number, parser->at.texcoords,
                parser->total.texcoords, &corner->other[TEXCOORD])) {
            return false;
        }
        if (parser->p < end && *parser->p == '/') {
            parser->p++;
            if (!is_word_end(parser->p, end) &&
                !read_index(parser, "normal", number, parser->at.normals, parser->total.normals,
                    &corner->other[NORMAL])) {
                return false;
            }
        }
    }
    if (is_word_end(parser->p, end)) return true;
    return gi_mesh_refuse(parser->input, parser->worker, word,
        "face corner %d is not a, a/b, a//c or a/b/c: \"%s\"", number,
        gi_mesh_quote(word, end).text);
}

static inline void put_row(GiCorners *row, uint32_t first, uint32_t a, uint32_t b, uint32_t c) {
    (*row)[0] = first + a;
    (*row)[1] = first + b;
    (*row)[2] = first + c;
}

static bool read_face(Parser *parser) {
    Obj *obj = parser->obj;
    const char *line = parser->p;
    size_t begin = parser->at.triangles;
    Corner first = {0}, last = {0}, corner;
    bool missing[ATTRIBUTE_COUNT] = {false}, apart[ATTRIBUTE_COUNT] = {false};
    int count = 0;
    for (;; count++) {
        parser->p = skip_blanks(parser->p, parser->end);
        if (is_line_end(parser->p, parser->end)) break;
        if (!read_corner(parser, count + 1, &corner)) return false;
        for (int i = 0; i < ATTRIBUTE_COUNT; i++) {
            missing[i] |= corner.other[i] == GI_SHAPE_NONE;
            apart[i] |= corner.other[i] != corner.position;
        }
        if (count == 0) first = corner;
        if (count >= 2) {
            size_t at = parser->at.triangles;
            if (!has_room(parser, at, parser->limit.triangles)) return false;
            put_row(&obj->room.corners[at], obj->first_position, first.position, last.position,
                corner.position);
            for (int i = 0; i < ATTRIBUTE_COUNT; i++) {
                if (obj->own_corners[i] == NULL) continue;
                put_row(&obj->own_corners[i][at], obj->first[i], first.other[i], last.other[i],
                    corner.other[i]);
            }
            parser->at.triangles++;
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
        for (size_t at = begin; at < parser->at.triangles; at++) {
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
    switch (read_keyword(&parser->p, parser->end)) {
    case POSITION:
        /* Then a weight, a colour, or both. */
        return has_room(parser, at->positions, limit->positions) &&
               read_numbers(parser, 3, 3, 7, obj->room.positions[at->positions++]);
    case NORMAL_VECTOR:
        return has_room(parser, at->normals, limit->normals) &&
               read_numbers(parser, 3, 3, 3, obj->room.normals[at->normals++]);
    case TEXTURE:
        if (!has_room(parser, at->texcoords, limit->texcoords)) return false;
        unused[1] = 0;
        if (!read_numbers(parser, 2, 1, 3, unused)) return false;
        memcpy(obj->room.texcoords[at->texcoords++], unused, sizeof obj->room.texcoords[0]);
        return true;
    case FACE: return read_face(parser);
    case IGNORED: return true;
    case UNKNOWN: break;
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
    while ((parser.p = find_keyword(parser.p, parser.end)) < parser.end) {
        if (!read_line(&parser)) return false;
        parser.p = skip_line(parser.p, parser.end);
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
