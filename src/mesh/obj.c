/* SPDX-License-Identifier: MIT
 * Wavefront OBJ, read twice. The first pass counts what each chunk holds, so that the second knows
 * where each chunk's results go and what its relative indices count from: all chunks are parsed at
 * once, straight into arrays of the right size.
 *
 * Most files give a corner one index for position, normal and texcoord; such need no corners of
 * their own for the latter. Whether that is so is known at the end only: it is guessed before the
 * second pass, and where the guess was wrong the pass is repeated with room for those corners. */
#include "mesh/obj.h"

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
    int other = attribute == GI_OBJ_NORMAL ? 2 : 1;
    return length[other] > 0 &&
           (length[other] != length[0] || memcmp(part[0], part[other], length[0]) != 0);
}

static bool count_chunk(void *context, size_t chunk, int worker) {
    GiObj *obj = context;
    const char *begin = obj->chunks.begin[chunk], *end = obj->chunks.begin[chunk + 1], *face;
    obj->before[chunk] = gi_obj_count(begin, end, &face);
    /* A look at one face of each chunk is enough to guess. */
    for (int i = 0; i < GI_OBJ_ATTRIBUTE_COUNT && face != NULL; i++) {
        if (is_apart(gi_obj_skip_blanks(face, end), end, i)) {
            atomic_store(&obj->use[i], GI_OBJ_USED_APART);
        }
    }
    /* The bytes are not forgotten yet: the second pass begins at once, and its arrays grow more
     * slowly than it forgets. */
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

/* ---------------------------------------------------------------- the whole */

static bool is_border(const GiMeshInput *input, const char *p) {
    return p[-1] == '\n' && gi_obj_begins_line(input->text, p);
}

/* Bytes; not 0 even for the faces without triangles of a faulty file. */
static size_t own_size(size_t triangle_count) {
    return (triangle_count > 0 ? triangle_count : 1) * sizeof(GiCorners);
}

static GlintStatus allocate_own_corners(GiObj *obj, size_t triangle_count, bool *added) {
    *added = false;
    for (int i = 0; i < GI_OBJ_ATTRIBUTE_COUNT; i++) {
        if (!gi_obj_needs_own_corners(atomic_load(&obj->use[i])) || obj->own_corners[i] != NULL)
            continue;
        obj->own_corners[i] = gi_memory_allocate(obj->input->memory, own_size(triangle_count));
        if (obj->own_corners[i] == NULL) {
            return gi_mesh_fault(obj->input->fault, GLINT_ERROR_MEMORY, "not enough memory");
        }
        *added = true;
    }
    return GLINT_OK;
}

/* The second pass, again while a guess was wrong. */
static GlintStatus parse(GiObj *obj, size_t triangle_count) {
    GiMeshInput *input = obj->input;
    for (;;) {
        bool added;
        GlintStatus status = allocate_own_corners(obj, triangle_count, &added);
        if (status != GLINT_OK) return status;
        for (int i = 0; i < GI_OBJ_ATTRIBUTE_COUNT; i++) atomic_store(&obj->use[i], 0);
        memset(input->findings, 0, (size_t)input->worker_count * sizeof *input->findings);
        gi_mesh_run(input, obj->chunks.count, gi_obj_parse_chunk, obj);
        bool again = false;
        for (int i = 0; i < GI_OBJ_ATTRIBUTE_COUNT; i++) {
            again |=
                gi_obj_needs_own_corners(atomic_load(&obj->use[i])) && obj->own_corners[i] == NULL;
        }
        if (!again || atomic_load(&input->stop) != GLINT_OK) return gi_mesh_input_status(input);
    }
}

static void free_own_corners(GiObj *obj, int attribute, size_t triangle_count) {
    gi_memory_free(obj->input->memory, obj->own_corners[attribute], own_size(triangle_count));
    obj->own_corners[attribute] = NULL;
}

static GlintStatus build(GiObj *obj, GiMeshStore *store, uint32_t *index) {
    GiMeshInput *input = obj->input;
    const GiMeshCounts *totals = &obj->before[obj->chunks.count];
    GiMesh mesh;
    GlintStatus status =
        gi_mesh_begin(store, input->memory, totals, &mesh, &obj->room, input->fault);
    if (status != GLINT_OK) return status;
    obj->first_position = mesh.first_position;
    obj->first[GI_OBJ_NORMAL] = mesh.first_normal;
    obj->first[GI_OBJ_TEXCOORD] = mesh.first_texcoord;
    status = parse(obj, totals->triangles);
    bool used[GI_OBJ_ATTRIBUTE_COUNT];
    for (int i = 0; i < GI_OBJ_ATTRIBUTE_COUNT; i++) {
        unsigned use = atomic_load(&obj->use[i]);
        used[i] = (use & (GI_OBJ_USED_ALIKE | GI_OBJ_USED_APART)) != 0;
        if (status != GLINT_OK || !gi_obj_needs_own_corners(use)) {
            free_own_corners(obj, i, totals->triangles);
        }
    }
    if (status != GLINT_OK) return status;
    status = gi_mesh_check_triangles(totals->triangles, input->fault);
    if (status != GLINT_OK) return status;
    mesh.smooth = used[GI_OBJ_NORMAL];
    mesh.textured = used[GI_OBJ_TEXCOORD];
    mesh.normal_corners = obj->own_corners[GI_OBJ_NORMAL];
    mesh.texcoord_corners = obj->own_corners[GI_OBJ_TEXCOORD];
    *index = gi_mesh_end(store, input->memory, totals, &mesh);
    return GLINT_OK;
}

GlintStatus gi_mesh_parse_obj(GiMeshInput *input, GiMeshStore *store, uint32_t *mesh) {
    GiObj obj = {.input = input};
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
