/* SPDX-License-Identifier: MIT
 * PLY: a header that says what follows, then the rows of its elements, as words or as bytes. The
 * body is gone through twice: first to count the triangles of its polygons and to find whether the
 * file holds what it declares, then to read the numbers. So nothing is allocated for what a header
 * only claims.
 *
 * Both times it is gone through in parts, which begin at rows; for the second time the first has
 * noted where. Several threads can go through it the first time only if they know before where rows
 * begin. That is guessed, and the guess proves itself: if every part, gone through from where it
 * was said to begin, ends where the next one was said to begin, then all begin rightly, since the
 * first does. Otherwise one thread does it, from the beginning. */
#include "mesh/ply.h"

#include <string.h>

typedef struct Body {
    GiPly *ply;
    GiPlyPlace *places; /* where parts begin, and the end of the last; room for more than needed */
    size_t part_count;
    GiPlyPlace first, last; /* the last has no address as long as that is not known */
    _Atomic bool guess_failed;
} Body;

/* ---------------------------------------------------------------- a guess */

static bool is_same(const GiPlyPlace *a, const GiPlyPlace *b) {
    return a->at == b->at && a->element == b->element && a->row == b->row;
}

static bool count_part(void *context, size_t part, int worker) {
    Body *body = context;
    const GiPlyPlace *next = &body->places[part + 1];
    GiPlyPlace place = body->places[part];
    size_t size = (size_t)(body->ply->input->end - place.at);
    place.triangle = 0;
    if (!gi_ply_count_rows(body->ply, worker, next, size, &place) || !is_same(&place, next)) {
        atomic_store(&body->guess_failed, true);
        return false;
    }
    gi_mesh_forget(body->ply->input, body->places[part].at, next->at);
    body->places[part].triangle = place.triangle;
    return true;
}

static const char *skip_space(const char *p, const char *end) {
    while (p < end && gi_mesh_is_space(*p)) p++;
    return p;
}

static const char *after_newline(const char *p, const char *end) {
    const char *newline = memchr(p, '\n', (size_t)(end - p));
    return newline != NULL ? newline + 1 : end;
}

static size_t count_newlines(const char *p, const char *end) {
    enum { BLOCK = 128 }; /* whose newlines fit a byte, so that compilers take many bytes at once */
    size_t count = 0;
    for (; end - p >= BLOCK; p += BLOCK) {
        unsigned char sum = 0;
        for (int i = 0; i < BLOCK; i++) sum = (unsigned char)(sum + (p[i] == '\n'));
        count += sum;
    }
    for (; p < end; p++) count += *p == '\n';
    return count;
}

/* Notes the lines of a part in place of its row. */
static bool count_lines(void *context, size_t part, int worker) {
    Body *body = context;
    const char *p = body->places[part].at, *end = body->places[part + 1].at;
    size_t count = 0;
    if (part + 1 == body->part_count) { /* the last line may have no end, or empty ones behind it */
        while (end > p && gi_mesh_is_space(end[-1])) end--;
        count = 1;
    }
    body->places[part].row = count + count_newlines(p, end);
    (void)worker;
    return true;
}

/* A row has a line of its own, as a rule, and there are no empty ones. False when there are too
 * many or too few lines. */
static bool guess_by_lines(Body *body) {
    GiMeshInput *input = body->ply->input;
    const char *end = input->end, *p = body->first.at;
    while (p < end) {
        body->places[body->part_count++] = (GiPlyPlace){.at = p};
        p = (size_t)(end - p) > input->chunk_size ? p + input->chunk_size : end;
        p = skip_space(after_newline(p, end), end);
    }
    body->places[body->part_count] = (GiPlyPlace){.at = end};
    gi_mesh_run(input, body->part_count, count_lines, body);
    GiPlyPlace sum = body->first;
    for (size_t i = 0; i <= body->part_count; i++) {
        size_t count = body->places[i].row;
        body->places[i].element = sum.element;
        body->places[i].row = sum.row;
        gi_ply_move(&body->ply->header, &sum, count);
    }
    return sum.element == body->last.element;
}

/* All rows of an element are as long as its first one: often all faces are triangles, or all have
 * four corners. False when the file is too short for that. */
static bool guess_by_size(Body *body) {
    GiMeshInput *input = body->ply->input;
    GiPlyPlace place = body->first;
    while (place.element < body->last.element) {
        size_t row_count = body->ply->header.elements.data[place.element].row_count;
        GiPlyPlace second = place;
        if (!gi_ply_count_rows(body->ply, 0, &body->last, 1, &second)) return false;
        size_t row_size = (size_t)(second.at - place.at);
        if (row_count > (size_t)(input->end - place.at) / row_size) return false;
        size_t step = input->chunk_size / row_size + 1;
        for (size_t row = 0; row < row_count; row += step) {
            body->places[body->part_count++] =
                (GiPlyPlace){.at = place.at + row * row_size, .element = place.element, .row = row};
        }
        place.at += row_count * row_size;
        gi_ply_move(&body->ply->header, &place, row_count);
    }
    body->places[body->part_count] = place;
    return true;
}

/* Counts with all threads. False when the guess was wrong, which leaves nothing behind; true also
 * when the caller cancelled. */
static bool guess(Body *body) {
    GiMeshInput *input = body->ply->input;
    bool is_text = body->ply->header.encoding == GI_PLY_ASCII;
    bool good = is_text ? guess_by_lines(body) : guess_by_size(body);
    if (good) gi_mesh_run(input, body->part_count, count_part, body);
    if (atomic_load(&input->stop) != GLINT_OK) return true;
    if (good && !atomic_load(&body->guess_failed)) {
        size_t sum = 0;
        for (size_t i = 0; i <= body->part_count; i++) {
            size_t count = body->places[i].triangle;
            body->places[i].triangle = sum;
            sum += count;
        }
        return true;
    }
    body->part_count = 0;
    memset(input->findings, 0, (size_t)input->worker_count * sizeof *input->findings);
    return false;
}

/* ---------------------------------------------------------------- counting */

/* Counts with one thread. */
static bool count(Body *body) {
    GiMeshInput *input = body->ply->input;
    GiPlyPlace place = body->first;
    while (place.element < body->last.element) {
        if (gi_mesh_is_cancelled(input)) return false;
        body->places[body->part_count++] = place;
        const char *begin = place.at;
        if (!gi_ply_count_rows(body->ply, 0, &body->last, input->chunk_size, &place)) return false;
        gi_mesh_forget(input, begin, place.at);
    }
    body->places[body->part_count] = place;
    /* What follows the last element is refused where it can be seen. */
    if (body->ply->header.encoding != GI_PLY_ASCII || place.at == input->end) return true;
    return gi_mesh_refuse(input, 0, place.at, "expected the end of the file, found \"%s\"",
        gi_mesh_quote(place.at, input->end).text);
}

/* ---------------------------------------------------------------- the whole */

static bool read_part(void *context, size_t part, int worker) {
    Body *body = context;
    const GiPlyPlace *place = &body->places[part];
    if (!gi_ply_read_rows(body->ply, worker, place, place + 1)) return false;
    gi_mesh_forget(body->ply->input, place->at, place[1].at);
    return true;
}

static bool has_roles(const GiPlyElement *element, GiPlyRole first, GiPlyRole last) {
    for (unsigned role = first; role <= last; role++) {
        if ((element->roles >> role & 1) == 0) return false;
    }
    return true;
}

static GlintStatus build(Body *body, GiMeshStore *store, uint32_t *index) {
    GiPly *ply = body->ply;
    GiMeshInput *input = ply->input;
    const GiPlyElement *vertices = ply->header.known[GI_PLY_VERTEX];
    bool smooth = has_roles(vertices, GI_PLY_NX, GI_PLY_NZ);
    bool textured = has_roles(vertices, GI_PLY_U, GI_PLY_V);
    size_t count = vertices->row_count;
    GiMeshCounts counts = {
        count, smooth ? count : 0, textured ? count : 0, body->places[body->part_count].triangle};
    GiMesh mesh;
    GlintStatus status = gi_mesh_check_triangles(counts.triangles, input->fault);
    if (status == GLINT_OK) {
        status = gi_mesh_begin(store, input->memory, &counts, &mesh, &ply->room, input->fault);
    }
    if (status != GLINT_OK) return status;
    mesh.smooth = smooth;
    mesh.textured = textured;
    ply->first_position = mesh.first_position;
    gi_mesh_run(input, body->part_count, read_part, body);
    status = gi_mesh_input_status(input);
    if (status == GLINT_OK) *index = gi_mesh_end(store, input->memory, &counts, &mesh);
    return status;
}

static GlintStatus read_body(GiPly *ply, GiMeshStore *store, uint32_t *index) {
    GiMeshInput *input = ply->input;
    Body body = {.ply = ply,
        .first = {.at = ply->header.body},
        .last = {.element = ply->header.elements.count}};
    if (ply->header.encoding == GI_PLY_ASCII) {
        body.first.at = skip_space(body.first.at, input->end);
    }
    gi_ply_move(&ply->header, &body.first, 0);
    /* Parts are at least as large as chunks, but for the last, which may be that of an element. */
    size_t size = (size_t)(input->end - body.first.at) / input->chunk_size;
    size = (size + ply->header.elements.count + 2) * sizeof *body.places;
    body.places = gi_memory_allocate(input->memory, size);
    if (body.places == NULL) {
        return gi_mesh_fault(input->fault, GLINT_ERROR_MEMORY, "not enough memory");
    }
    if (input->pool == NULL || !guess(&body)) count(&body);
    GlintStatus status = gi_mesh_input_status(input);
    if (status == GLINT_OK) status = build(&body, store, index);
    gi_memory_free(input->memory, body.places, size);
    return status;
}

GlintStatus gi_mesh_parse_ply(GiMeshInput *input, GiMeshStore *store, uint32_t *mesh) {
    GiPly ply = {.input = input};
    GlintStatus status = gi_ply_header_read(input, &ply.header);
    if (status == GLINT_OK) {
        input->has_lines = ply.header.encoding == GI_PLY_ASCII;
        status = read_body(&ply, store, mesh);
    }
    gi_ply_header_reset(&ply.header, input->memory);
    return status;
}
