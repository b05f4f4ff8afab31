/* SPDX-License-Identifier: MIT
 * The tree as the kernels read it: nodes of eight children and blocks of up to eight shapes.
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
 * times the scene's size. (From farther away the exact test loses as much itself.)
 *
 * Triangles have no copies in blocks: they stand in the scene in the tree's order, and a child
 * names a range of them. Their corners are single precision already, so the kernels take them as
 * they are, relative to a ray's origin, and no error of the tree's making is in them. */
#pragma once

#include "shape/shape.h"

#define GI_TREE_GROWTH       0x1p-19
#define GI_TREE_GROWTH_LEAST 0x1p-40

/* A child is a node, a block of shapes, a range of triangles of one mesh, or nothing. The two
 * highest bits tell which; the others are the index of the node or block, or of triangles
 *     29 - 27  count - 1
 *     26 - 0   index of the first
 * An empty child has an empty box (low +inf, high -inf) and the value GI_CHILD_NONE. */
enum { GI_TREE_WIDTH = 8 };
typedef enum GiChildKind {
    GI_CHILD_NODE,
    GI_CHILD_TRIANGLES,
    GI_CHILD_BOXES,
    GI_CHILD_SPHERES
} GiChildKind;
#define GI_CHILD_NONE     UINT32_MAX
#define GI_TRIANGLE_LIMIT (1u << 27) /* of all meshes together */

static inline uint32_t gi_child(GiChildKind kind, uint32_t index) {
    return (uint32_t)kind << 30 | index;
}
static inline uint32_t gi_child_triangles(uint32_t first, uint32_t count) {
    return gi_child(GI_CHILD_TRIANGLES, (count - 1) << 27 | first);
}
static inline GiChildKind gi_child_kind(uint32_t child) { return (GiChildKind)(child >> 30); }
static inline uint32_t gi_child_index(uint32_t child) { return child & 0x3fffffffu; }
static inline uint32_t gi_child_first(uint32_t child) { return child & 0x07ffffffu; }
static inline uint32_t gi_child_count(uint32_t child) { return (child >> 27 & 7) + 1; }

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
    GiBox bounds;       /* of all that is in the tree; infinite when something has no bounds */
    bool has_triangles; /* some child is a range of them */
    uint32_t root;      /* a child; GI_CHILD_NONE: an empty tree */
    const GiNode *nodes;
    const GiSphereBlock *sphere_blocks;
    const GiBoxBlock *box_blocks;
    const GiShapeRef *unbounded; /* planes and the like: tested against every ray */
    uint32_t node_count, sphere_block_count, box_block_count, unbounded_count;
} GiTree;
