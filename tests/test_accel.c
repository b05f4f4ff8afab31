/* SPDX-License-Identifier: MIT
 * The builder of trees: the order in which shapes come does not matter to a tree's quality, nor the
 * number of threads to the tree. Whatever the boxes are like, a tree has each of them once. */
#include "test.h"

#include "accel/build.h"
#include "accel/tree.h"
#include "random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SPHERES = 40000, ORDERS = 8 };

/* What the spheres are like: everywhere alike; in heaps, of sizes from a hair to a house; in a
 * plane. */
enum { EVEN, HEAPS, FLAT, LIKES };

static GiSphere make_sphere(Random *random, int like, const GiVec heaps[16]) {
    GiVec center = gi_vec(random_real(random, -1, 1), random_real(random, -1, 1),
        like == FLAT ? 0 : random_real(random, -1, 1));
    if (like != HEAPS) return (GiSphere){center, 0.01};
    double size = exp2(-random_real(random, 0, 12));
    GiVec heap = heaps[random_below(random, 16)];
    return (GiSphere){gi_add(heap, gi_scale(center, size)), size * 0.05};
}

static int by_x(const void *a, const void *b) {
    double x = ((const GiSphere *)a)->center.x, y = ((const GiSphere *)b)->center.x;
    return (x > y) - (x < y);
}

static int by_y_down(const void *a, const void *b) {
    double x = ((const GiSphere *)a)->center.y, y = ((const GiSphere *)b)->center.y;
    return (x < y) - (x > y);
}

static int by_radius(const void *a, const void *b) {
    double x = ((const GiSphere *)a)->radius, y = ((const GiSphere *)b)->radius;
    return (x > y) - (x < y);
}

/* Sorted in three ways; from both ends of a sorted list by turns; else shuffled. */
static void put_in_order(GiSphere *spheres, int order, Random *random) {
    static int (*const compare[])(const void *, const void *) = {by_x, by_y_down, by_radius, by_x};
    if (order < 4) qsort(spheres, SPHERES, sizeof *spheres, compare[order]);
    for (int i = 1; i < SPHERES && order >= 3; i++) {
        int k = order > 3 ? random_below(random, i + 1) : i % 2 == 0 ? i : SPHERES - i;
        GiSphere swap = spheres[i];
        spheres[i] = spheres[k];
        spheres[k] = swap;
    }
}

static void build_input(GiMemory *memory, int thread_count, const GiShapes *shapes,
    const GiTreeInput *input, GiTreeStore *store) {
    GiPool *pool;
    CHECK_INT(gi_pool_create(memory, thread_count, &pool), GLINT_OK);
    CHECK_INT(gi_tree_build(memory, pool, shapes, input, NULL, store), GLINT_OK);
    gi_pool_destroy(pool);
}

static void build(GiMemory *memory, int thread_count, const GiSphere *spheres, GiTreeStore *store) {
    static GiShapeRef refs[SPHERES];
    for (uint32_t i = 0; i < SPHERES; i++) refs[i] = gi_shape_ref(GI_SHAPE_SPHERE, i);
    const GiShapes shapes = {.spheres = spheres};
    const GiTreeInput input = {.refs = refs, .ref_count = SPHERES};
    build_input(memory, thread_count, &shapes, &input, store);
}

static void order_of_input(void) {
    static GiSphere spheres[SPHERES];
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    for (int like = 0; like < LIKES; like++) {
        Random random = {(uint64_t)like + 7};
        GiVec heaps[16];
        for (int i = 0; i < 16; i++) {
            heaps[i] = gi_vec(random_real(&random, -9, 9), random_real(&random, -9, 9),
                random_real(&random, -9, 9));
        }
        for (int i = 0; i < SPHERES; i++) spheres[i] = make_sphere(&random, like, heaps);
        double least = INFINITY, most = 0;
        for (int order = 0; order < ORDERS; order++) {
            put_in_order(spheres, order, &random);
            GiTreeStore store;
            build(&memory, 1, spheres, &store);
            least = fmin(least, store.sah_cost);
            most = fmax(most, store.sah_cost);
            gi_tree_free(&memory, &store);
        }
        CHECK(most < 1.05 * least);
    }
    CHECK_INT(atomic_load(&memory.used), 0);
}

/* Spheres here, boxes there, and both mixed in between, so that there are blocks of both kinds. */
static void build_mixed(GiMemory *memory, int thread_count, GiTreeStore *store) {
    static GiSphere spheres[SPHERES];
    static GiBox boxes[SPHERES];
    static GiShapeRef refs[SPHERES];
    Random random = {3};
    for (uint32_t i = 0; i < SPHERES; i++) {
        GiSphere sphere = spheres[i] = make_sphere(&random, EVEN, NULL);
        const GiVec half = {sphere.radius, sphere.radius, sphere.radius};
        boxes[i] = (GiBox){gi_sub(sphere.center, half), gi_add(sphere.center, half)};
        bool box = sphere.center.x + random_real(&random, -0.5, 0.5) > 0;
        refs[i] = gi_shape_ref(box ? GI_SHAPE_BOX : GI_SHAPE_SPHERE, i);
    }
    const GiShapes shapes = {.spheres = spheres, .boxes = boxes};
    const GiTreeInput input = {.refs = refs, .ref_count = SPHERES};
    build_input(memory, thread_count, &shapes, &input, store);
}

#define SAME(array, count) (memcmp((a->array), (b->array), (count) * sizeof *(a->array)) == 0)

/* Byte for byte. */
static void number_of_threads(void) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    GiTreeStore one, many;
    build_mixed(&memory, 1, &one);
    CHECK(one.tree.sphere_block_count > 1000 && one.tree.box_block_count > 1000);
    for (int threads = 2; threads < 6; threads++) {
        build_mixed(&memory, threads, &many);
        const GiTree *a = &one.tree, *b = &many.tree;
        CHECK_INT(a->node_count, b->node_count);
        CHECK_INT(a->sphere_block_count, b->sphere_block_count);
        CHECK_INT(a->box_block_count, b->box_block_count);
        CHECK(one.leaf_count == many.leaf_count && one.sah_cost == many.sah_cost);
        CHECK(SAME(nodes, a->node_count));
        CHECK(SAME(sphere_blocks, a->sphere_block_count));
        CHECK(SAME(box_blocks, a->box_block_count));
        gi_tree_free(&memory, &many);
    }
    gi_tree_free(&memory, &one);
    CHECK_INT(atomic_load(&memory.used), 0);
}

/* Boxes that are hard to part. */
typedef enum Oddity {
    ALL_ALIKE,
    ONE_CENTER,
    ON_A_LINE,
    TWO_PLACES,    /* far apart, each as small as single precision allows */
    EVER_SMALLER,  /* toward one corner */
    HARDLY_APART,  /* on a line, so short that its inverse is nearly infinite */
    SOME_ENORMOUS, /* among small ones */
    HARDLY_FINITE, /* so large that areas are infinite */
    ODDITY_COUNT
} Oddity;

static float odd_center(Oddity oddity, int i, int axis, Random *random) {
    double spread = random_real(random, -1, 1);
    switch (oddity) {
    case ALL_ALIKE:
    case ONE_CENTER: return 0.3f;
    case ON_A_LINE: return axis == 1 ? (float)spread : 0.25f;
    case TWO_PLACES: return (i % 2 == 0 ? -0.9f : 0.9f) + (float)spread * 1e-6f;
    case EVER_SMALLER: return (float)(spread * exp2(-i % 100));
    case HARDLY_APART: return axis == 1 ? (float)(spread * 2e-36) : 0;
    case HARDLY_FINITE: return (float)(spread * 1e37);
    default: return (float)spread;
    }
}

static float odd_size(Oddity oddity, int i, Random *random) {
    double share = random_real(random, 0, 1);
    switch (oddity) {
    case ALL_ALIKE: return 0.01f;
    case HARDLY_APART: return 0;
    case SOME_ENORMOUS: return i % 100 == 0 ? 0.5f : (float)share * 1e-4f;
    case HARDLY_FINITE: return (float)(share * 1e36);
    default: return (float)share * 1e-3f;
    }
}

static void make_items(Oddity oddity, int count, GiBuildItem *items, GiExtent *extent) {
    Random random = {(uint64_t)oddity + 1};
    *extent = (GiExtent){gi_bounds_empty(), gi_bounds_empty()};
    for (int i = 0; i < count; i++) {
        float low[4] = {0}, high[4] = {0};
        for (int axis = 0; axis < 3; axis++) {
            float center = odd_center(oddity, i, axis, &random);
            float size = odd_size(oddity, i, &random);
            low[axis] = center - size;
            high[axis] = center + size;
        }
        const GiBounds box = {gi_four_load(low), gi_four_load(high)};
        gi_build_set(&items[i], &box, (uint32_t)i);
        gi_extent_grow(extent, &box);
    }
}

/* Where a part of a binary tree is wrong, and how often each item is in its leaves. */
typedef struct Walk {
    const GiBuildTree *tree;
    const GiBuildItem *items;
    uint8_t seen[SPHERES];
    size_t wrong;
} Walk;

static bool is_inside(const float low[3], const float high[3], const GiBuildNode *node) {
    for (int axis = 0; axis < 3; axis++) {
        if (!(low[axis] >= node->low[axis] && high[axis] <= node->high[axis])) return false;
    }
    return true;
}

static void walk_tree(Walk *walk, uint32_t index, int depth) {
    const GiBuildNode *node = &walk->tree->nodes[index];
    walk->wrong += depth >= GI_TREE_DEPTH_LIMIT || node->count > GI_BUILD_LEAF_SIZE;
    for (uint32_t i = node->first; i < node->first + node->count; i++) {
        walk->wrong += !is_inside(walk->items[i].low, walk->items[i].high, node);
        walk->seen[gi_build_id(&walk->items[i])]++;
    }
    for (uint32_t i = 0; i < 2 && node->count == 0; i++) {
        const GiBuildNode *child = &walk->tree->nodes[node->first + i];
        walk->wrong += !is_inside(child->low, child->high, node);
        walk_tree(walk, node->first + i, depth + 1);
    }
}

/* Node by node, since their numbers depend on the threads. */
static bool is_same_tree(
    const GiBuildTree *a, uint32_t index_a, const GiBuildTree *b, uint32_t index_b) {
    const GiBuildNode *x = &a->nodes[index_a], *y = &b->nodes[index_b];
    if (memcmp(x->low, y->low, sizeof x->low) != 0) return false;
    if (memcmp(x->high, y->high, sizeof x->high) != 0) return false;
    if (x->count != y->count) return false;
    if (x->count > 0) return x->first == y->first;
    return is_same_tree(a, x->first, b, y->first) && is_same_tree(a, x->first + 1, b, y->first + 1);
}

static void build_items(GiMemory *memory, int thread_count, GiBuildItem *items, int count,
    const GiExtent *extent, GiBuildTree *tree) {
    GiPool *pool;
    CHECK_INT(gi_pool_create(memory, thread_count, &pool), GLINT_OK);
    CHECK_INT(gi_build(memory, pool, items, (size_t)count, extent, NULL, tree), GLINT_OK);
    gi_pool_destroy(pool);
}

/* As many as fit into a leaf, as are split one by one, by clusters once, and more than once. */
static void odd_boxes(void) {
    static const int counts[] = {1, 8, 9, 1000, 3000, SPHERES};
    static GiBuildItem items[SPHERES], again[SPHERES];
    static Walk walk;
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    for (int k = 0; k < (int)(sizeof counts / sizeof *counts) * ODDITY_COUNT; k++) {
        int count = counts[k / ODDITY_COUNT];
        GiExtent extent;
        GiBuildTree one, two;
        make_items((Oddity)(k % ODDITY_COUNT), count, items, &extent);
        memcpy(again, items, (size_t)count * sizeof *items);
        build_items(&memory, 1, items, count, &extent, &one);
        build_items(&memory, 3, again, count, &extent, &two);
        walk = (Walk){.tree = &one, .items = items};
        walk_tree(&walk, 0, 0);
        CHECK_INT(walk.wrong, 0);
        size_t once = 0;
        for (int i = 0; i < count; i++) once += walk.seen[i] == 1;
        CHECK_INT(once, count);
        CHECK(is_same_tree(&one, 0, &two, 0));
        CHECK(memcmp(items, again, (size_t)count * sizeof *items) == 0);
        gi_build_free(&memory, &one);
        gi_build_free(&memory, &two);
    }
    CHECK_INT(atomic_load(&memory.used), 0);
}

/* A vertex that no triangle has, however far away, changes nothing. */
static void vertex_without_triangle(void) {
    enum { TRIANGLES = 100, VERTICES = 3 * TRIANGLES + 1 };
    static float positions[VERTICES + 1][3];
    static uint32_t corners[TRIANGLES][3], original[2][TRIANGLES];
    Random random = {11};
    for (uint32_t i = 0; i < VERTICES; i++) {
        for (int axis = 0; axis < 3; axis++) {
            positions[i][axis] = (float)random_real(&random, -1, 1);
        }
        if (i + 1 < VERTICES) corners[i / 3][i % 3] = i;
    }
    GiMesh mesh = {.triangle_count = TRIANGLES, .position_count = VERTICES};
    const GiShapes shapes = {
        .triangles = {.positions = (const float(*)[3])positions,
            .corners = (const uint32_t(*)[3])corners},
        .meshes = &mesh,
        .mesh_count = 1,
    };
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    GiTreeStore stores[2];
    for (int i = 0; i < 2; i++) {
        uint32_t first = 0, placed = 0;
        const GiTreeInput input = {
            .meshes = &first, .mesh_count = 1, .original = original[i], .placed = &placed};
        positions[VERTICES - 1][0] = i == 0 ? 0 : 1e30f;
        build_input(&memory, 2, &shapes, &input, &stores[i]);
    }
    const GiTree *a = &stores[0].tree, *b = &stores[1].tree;
    CHECK(a->scale == b->scale && memcmp(&a->bounds, &b->bounds, sizeof a->bounds) == 0);
    CHECK_INT(a->node_count, b->node_count);
    CHECK(SAME(nodes, a->node_count));
    CHECK(memcmp(original[0], original[1], sizeof original[0]) == 0);
    for (int i = 0; i < 2; i++) gi_tree_free(&memory, &stores[i]);
    CHECK_INT(atomic_load(&memory.used), 0);
}

/* So far away, on either side, that their distance is infinite. */
static void far_away(void) {
    enum { NEAR = 10, ALL = 20 };
    GiSphere spheres[ALL];
    GiShapeRef refs[ALL];
    for (uint32_t i = 0; i < ALL; i++) {
        double x = i < NEAR ? (double)i : i % 2 == 0 ? -1e308 : 1e308;
        spheres[i] = (GiSphere){gi_vec(x, 0, 1), 0.25};
        refs[i] = gi_shape_ref(GI_SHAPE_SPHERE, i);
    }
    const GiShapes shapes = {.spheres = spheres};
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    for (uint32_t first = 0; first <= NEAR; first += NEAR) {
        const GiTreeInput input = {.refs = refs + first, .ref_count = ALL - first};
        GiTreeStore store;
        build_input(&memory, 1, &shapes, &input, &store);
        CHECK_INT(store.tree.unbounded_count, ALL - NEAR);
        CHECK_INT(store.tree.root == GI_CHILD_NONE, first == NEAR);
        gi_tree_free(&memory, &store);
    }
    CHECK_INT(atomic_load(&memory.used), 0);
}

const GiTest tests_accel[] = {TEST(order_of_input), TEST(number_of_threads), TEST(odd_boxes),
    TEST(vertex_without_triangle), TEST(far_away), TEST_END};
