/* SPDX-License-Identifier: MIT
 * The builder of trees: the order in which shapes come does not matter to a tree's quality, nor the
 * number of threads to the tree. */
#include "test.h"

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

const GiTest tests_accel[] = {TEST(order_of_input), TEST(number_of_threads), TEST_END};
