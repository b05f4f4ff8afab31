/* SPDX-License-Identifier: MIT
 * First one thread says what stands where: it opens binary nodes into wide ones, depth first,
 * numbers the blocks and gives triangles their places. Then all workers fill the blocks, which is
 * most of the work, since their shapes lie anywhere in memory. */
#include "accel/wide.h"

#include "accel/kernel_box.h"
#include "base/prefetch.h"
#include "port/machine.h"

#include <math.h>

typedef struct Layout {
    const GiShapes *shapes;
    const GiTreeInput *input;
    const GiShapeRef *refs;
    const GiBuildItem *items;
    const GiBuildNode *nodes;
    size_t node_count;
    GiTreeStore *store;
    double scale;
    GiVec center;
    double area;                          /* of all nodes and leaves so far */
    _Atomic size_t kinds[4];              /* how many leaves there are of each */
    uint32_t *sphere_leaves, *box_leaves; /* the leaf of each block */
} Layout;

static GiShapeRef item_ref(const Layout *layout, const GiBuildNode *leaf, uint32_t i) {
    return layout->refs[leaf->first + i];
}

/* ---------------------------------------------------------------- leaves */

/* Spheres, triangles of one mesh, or boxes of anything. */
static GiChildKind leaf_kind(const Layout *layout, const GiBuildNode *leaf) {
    GiShapeRef ref = item_ref(layout, leaf, 0);
    GiShapeKind kind = gi_shape_kind(ref);
    uint32_t first = 0, count = GI_SHAPE_INDEX_LIMIT; /* of those that may be in one block */
    if (kind != GI_SHAPE_SPHERE && kind != GI_SHAPE_TRIANGLE) return GI_CHILD_BOXES;
    if (kind == GI_SHAPE_TRIANGLE) {
        /* Out of the range of single precision the kernels' scale would be, and their products. */
        if (!(layout->scale > 0x1p-100 && layout->scale < 0x1p100)) return GI_CHILD_BOXES;
        uint32_t index = gi_shape_mesh(layout->shapes, gi_shape_index(ref));
        first = layout->shapes->meshes[index].first_triangle;
        count = layout->shapes->meshes[index].triangle_count;
    }
    first = gi_shape_ref(kind, first).bits;
    for (uint32_t i = 1; i < leaf->count; i++) {
        if (item_ref(layout, leaf, i).bits - first >= count) return GI_CHILD_BOXES;
    }
    return kind == GI_SHAPE_SPHERE ? GI_CHILD_SPHERES : GI_CHILD_TRIANGLES;
}

/* Gives a triangle the next place in its mesh. */
static GiShapeRef place_triangle(Layout *layout, GiShapeRef ref) {
    uint32_t mesh = gi_shape_mesh(layout->shapes, gi_shape_index(ref));
    uint32_t place = layout->shapes->meshes[mesh].first_triangle + layout->input->placed[mesh]++;
    layout->input->original[place] = gi_shape_index(ref);
    return gi_shape_ref(GI_SHAPE_TRIANGLE, place);
}

static uint32_t emit_triangles(Layout *layout, const GiBuildNode *leaf) {
    layout->store->tree.has_triangles = true;
    uint32_t first = gi_shape_index(place_triangle(layout, item_ref(layout, leaf, 0)));
    for (uint32_t i = 1; i < leaf->count; i++) place_triangle(layout, item_ref(layout, leaf, i));
    return gi_child_triangles(first, leaf->count);
}

static uint32_t emit_spheres(Layout *layout, uint32_t leaf) {
    uint32_t block = layout->store->tree.sphere_block_count++;
    layout->sphere_leaves[block] = leaf;
    return gi_child(GI_CHILD_SPHERES, block);
}

static uint32_t emit_boxes(Layout *layout, uint32_t index) {
    const GiBuildNode *leaf = &layout->nodes[index];
    uint32_t block = layout->store->tree.box_block_count++;
    layout->box_leaves[block] = index;
    for (uint32_t i = 0; i < leaf->count; i++) {
        GiShapeRef ref = item_ref(layout, leaf, i);
        bool triangle = gi_shape_kind(ref) == GI_SHAPE_TRIANGLE;
        layout->store->box_blocks[block].shape[i] = triangle ? place_triangle(layout, ref) : ref;
    }
    return gi_child(GI_CHILD_BOXES, block);
}

/* ---------------------------------------------------------------- nodes */

/* Children of a wide node to be; leaves, which cannot be opened, have the area -1. */
typedef struct Children {
    uint32_t nodes[GI_TREE_WIDTH];
    float areas[GI_TREE_WIDTH];
    int count;
} Children;

static inline void set_child(Children *children, int i, const GiBuildNode *nodes, uint32_t index) {
    const GiBuildNode *node = &nodes[index];
    children->nodes[i] = index;
    children->areas[i] = node->count == 0 ? gi_build_area(node->low, node->high) : -1;
}

/* Opens the inner child of the largest box until there are eight. */
static void gather_children(const GiBuildNode *nodes, uint32_t parent, Children *children) {
    int largest = 0;
    for (children->count = 1;; children->count++) {
        uint32_t first = nodes[parent].first;
        set_child(children, largest, nodes, first);
        set_child(children, children->count, nodes, first + 1);
        if (children->count + 1 == GI_TREE_WIDTH) break;
        for (int i = 0; i <= children->count; i++) {
            if (children->areas[i] > children->areas[largest]) largest = i;
        }
        if (children->areas[largest] < 0) break;
        parent = children->nodes[largest];
    }
    children->count++;
}

/* Emits the subtree depth first, so that what is near in space is near in memory. The recursion is
 * at most GI_TREE_DEPTH_LIMIT deep (build.c bounds the depth of the binary tree). */
static uint32_t emit(Layout *layout, uint32_t index) {
    const GiBuildNode *nodes = layout->nodes;
    layout->area += gi_build_area(nodes[index].low, nodes[index].high);
    if (nodes[index].count > 0) {
        const GiBuildNode *leaf = &nodes[index];
        switch (leaf_kind(layout, leaf)) {
        case GI_CHILD_SPHERES: return emit_spheres(layout, index);
        case GI_CHILD_TRIANGLES: return emit_triangles(layout, leaf);
        default: return emit_boxes(layout, index);
        }
    }
    Children children;
    gather_children(nodes, index, &children);
    int count = children.count;
    uint32_t node_index = layout->store->tree.node_count++;
    GiNode *node = &layout->store->nodes[node_index];
    for (int i = 0; i < GI_TREE_WIDTH; i++) {
        for (int axis = 0; axis < 3; axis++) {
            node->low[axis][i] = i < count ? nodes[children.nodes[i]].low[axis] : INFINITY;
            node->high[axis][i] = i < count ? nodes[children.nodes[i]].high[axis] : -INFINITY;
        }
        node->child[i] = GI_CHILD_NONE;
    }
    for (int i = 0; i < count; i++) {
        uint32_t child = emit(layout, children.nodes[i]);
        layout->store->nodes[node_index].child[i] = child;
    }
    return node_index;
}

/* ---------------------------------------------------------------- blocks */

static void fill_sphere_block(const Layout *layout, const GiBuildNode *leaf, GiSphereBlock *block) {
    for (uint32_t i = 0; i < GI_TREE_WIDTH; i++) {
        if (i >= leaf->count) {
            block->center[0][i] = block->center[1][i] = block->center[2][i] = block->radius[i] =
                NAN;
            block->shape[i].bits = GI_SHAPE_NONE;
            continue;
        }
        GiShapeRef ref = item_ref(layout, leaf, i);
        const GiSphere *sphere = &layout->shapes->spheres[gi_shape_index(ref)];
        GiVec center = gi_scale(gi_sub(sphere->center, layout->center), layout->scale);
        double radius = sphere->radius * layout->scale;
        double farthest =
            gi_larger(fabs(center.x), gi_larger(fabs(center.y), fabs(center.z))) + radius;
        block->center[0][i] = (float)center.x;
        block->center[1][i] = (float)center.y;
        block->center[2][i] = (float)center.z;
        block->radius[i] = (float)(radius + GI_TREE_GROWTH * farthest + GI_TREE_GROWTH_LEAST);
        block->shape[i] = ref;
    }
}

/* The spheres of a leaf lie anywhere: without this, filling would wait for memory more than for all
 * else. */
static void fetch_spheres(const Layout *layout, const GiBuildNode *leaf) {
    for (uint32_t i = 0; i < leaf->count; i++) {
        gi_prefetch(&layout->shapes->spheres[gi_shape_index(item_ref(layout, leaf, i))]);
    }
}

static void fill_sphere_blocks(void *context, size_t begin, size_t end, int worker) {
    enum { AHEAD = 3 };
    (void)worker;
    const Layout *layout = context;
    const uint32_t *leaves = layout->sphere_leaves;
    for (size_t i = begin; i < end; i++) {
        if (i + AHEAD < end) fetch_spheres(layout, &layout->nodes[leaves[i + AHEAD]]);
        fill_sphere_block(layout, &layout->nodes[leaves[i]], &layout->store->sphere_blocks[i]);
    }
}

static GiBounds item_box(const Layout *layout, const GiBuildNode *leaf, uint32_t i) {
    if (layout->items != NULL) return gi_build_box(&layout->items[leaf->first + i]);
    GiBox box = gi_shape_bounds(layout->shapes, item_ref(layout, leaf, i), GI_SHAPE_NONE);
    return gi_kernel_box(&box, layout->center, layout->scale);
}

static void fill_box_block(const Layout *layout, const GiBuildNode *leaf, GiBoxBlock *block) {
    for (uint32_t i = 0; i < GI_TREE_WIDTH; i++) {
        GiBounds box = i < leaf->count ? item_box(layout, leaf, i) : gi_bounds_empty();
        float low[4], high[4];
        gi_four_store(low, box.low);
        gi_four_store(high, box.high);
        for (int axis = 0; axis < 3; axis++) {
            block->low[axis][i] = low[axis];
            block->high[axis][i] = high[axis];
        }
        if (i >= leaf->count) block->shape[i].bits = GI_SHAPE_NONE;
    }
}

static void fill_box_blocks(void *context, size_t begin, size_t end, int worker) {
    (void)worker;
    const Layout *layout = context;
    for (size_t i = begin; i < end; i++) {
        const GiBuildNode *leaf = &layout->nodes[layout->box_leaves[i]];
        fill_box_block(layout, leaf, &layout->store->box_blocks[i]);
    }
}

/* ---------------------------------------------------------------- the whole */

static void count_leaves(void *context, size_t begin, size_t end, int worker) {
    (void)worker;
    Layout *layout = context;
    size_t kinds[4] = {0};
    for (size_t i = begin; i < end; i++) {
        if (layout->nodes[i].count > 0) kinds[leaf_kind(layout, &layout->nodes[i])]++;
    }
    for (int kind = 0; kind < 4; kind++) {
        atomic_fetch_add_explicit(&layout->kinds[kind], kinds[kind], memory_order_relaxed);
    }
}

static void *allocate_large(GiMemory *memory, size_t count, size_t size) {
    void *lines = gi_memory_allocate_lines(memory, count, size);
    gi_machine_large_pages(lines, count * size);
    return lines;
}

static bool allocate(GiMemory *memory, Layout *layout) {
    GiTreeStore *store = layout->store;
    size_t spheres = layout->kinds[GI_CHILD_SPHERES], boxes = layout->kinds[GI_CHILD_BOXES];
    store->leaf_count = spheres + boxes + layout->kinds[GI_CHILD_TRIANGLES];
    /* Every wide node swallows at least one inner node; memory that is not used is not touched. */
    store->node_capacity = layout->node_count - store->leaf_count;
    store->sphere_block_capacity = spheres;
    store->box_block_capacity = boxes;
    store->nodes = allocate_large(memory, store->node_capacity, sizeof *store->nodes);
    store->sphere_blocks = allocate_large(memory, spheres, sizeof *store->sphere_blocks);
    store->box_blocks = allocate_large(memory, boxes, sizeof *store->box_blocks);
    layout->sphere_leaves = gi_memory_allocate_lines(memory, spheres, sizeof(uint32_t));
    layout->box_leaves = gi_memory_allocate_lines(memory, boxes, sizeof(uint32_t));
    return store->nodes != NULL && store->sphere_blocks != NULL && store->box_blocks != NULL &&
           layout->sphere_leaves != NULL && layout->box_leaves != NULL;
}

GlintStatus gi_wide_build(
    GiMemory *memory, GiPool *pool, const GiWideInput *input, GiTreeStore *store) {
    const GiBuildNode *root = &input->binary->nodes[0];
    Layout layout = {
        .shapes = input->shapes,
        .input = input->input,
        .refs = input->refs,
        .items = input->items,
        .nodes = input->binary->nodes,
        .node_count = input->binary->node_count,
        .store = store,
        .scale = store->tree.scale,
        .center = store->tree.center,
    };
    gi_parallel_for(pool, layout.node_count, 1024, count_leaves, &layout);
    bool allocated = allocate(memory, &layout);
    if (allocated) {
        store->tree.root = emit(&layout, 0);
        double root_area = gi_build_area(root->low, root->high);
        if (root_area > 0) store->sah_cost = layout.area / root_area;
        gi_parallel_for(pool, store->tree.sphere_block_count, 128, fill_sphere_blocks, &layout);
        gi_parallel_for(pool, store->tree.box_block_count, 128, fill_box_blocks, &layout);
    }
    gi_memory_free_lines(
        memory, layout.sphere_leaves, store->sphere_block_capacity, sizeof(uint32_t));
    gi_memory_free_lines(memory, layout.box_leaves, store->box_block_capacity, sizeof(uint32_t));
    return allocated ? GLINT_OK : GLINT_ERROR_MEMORY;
}
