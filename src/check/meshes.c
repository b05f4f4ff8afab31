/* SPDX-License-Identifier: MIT
 * Rules of meshes. Each mesh is looked at once, and told of at the first surface that has it. */
#include "check/inside.h"

#include <string.h>

enum { EDGE_TRIANGLES = 1 << 20 }; /* with more the table of edges would be large */

static GiVec corner(const GiTriangles *triangles, uint32_t triangle, int i) {
    const float *p = triangles->positions[triangles->corners[triangle][i]];
    return gi_vec((double)p[0], (double)p[1], (double)p[2]);
}

/* Not normalized; zero for a triangle without area. */
static GiVec normal_of(const GiTriangles *triangles, uint32_t triangle) {
    GiVec a = corner(triangles, triangle, 0);
    return gi_cross(
        gi_sub(corner(triangles, triangle, 1), a), gi_sub(corner(triangles, triangle, 2), a));
}

/* ---------------------------------------------------------------- triangles without area */

static void check_degenerate(GiCheck *check, const GiMesh *mesh, int64_t place) {
    const GiTriangles *triangles = &check->world->trace.shapes->triangles;
    uint32_t count = 0, first = GI_NONE;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        uint32_t triangle = mesh->first_triangle + i;
        if (!gi_vec_is_zero(normal_of(triangles, triangle))) continue;
        uint32_t original = triangles->original[triangle] - mesh->first_triangle;
        if (original < first) first = original;
        count++;
    }
    /* A few are in many good meshes, and do no harm. */
    if (count < 1 + mesh->triangle_count / 100) return;
    gi_check_add(check, GI_CHECK_DEGENERATE, place,
        "%u of the mesh's %u triangles have no area and are never drawn; the first is number %u",
        count, mesh->triangle_count, first + 1);
}

/* ---------------------------------------------------------------- edges */

/* How often an edge is run along from its lower vertex to its higher one, and back. */
typedef struct Edge {
    uint32_t low, high;
    uint16_t forward, back; /* both 0: the slot is empty */
} Edge;

static Edge *find_edge(Edge *edges, size_t slots, uint32_t low, uint32_t high) {
    uint64_t key = (uint64_t)low << 32 | high;
    key = (key ^ key >> 31) * UINT64_C(0x9e3779b97f4a7c15);
    for (size_t i = (size_t)(key >> 20);; i++) {
        Edge *edge = &edges[i & (slots - 1)];
        bool empty = edge->forward == 0 && edge->back == 0;
        if (empty || (edge->low == low && edge->high == high)) return edge;
    }
}

static void add_edges(const GiTriangles *triangles, uint32_t triangle, Edge *edges, size_t slots) {
    for (int i = 0; i < 3; i++) {
        uint32_t a = triangles->corners[triangle][i];
        uint32_t b = triangles->corners[triangle][(i + 1) % 3];
        if (a == b) continue;
        Edge *edge = find_edge(edges, slots, a < b ? a : b, a < b ? b : a);
        edge->low = a < b ? a : b;
        edge->high = a < b ? b : a;
        uint16_t *count = a < b ? &edge->forward : &edge->back;
        if (*count < UINT16_MAX) (*count)++;
    }
}

/* Two triangles that run along their edge in the same direction turn to different sides. With
 * normals of its own a mesh is lit by these. */
static void check_winding(GiCheck *check, const GiMesh *mesh, int64_t place) {
    const GiTriangles *triangles = &check->world->trace.shapes->triangles;
    if (mesh->smooth || mesh->triangle_count > EDGE_TRIANGLES) return;
    size_t slots = 8;
    while (slots < (size_t)mesh->triangle_count * 6) slots *= 2;
    Edge *edges = gi_memory_allocate(check->memory, slots * sizeof *edges);
    if (edges == NULL) {
        check->status = GLINT_ERROR_MEMORY;
        return;
    }
    memset(edges, 0, slots * sizeof *edges);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        uint32_t triangle = mesh->first_triangle + i;
        if (gi_vec_is_zero(normal_of(triangles, triangle))) continue;
        add_edges(triangles, triangle, edges, slots);
    }
    size_t shared = 0, wrong = 0;
    for (size_t i = 0; i < slots; i++) {
        if (edges[i].forward + edges[i].back != 2) continue;
        shared++;
        wrong += edges[i].forward != edges[i].back;
    }
    gi_memory_free(check->memory, edges, slots * sizeof *edges);
    if (wrong == 0) return;
    gi_check_add(check, GI_CHECK_WINDING, place,
        "at %zu of %zu edges of the mesh the triangles on both sides turn their fronts to "
        "different sides\nlet the corners of all faces run counterclockwise as seen from outside",
        wrong, shared);
}

/* ---------------------------------------------------------------- normals */

static GiVec vertex_normal(
    const GiTriangles *triangles, const GiMesh *mesh, uint32_t triangle, int i) {
    uint32_t row =
        mesh->normal_corners != NULL
            ? mesh->normal_corners[triangle - mesh->first_triangle][i]
            : triangles->corners[triangle][i] - mesh->first_position + mesh->first_normal;
    if (row == GI_SHAPE_NONE) return gi_vec(0, 0, 0);
    const float *n = triangles->normals[row];
    return gi_vec((double)n[0], (double)n[1], (double)n[2]);
}

/* A triangle of which all three normals point to its back; in some meshes all do, which shows
 * nowhere. */
static void check_normals(GiCheck *check, const GiMesh *mesh, int64_t place) {
    const GiTriangles *triangles = &check->world->trace.shapes->triangles;
    uint32_t with = 0, against = 0;
    if (!mesh->smooth) return;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        uint32_t triangle = mesh->first_triangle + i;
        GiVec normal = normal_of(triangles, triangle);
        int agree = 0, differ = 0;
        for (int k = 0; k < 3; k++) {
            double cosine = gi_dot(normal, vertex_normal(triangles, mesh, triangle, k));
            agree += cosine > 0;
            differ += cosine < 0;
        }
        with += agree == 3;
        against += differ == 3;
    }
    uint32_t fewer = with < against ? with : against;
    if (fewer < 1 + mesh->triangle_count / 100) return;
    gi_check_add(check, GI_CHECK_NORMALS, place,
        "of the mesh's %u triangles %u have normals that point to their front and %u to their back",
        mesh->triangle_count, with, against);
}

void gi_check_meshes(GiCheck *check) {
    const GiScene *scene = check->scene;
    size_t count = scene->meshes.meshes.count, size = count * sizeof(uint32_t);
    if (count == 0) return;
    uint32_t *orders = gi_memory_allocate(check->memory, size);
    if (orders == NULL) {
        check->status = GLINT_ERROR_MEMORY;
        return;
    }
    memset(orders, 0xff, size); /* GI_NONE */
    for (size_t i = 0; i < scene->mesh_surfaces.count; i++) {
        const GiMeshSurface *surface = &scene->mesh_surfaces.data[i];
        if (surface->info.order < orders[surface->mesh]) {
            orders[surface->mesh] = surface->info.order;
        }
    }
    for (size_t i = 0; i < count && !gi_check_stopped(check); i++) {
        if (orders[i] == GI_NONE) continue;
        int64_t place = gi_check_place(check, GLINT_OBJECT_SURFACE, orders[i] + 1);
        const GiMesh *mesh = &check->world->trace.shapes->meshes[i];
        check_degenerate(check, mesh, place);
        check_winding(check, mesh, place);
        check_normals(check, mesh, place);
    }
    gi_memory_free(check->memory, orders, size);
}
