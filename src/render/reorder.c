/* SPDX-License-Identifier: MIT */
#include "render/reorder.h"

#include "base/prefetch.h"
#include "port/machine.h"

#include <string.h>

enum {
    SHAPE_WIDTH = 8, /* doubles in the largest shape, at least */
    WALKERS = 16,
    PART = 4096 /* rows or vertices that are worth a worker's while */
};
#define SETTLED GI_SHAPE_NONE

/* Every ref of the tree's blocks that names a shape of this kind directly. */
typedef void (*VisitFn)(void *context, GiShapeRef *ref);

static void visit_blocks(GiTreeStore *store, GiShapeKind kind, VisitFn visit, void *context) {
    for (uint32_t i = 0; i < store->tree.sphere_block_count && kind == GI_SHAPE_SPHERE; i++) {
        for (int lane = 0; lane < GI_TREE_WIDTH; lane++) {
            GiShapeRef *ref = &store->sphere_blocks[i].shape[lane];
            if (ref->bits != GI_SHAPE_NONE) visit(context, ref);
        }
    }
    for (uint32_t i = 0; i < store->tree.box_block_count; i++) {
        for (int lane = 0; lane < GI_TREE_WIDTH; lane++) {
            GiShapeRef *ref = &store->box_blocks[i].shape[lane];
            if (ref->bits != GI_SHAPE_NONE && gi_shape_kind(*ref) == kind) visit(context, ref);
        }
    }
}

typedef struct Order {
    GiShapeKind kind;
    uint32_t *place; /* new index of each shape, or GI_SHAPE_NONE */
    uint32_t next;
} Order;

/* Gives the shape the next place when it has none, and the ref its shape's place. */
static void take_place(void *context, GiShapeRef *ref) {
    Order *order = context;
    uint32_t *place = &order->place[gi_shape_index(*ref)];
    if (*place == GI_SHAPE_NONE) *place = order->next++;
    *ref = gi_shape_ref(order->kind, *place);
}

/* Shapes on the way to their places. */
typedef struct Move {
    double *shapes; /* each of so many doubles */
    size_t width, count;
    GiShapeInfo *infos;
    uint32_t *place; /* of each; SETTLED once it has left */
    uint32_t next;   /* all before it have left */
} Move;

typedef struct Walker {
    double shape[SHAPE_WIDTH];
    GiShapeInfo info;
    uint32_t to;
} Walker;

/* Lifts the next shape that has not left; false when there is none. */
static bool lift(Move *move, Walker *walker) {
    while (move->next < move->count && move->place[move->next] == SETTLED) move->next++;
    if (move->next == move->count) return false;
    uint32_t from = move->next++;
    memcpy(walker->shape, move->shapes + from * move->width, move->width * sizeof(double));
    walker->info = move->infos[from];
    walker->to = move->place[from];
    move->place[from] = SETTLED;
    return true;
}

/* Puts down what is carried and takes what was there. False when that had left before. */
static bool trade(Move *move, Walker *walker) {
    uint32_t at = walker->to;
    double *there = move->shapes + at * move->width;
    for (size_t k = 0; k < move->width; k++) {
        double swap = there[k];
        there[k] = walker->shape[k];
        walker->shape[k] = swap;
    }
    GiShapeInfo swap = move->infos[at];
    move->infos[at] = walker->info;
    walker->info = swap;
    walker->to = move->place[at];
    move->place[at] = SETTLED;
    return walker->to != SETTLED;
}

/* Cycle by cycle, so that there is never a second copy of the shapes. Each step goes to a place
 * that only the one before it tells, and would wait for memory: hence many walkers by turns, each
 * of which walks until it comes to where another has set out. */
static void move_shapes(Move *move) {
    Walker walkers[WALKERS];
    int count = 0;
    while (count < WALKERS && lift(move, &walkers[count])) count++;
    while (count > 0) {
        for (int i = 0; i < count; i++) {
            Walker *walker = &walkers[i];
            if (!trade(move, walker) && !lift(move, walker)) {
                *walker = walkers[--count];
                i--;
                continue;
            }
            gi_prefetch(&move->place[walker->to]);
            gi_prefetch(&move->shapes[walker->to * move->width]);
            gi_prefetch(&move->infos[walker->to]);
        }
    }
}

static void reorder_kind(
    GiScene *scene, GiWorld *world, GiShapeKind kind, double *shapes, size_t width) {
    GiShapeInfos *infos = &scene->info[kind];
    size_t count = infos->count;
    if (count < 2) return;
    Order order = {.kind = kind};
    size_t place_size = count * sizeof *order.place;
    order.place = gi_memory_allocate(scene->memory, place_size);
    if (order.place == NULL) return;
    memset(order.place, 0xff, place_size);
    visit_blocks(&world->store, kind, take_place, &order);
    for (size_t i = 0; i < world->inner_count; i++) {
        visit_blocks(&world->inner[i], kind, take_place, &order);
    }
    for (size_t i = 0; i < count; i++) {
        if (order.place[i] == GI_SHAPE_NONE) order.place[i] = order.next++;
    }
    for (size_t i = 0; i < world->spread.placements.count; i++) {
        GiShapeRef *ref = &world->spread.placements.data[i].shape;
        if (gi_shape_kind(*ref) != kind) continue;
        *ref = gi_shape_ref(kind, order.place[gi_shape_index(*ref)]);
    }
    Move move = {shapes, width, count, infos->data, order.place, 0};
    move_shapes(&move);
    gi_memory_free(scene->memory, order.place, place_size);
}

/* ---------------------------------------------------------------- triangles */

/* Those without a place (there are few: triangles without area, or all when the mesh is nowhere)
 * get the places behind the others. */
static bool place_rest(GiMemory *memory, const GiMesh *mesh, uint32_t *original, uint32_t placed) {
    uint32_t count = mesh->triangle_count;
    if (placed == count) return true;
    bool *seen = gi_memory_allocate(memory, count);
    if (seen == NULL) return false;
    memset(seen, 0, count);
    for (uint32_t i = 0; i < placed; i++) seen[original[i] - mesh->first_triangle] = true;
    for (uint32_t i = 0; i < count; i++) {
        if (!seen[i]) original[placed++] = mesh->first_triangle + i;
    }
    gi_memory_free(memory, seen, count);
    return true;
}

/* Rows of a mesh's triangles, row 0 that of the triangle `first`. */
typedef struct Rows {
    uint32_t (*rows)[3], (*old)[3];
    const uint32_t *original;
    uint32_t first;
} Rows;

static void keep_rows(void *context, size_t begin, size_t end, int worker) {
    (void)worker;
    const Rows *move = context;
    memcpy(move->old + begin, move->rows + begin, (end - begin) * sizeof *move->old);
}

static void take_rows(void *context, size_t begin, size_t end, int worker) {
    (void)worker;
    const Rows *move = context;
    for (size_t i = begin; i < end; i++) {
        memcpy(move->rows[i], move->old[move->original[i] - move->first], sizeof *move->rows);
    }
}

static bool move_rows(GiMemory *memory, GiPool *pool, uint32_t (*rows)[3], const uint32_t *original,
    uint32_t first, uint32_t count) {
    if (rows == NULL || count == 0) return true;
    size_t size = count * sizeof *rows;
    Rows move = {rows, gi_memory_allocate(memory, size), original, first};
    if (move.old == NULL) return false;
    gi_machine_large_pages(move.old, size);
    gi_parallel_for(pool, count, PART, keep_rows, &move);
    gi_parallel_for(pool, count, PART, take_rows, &move);
    gi_memory_free(memory, move.old, size);
    return true;
}

bool gi_reorder_triangles(
    GiScene *scene, GiPool *pool, uint32_t *original, const uint32_t *placed) {
    GiMemory *memory = scene->memory;
    for (size_t i = 0; i < scene->meshes.meshes.count; i++) {
        const GiMesh *mesh = &scene->meshes.meshes.data[i];
        uint32_t first = mesh->first_triangle, count = mesh->triangle_count;
        uint32_t *order = original + first;
        if (!place_rest(memory, mesh, order, placed[i]) ||
            !move_rows(memory, pool, scene->meshes.corners.data + first, order, first, count) ||
            !move_rows(memory, pool, mesh->normal_corners, order, first, count) ||
            !move_rows(memory, pool, mesh->texcoord_corners, order, first, count)) {
            return false;
        }
    }
    return true;
}

/* ---------------------------------------------------------------- vertices */

/* Numbers that vertices have, so many floats each. */
typedef struct Numbers {
    float *data; /* of the mesh's first vertex */
    size_t width;
} Numbers;

/* The vertices of a mesh that its rows name, counted from `first`. */
typedef struct Vertices {
    uint32_t (*rows)[3]; /* those that begin with GI_SHAPE_NONE name none */
    uint32_t row_count, first, count;
    Numbers numbers[3];
    int number_count;
} Vertices;

/* Names the vertices anew, by first use, and notes where each is to go. */
static void place_vertices(const Vertices *vertices, uint32_t *place) {
    uint32_t next = 0;
    memset(place, 0xff, vertices->count * sizeof *place); /* GI_SHAPE_NONE */
    for (uint32_t i = 0; i < vertices->row_count; i++) {
        uint32_t *row = vertices->rows[i];
        if (row[0] == GI_SHAPE_NONE) continue;
        for (int k = 0; k < 3; k++) {
            uint32_t *to = &place[row[k] - vertices->first];
            if (*to == GI_SHAPE_NONE) *to = next++;
            row[k] = vertices->first + *to;
        }
    }
    for (uint32_t i = 0; i < vertices->count; i++) {
        if (place[i] == GI_SHAPE_NONE) place[i] = next++;
    }
}

/* Numbers on the way to their vertices' places. */
typedef struct NumbersMove {
    Numbers numbers;
    const uint32_t *place;
    float *old;
} NumbersMove;

static void keep_numbers(void *context, size_t begin, size_t end, int worker) {
    (void)worker;
    const NumbersMove *move = context;
    size_t width = move->numbers.width;
    memcpy(move->old + begin * width, move->numbers.data + begin * width,
        (end - begin) * width * sizeof *move->old);
}

static void put_numbers(void *context, size_t begin, size_t end, int worker) {
    (void)worker;
    const NumbersMove *move = context;
    size_t width = move->numbers.width;
    for (size_t i = begin; i < end; i++) {
        float *to = move->numbers.data + move->place[i] * width;
        for (size_t k = 0; k < width; k++) to[k] = move->old[i * width + k];
    }
}

static void reorder_vertices(GiMemory *memory, GiPool *pool, const Vertices *vertices) {
    size_t place_size = vertices->count * sizeof(uint32_t);
    size_t copy_size = vertices->count * sizeof(GiFloat3);
    /* All memory first, so that a failure leaves everything as it was. */
    uint32_t *place = gi_memory_allocate(memory, place_size);
    float *copy = gi_memory_allocate(memory, copy_size);
    gi_machine_large_pages(copy, copy_size);
    if (place != NULL && copy != NULL) {
        place_vertices(vertices, place);
        for (int i = 0; i < vertices->number_count; i++) {
            NumbersMove move = {vertices->numbers[i], place, copy};
            gi_parallel_for(pool, vertices->count, PART, keep_numbers, &move);
            gi_parallel_for(pool, vertices->count, PART, put_numbers, &move);
        }
    }
    gi_memory_free(memory, place, place_size);
    gi_memory_free(memory, copy, copy_size);
}

/* Normals or texture coordinates: with the positions where they share their rows. False when there
 * are not as many, so that they cannot trade places alike. */
static bool take_numbers(GiMemory *memory, GiPool *pool, Vertices *vertices, Numbers numbers,
    uint32_t (*own_rows)[3], uint32_t first, uint32_t count) {
    if (own_rows != NULL) {
        const Vertices own = {own_rows, vertices->row_count, first, count, {numbers}, 1};
        reorder_vertices(memory, pool, &own);
        return true;
    }
    vertices->numbers[vertices->number_count++] = numbers;
    return count == vertices->count;
}

/* What a leaf's triangles are made of comes to stand side by side. */
static void reorder_mesh(GiScene *scene, GiPool *pool, size_t index) {
    GiMeshStore *meshes = &scene->meshes;
    const GiMesh *mesh = &meshes->meshes.data[index];
    bool last = index + 1 == meshes->meshes.count;
    size_t normal_end = last ? meshes->normals.count : mesh[1].first_normal;
    size_t texcoord_end = last ? meshes->texcoords.count : mesh[1].first_texcoord;
    Vertices vertices = {
        .rows = meshes->corners.data + mesh->first_triangle,
        .row_count = mesh->triangle_count,
        .first = mesh->first_position,
        .count = mesh->position_count,
        .numbers = {{meshes->positions.data[mesh->first_position], 3}},
        .number_count = 1,
    };
    bool alike = true;
    if (mesh->smooth) {
        Numbers normals = {meshes->normals.data[mesh->first_normal], 3};
        alike &= take_numbers(scene->memory, pool, &vertices, normals, mesh->normal_corners,
            mesh->first_normal, (uint32_t)normal_end - mesh->first_normal);
    }
    if (mesh->textured) {
        Numbers texcoords = {meshes->texcoords.data[mesh->first_texcoord], 2};
        alike &= take_numbers(scene->memory, pool, &vertices, texcoords, mesh->texcoord_corners,
            mesh->first_texcoord, (uint32_t)texcoord_end - mesh->first_texcoord);
    }
    if (alike) reorder_vertices(scene->memory, pool, &vertices);
}

/* ---------------------------------------------------------------- the whole */

/* Shapes are made of doubles alone. */
#define REORDER(kind, array)                                                                       \
    do {                                                                                           \
        _Static_assert(sizeof *(array).data <= SHAPE_WIDTH * sizeof(double) &&                     \
                           sizeof *(array).data % sizeof(double) == 0,                             \
            "the room of move_shapes");                                                            \
        reorder_kind(                                                                              \
            scene, world, kind, (double *)(array).data, sizeof *(array).data / sizeof(double));    \
    } while (0)

void gi_reorder(GiScene *scene, GiPool *pool, GiWorld *world) {
    REORDER(GI_SHAPE_SPHERE, scene->spheres);
    REORDER(GI_SHAPE_BOX, scene->boxes);
    REORDER(GI_SHAPE_CONE, scene->cones);
    REORDER(GI_SHAPE_DISC, scene->discs);
    for (size_t i = 0; i < scene->meshes.meshes.count; i++) reorder_mesh(scene, pool, i);
}
