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
    size_t leaf_count; /* blocks and ranges of triangles */
    double sah_cost;   /* node visits plus block tests a random line through the scene expects */
} GiTreeStore;

/* What a tree stands over: refs, and all triangles of some meshes, which need no list. Triangles
 * get new places within their mesh, in the order of the tree: original[place] = index now. placed
 * counts the places given, mesh by mesh. Both arrays are for all meshes of the scene, and every
 * triangle is in one tree at most. The tree speaks of the new places; bringing the triangles there
 * is left to the caller. Triangles without area get none. */
typedef struct GiTreeInput {
    const GiShapeRef *refs;
    const uint32_t *meshes;
    size_t ref_count, mesh_count;
    uint32_t *original, *placed;
} GiTreeInput;

/* On failure nothing is left behind. Errors: MEMORY, CANCELLED. */
GlintStatus gi_tree_build(GiMemory *memory, GiPool *pool, const GiShapes *shapes,
    const GiTreeInput *input, const GlintMonitor *monitor, GiTreeStore *store);
void gi_tree_free(GiMemory *memory, GiTreeStore *store);
