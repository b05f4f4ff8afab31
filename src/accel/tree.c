/* SPDX-License-Identifier: MIT */
#include "accel/tree.h"

#include "accel/build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- kernel space */

static bool box_is_finite(const GiBox *box) {
    return isfinite(box->low.x) && isfinite(box->low.y) && isfinite(box->low.z) &&
           isfinite(box->high.x) && isfinite(box->high.y) && isfinite(box->high.z);
}

static int compare_doubles(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median of the centres of up to 255 shapes, evenly picked. */
static GiVec median_center(const GiShapes *shapes, const GiShapeRef *refs, size_t count) {
    enum { SAMPLE = 255 };
    double samples[3][SAMPLE];
    size_t found = 0, step = count / SAMPLE + 1;
    for (size_t i = 0; i < count && found < SAMPLE; i += step) {
        GiBox box = gi_shape_bounds(shapes, refs[i], GI_SHAPE_NONE);
        if (!box_is_finite(&box)) continue;
        samples[0][found] = box.low.x / 2 + box.high.x / 2;
        samples[1][found] = box.low.y / 2 + box.high.y / 2;
        samples[2][found] = box.low.z / 2 + box.high.z / 2;
        found++;
    }
    if (found == 0) return gi_vec(0, 0, 0);
    for (int axis = 0; axis < 3; axis++) {
        qsort(samples[axis], found, sizeof samples[axis][0], compare_doubles);
    }
    return gi_vec(samples[0][found / 2], samples[1][found / 2], samples[2][found / 2]);
}

typedef struct Prepare {
    const GiShapes *shapes;
    const GiShapeRef *refs;
    GiVec center;
    double scale;
    GiBuildItem *items;
} Prepare;

static inline double larger(double a, double b) { return a > b ? a : b; } /* fmax is a call */

static double largest_component(const GiBox *box, GiVec center) {
    GiVec low = gi_sub(box->low, center), high = gi_sub(box->high, center);
    double x = larger(fabs(low.x), fabs(high.x)), y = larger(fabs(low.y), fabs(high.y)),
           z = larger(fabs(low.z), fabs(high.z));
    return larger(x, larger(y, z));
}

/* Boxes in kernel space, grown by the error bound (layout.h). */
static void prepare_items(void *context, size_t begin, size_t end, int worker) {
    (void)worker;
    const Prepare *prepare = context;
    for (size_t i = begin; i < end; i++) {
        GiBox box = gi_shape_bounds(prepare->shapes, prepare->refs[i], GI_SHAPE_NONE);
        double growth = GI_TREE_GROWTH * largest_component(&box, prepare->center) +
                        GI_TREE_GROWTH_LEAST / prepare->scale;
        const GiVec reach = {growth, growth, growth};
        GiVec low = gi_sub(gi_sub(box.low, prepare->center), reach);
        GiVec high = gi_add(gi_sub(box.high, prepare->center), reach);
        GiBuildItem *item = &prepare->items[i];
        double scale = prepare->scale;
        item->low[0] = (float)(low.x * scale);
        item->low[1] = (float)(low.y * scale);
        item->low[2] = (float)(low.z * scale);
        item->high[0] = (float)(high.x * scale);
        item->high[1] = (float)(high.y * scale);
        item->high[2] = (float)(high.z * scale);
        gi_build_set_id(item, prepare->refs[i].bits);
    }
}

/* ---------------------------------------------------------------- wide nodes */

typedef struct Layout {
    const GiShapes *shapes;
    const GiBuildItem *items;
    const GiBuildNode *nodes;
    GiTreeStore *store;
    double scale;
    GiVec center;
    double root_area;
} Layout;

static bool leaf_is_spheres(const GiBuildItem *items, const GiBuildNode *leaf) {
    for (uint32_t i = 0; i < leaf->count; i++) {
        GiShapeRef ref = {gi_build_id(&items[leaf->first + i])};
        if (gi_shape_kind(ref) != GI_SHAPE_SPHERE) return false;
    }
    return true;
}

static uint32_t emit_spheres(Layout *layout, const GiBuildNode *leaf) {
    GiTree *tree = &layout->store->tree;
    GiSphereBlock *block = &layout->store->sphere_blocks[tree->sphere_block_count];
    for (uint32_t i = 0; i < GI_TREE_WIDTH; i++) {
        if (i >= leaf->count) {
            block->center[0][i] = block->center[1][i] = block->center[2][i] = block->radius[i] =
                NAN;
            block->shape[i].bits = GI_SHAPE_NONE;
            continue;
        }
        GiShapeRef ref = {gi_build_id(&layout->items[leaf->first + i])};
        const GiSphere *sphere = &layout->shapes->spheres[gi_shape_index(ref)];
        GiVec center = gi_scale(gi_sub(sphere->center, layout->center), layout->scale);
        double radius = sphere->radius * layout->scale;
        double farthest = larger(fabs(center.x), larger(fabs(center.y), fabs(center.z))) + radius;
        block->center[0][i] = (float)center.x;
        block->center[1][i] = (float)center.y;
        block->center[2][i] = (float)center.z;
        block->radius[i] = (float)(radius + GI_TREE_GROWTH * farthest + GI_TREE_GROWTH_LEAST);
        block->shape[i] = ref;
    }
    return GI_CHILD_BLOCK | GI_CHILD_SPHERES | tree->sphere_block_count++;
}

static uint32_t emit_boxes(Layout *layout, const GiBuildNode *leaf) {
    GiTree *tree = &layout->store->tree;
    GiBoxBlock *block = &layout->store->box_blocks[tree->box_block_count];
    for (uint32_t i = 0; i < GI_TREE_WIDTH; i++) {
        const GiBuildItem *item = i < leaf->count ? &layout->items[leaf->first + i] : NULL;
        for (int axis = 0; axis < 3; axis++) {
            block->low[axis][i] = item != NULL ? item->low[axis] : INFINITY;
            block->high[axis][i] = item != NULL ? item->high[axis] : -INFINITY;
        }
        block->shape[i].bits = item != NULL ? gi_build_id(item) : GI_SHAPE_NONE;
    }
    return GI_CHILD_BLOCK | tree->box_block_count++;
}

/* The items of a leaf lie anywhere in the array of spheres: without this, emit_spheres waits for
 * memory more than for all else. */
static void fetch_leaf(const Layout *layout, const GiBuildNode *node) {
    for (uint32_t i = 0; i < node->count; i++) {
        GiShapeRef ref = {gi_build_id(&layout->items[node->first + i])};
        if (gi_shape_kind(ref) != GI_SHAPE_SPHERE) continue;
        __builtin_prefetch(&layout->shapes->spheres[gi_shape_index(ref)]);
    }
}

static void add_cost(Layout *layout, const GiBuildNode *node) {
    if (layout->root_area > 0) {
        layout->store->sah_cost += gi_build_area(node->low, node->high) / layout->root_area;
    }
}

/* Emits the subtree depth first, so that what is near in space is near in memory. The recursion is
 * at most GI_TREE_DEPTH_LIMIT deep (build.c bounds the depth of the binary tree). */
static uint32_t emit(Layout *layout, uint32_t index) {
    const GiBuildNode *nodes = layout->nodes;
    add_cost(layout, &nodes[index]);
    if (nodes[index].count > 0) {
        return leaf_is_spheres(layout->items, &nodes[index]) ? emit_spheres(layout, &nodes[index])
                                                             : emit_boxes(layout, &nodes[index]);
    }
    /* Open the inner child of the largest box until there are eight. */
    uint32_t children[GI_TREE_WIDTH] = {nodes[index].first, nodes[index].first + 1};
    int count = 2;
    while (count < GI_TREE_WIDTH) {
        int largest = -1;
        float largest_area = -1;
        for (int i = 0; i < count; i++) {
            const GiBuildNode *child = &nodes[children[i]];
            float area = gi_build_area(child->low, child->high);
            if (child->count == 0 && area > largest_area) {
                largest = i;
                largest_area = area;
            }
        }
        if (largest < 0) break;
        uint32_t first = nodes[children[largest]].first;
        children[largest] = first;
        children[count++] = first + 1;
    }
    uint32_t node_index = layout->store->tree.node_count++;
    GiNode *node = &layout->store->nodes[node_index];
    for (int i = 0; i < GI_TREE_WIDTH; i++) {
        for (int axis = 0; axis < 3; axis++) {
            node->low[axis][i] = i < count ? nodes[children[i]].low[axis] : INFINITY;
            node->high[axis][i] = i < count ? nodes[children[i]].high[axis] : -INFINITY;
        }
        node->child[i] = GI_CHILD_NONE;
    }
    for (int i = 0; i < count; i++) fetch_leaf(layout, &nodes[children[i]]);
    for (int i = 0; i < count; i++) {
        uint32_t child = emit(layout, children[i]);
        layout->store->nodes[node_index].child[i] = child;
    }
    return node_index;
}

static GlintStatus lay_out(GiMemory *memory, const GiShapes *shapes, const GiBuildItem *items,
    const GiBuildTree *binary, GiTreeStore *store) {
    size_t leaves = 0, sphere_leaves = 0;
    for (size_t i = 0; i < binary->node_count; i++) {
        if (binary->nodes[i].count == 0) continue;
        leaves++;
        sphere_leaves += leaf_is_spheres(items, &binary->nodes[i]);
    }
    /* Every wide node swallows at least one inner node; memory that is not used is not touched. */
    store->node_capacity = binary->node_count - leaves;
    store->sphere_block_capacity = sphere_leaves;
    store->box_block_capacity = leaves - sphere_leaves;
    store->nodes = gi_memory_allocate_lines(memory, store->node_capacity, sizeof *store->nodes);
    store->sphere_blocks = gi_memory_allocate_lines(
        memory, store->sphere_block_capacity, sizeof *store->sphere_blocks);
    store->box_blocks =
        gi_memory_allocate_lines(memory, store->box_block_capacity, sizeof *store->box_blocks);
    if (store->nodes == NULL || store->sphere_blocks == NULL || store->box_blocks == NULL) {
        return GLINT_ERROR_MEMORY;
    }
    const GiBuildNode *root = &binary->nodes[0];
    Layout layout = {
        .shapes = shapes,
        .items = items,
        .nodes = binary->nodes,
        .store = store,
        .scale = store->tree.scale,
        .center = store->tree.center,
        .root_area = gi_build_area(root->low, root->high),
    };
    store->tree.root = emit(&layout, 0);
    return GLINT_OK;
}

/* ---------------------------------------------------------------- the whole */

/* Separates what has no finite box (kept in store->unbounded) and finds the scale of the rest. */
static GlintStatus sort_out(GiMemory *memory, const GiShapes *shapes, const GiShapeRef *refs,
    size_t count, GiTreeStore *store) {
    double reach = 0;
    size_t unbounded = 0;
    for (size_t i = 0; i < count; i++) {
        GiBox box = gi_shape_bounds(shapes, refs[i], GI_SHAPE_NONE);
        if (box_is_finite(&box)) {
            reach = larger(reach, largest_component(&box, store->tree.center));
        } else {
            unbounded++;
        }
    }
    store->unbounded_capacity = unbounded;
    if (unbounded > 0) {
        store->unbounded = gi_memory_allocate(memory, unbounded * sizeof *store->unbounded);
        if (store->unbounded == NULL) return GLINT_ERROR_MEMORY;
        for (size_t i = 0; i < count; i++) {
            GiBox box = gi_shape_bounds(shapes, refs[i], GI_SHAPE_NONE);
            if (!box_is_finite(&box)) {
                store->unbounded[store->tree.unbounded_count++] = refs[i];
            }
        }
    }
    int exponent = 0;
    if (reach > 0 && isfinite(reach)) frexp(reach, &exponent);
    store->tree.scale = ldexp(1, exponent < -1000 ? 1000 : -exponent);
    return GLINT_OK;
}

GlintStatus gi_tree_build(GiMemory *memory, GiPool *pool, const GiShapes *shapes,
    const GiShapeRef *refs, size_t count, const GlintMonitor *monitor, GiTreeStore *store) {
    memset(store, 0, sizeof *store);
    store->tree.root = GI_CHILD_NONE;
    store->tree.center = median_center(shapes, refs, count);
    GiBuildItem *items = NULL;
    GiBuildTree binary = {0};
    GlintStatus status = sort_out(memory, shapes, refs, count, store);
    size_t item_count = count - store->tree.unbounded_count;
    if (status == GLINT_OK && item_count > 0) {
        items = gi_memory_allocate_lines(memory, count, sizeof *items);
        if (items == NULL) status = GLINT_ERROR_MEMORY;
    }
    if (status == GLINT_OK && item_count > 0) {
        Prepare prepare = {shapes, refs, store->tree.center, store->tree.scale, items};
        gi_parallel_for(pool, count, 4096, prepare_items, &prepare);
        if (item_count < count) { /* rare: drop the unbounded, keeping the order */
            size_t kept = 0;
            for (size_t i = 0; i < count; i++) {
                GiBox box = gi_shape_bounds(shapes, refs[i], GI_SHAPE_NONE);
                if (box_is_finite(&box)) items[kept++] = items[i];
            }
        }
        status = gi_build(memory, pool, items, item_count, monitor, &binary);
        if (status == GLINT_OK) status = lay_out(memory, shapes, items, &binary, store);
    }
    gi_build_free(memory, &binary);
    gi_memory_free_lines(memory, items, count, sizeof *items);
    if (status != GLINT_OK) {
        gi_tree_free(memory, store);
        return status;
    }
    store->tree.nodes = store->nodes;
    store->tree.sphere_blocks = store->sphere_blocks;
    store->tree.box_blocks = store->box_blocks;
    store->tree.unbounded = store->unbounded;
    return GLINT_OK;
}

void gi_tree_free(GiMemory *memory, GiTreeStore *store) {
    gi_memory_free_lines(memory, store->nodes, store->node_capacity, sizeof *store->nodes);
    gi_memory_free_lines(
        memory, store->sphere_blocks, store->sphere_block_capacity, sizeof *store->sphere_blocks);
    gi_memory_free_lines(
        memory, store->box_blocks, store->box_block_capacity, sizeof *store->box_blocks);
    gi_memory_free(memory, store->unbounded, store->unbounded_capacity * sizeof *store->unbounded);
    memset(store, 0, sizeof *store);
    store->tree.root = GI_CHILD_NONE;
}
