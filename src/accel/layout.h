/* SPDX-License-Identifier: MIT
 * The tree as the kernels read it: nodes of eight children and blocks of eight shapes.
 *
 * The tree only proposes. Its boxes and spheres are single precision and a little too large; what a
 * ray really meets is decided in double precision by shape/hit_template.h on the scene's own
 * numbers. So the tree's layout may change without a pixel changing, as long as it never leaves
 * out a shape that a ray meets.
 *
 * Kernel space. Coordinates are (x - center) * scale, scale a power of two that brings the scene to
 * about unit size; floats then neither overflow nor lose small scenes, and the centre is the median
 * of the shapes, so that one far shape does not cost the others their precision.
 *
 * The error bound. A float coordinate b of a box is within 2^-24 |b| of the true one. The kernels
 * compute with a few more roundings of the same relative size on b and on a ray's origin and
 * direction. Every box and sphere is therefore grown by GI_TREE_GROWTH = 2^-19 times its largest
 * distance from the centre, 32 times one rounding; the kernels say how they stay below that.
 * GI_TREE_GROWTH_LEAST = 2^-40 of the scene's size is added for what double precision loses where a
 * ray's origin is brought into kernel space: 2^-53 of its distance, which may thus be up to 2^13
 * times the scene's size. (From farther away the exact test loses as much itself.) */
#pragma once

#include "shape/shape.h"

#define GI_TREE_GROWTH       0x1p-19
#define GI_TREE_GROWTH_LEAST 0x1p-40

/* A child is a node, a block of shapes or nothing:
 *     bit 31  block (1) or node (0)
 *     bit 30  kind of block: spheres (1) or boxes (0)
 *     29 - 0  index
 * An empty child has an empty box (low +inf, high -inf) and the value GI_CHILD_NONE. */
enum { GI_TREE_WIDTH = 8 };
#define GI_CHILD_BLOCK   0x80000000u
#define GI_CHILD_SPHERES 0x40000000u
#define GI_CHILD_INDEX   0x3fffffffu
#define GI_CHILD_NONE    UINT32_MAX

/* 224 bytes, on a line of 32. */
typedef struct GiNode {
    float low[3][8], high[3][8];
    uint32_t child[8];
} GiNode;

/* Eight spheres. Lanes without one hold not-a-numbers, which fail every comparison. */
typedef struct GiSphereBlock {
    float center[3][8], radius[8];
    GiShapeRef shape[8];
} GiSphereBlock;

/* Eight shapes of any kind in their boxes; lanes without one hold an empty box. */
typedef struct GiBoxBlock {
    float low[3][8], high[3][8];
    GiShapeRef shape[8];
} GiBoxBlock;

enum { GI_TREE_DEPTH_LIMIT = 96 }; /* levels of nodes, at most */

typedef struct GiTree {
    GiVec center;
    double scale;
    uint32_t root; /* a child; GI_CHILD_NONE: an empty tree */
    const GiNode *nodes;
    const GiSphereBlock *sphere_blocks;
    const GiBoxBlock *box_blocks;
    const GiShapeRef *unbounded; /* planes: tested against every ray */
    uint32_t node_count, sphere_block_count, box_block_count, unbounded_count;
} GiTree;
