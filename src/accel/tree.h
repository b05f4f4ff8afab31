/* SPDX-License-Identifier: MIT
 * Making the kernels' tree: shapes in, boxes in kernel space, binary tree, wide nodes. */
#pragma once

#include "accel/layout.h"
#include "sched/pool.h"

/* The tree with the memory it stands in. */
typedef struct GiTreeStore {
    GiTree tree;
    GiNode *nodes;
    GiSphereBlock *sphere_blocks;
    GiBoxBlock *box_blocks;
    GiShapeRef *unbounded;
    size_t node_capacity, sphere_block_capacity, box_block_capacity, unbounded_capacity;
    double sah_cost; /* node visits plus block tests a random line through the scene expects */
} GiTreeStore;

/* Builds the tree over the given shapes. On failure nothing is left behind. Errors: MEMORY,
 * CANCELLED. */
GlintStatus gi_tree_build(GiMemory *memory, GiPool *pool, const GiShapes *shapes,
    const GiShapeRef *refs, size_t count, const GlintMonitor *monitor, GiTreeStore *store);
void gi_tree_free(GiMemory *memory, GiTreeStore *store);
