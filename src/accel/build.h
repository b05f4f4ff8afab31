/* SPDX-License-Identifier: MIT
 * Boxes in, a binary tree over them out: binned SAH (Wald 2007). Knows nothing of shapes. The tree
 * is the same for every number of threads. */
#pragma once

#include "accel/bounds.h"
#include "sched/pool.h"

enum { GI_BUILD_LEAF_SIZE = 8 };

/* Inner: children are nodes first and first + 1, count 0. Leaf: items first .. first + count - 1 of
 * the permuted array. */
typedef struct GiBuildNode {
    float low[3];
    uint32_t first;
    float high[3];
    uint32_t count;
} GiBuildNode;

typedef struct GiBuildTree {
    GiBuildNode *nodes; /* [0] is the root */
    size_t node_count, node_capacity;
} GiBuildTree;

/* Permutes items into the order of the leaves; extent is theirs. count > 0. Errors: MEMORY,
 * CANCELLED; nothing is left behind then. */
GlintStatus gi_build(GiMemory *memory, GiPool *pool, GiBuildItem *items, size_t count,
    const GiExtent *extent, const GlintMonitor *monitor, GiBuildTree *tree);
void gi_build_free(GiMemory *memory, GiBuildTree *tree);

/* Half the surface of a box: proportional to the chance that a random line meets it. */
static inline float gi_build_area(const float low[3], const float high[3]) {
    float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x * y + y * z + z * x;
}
