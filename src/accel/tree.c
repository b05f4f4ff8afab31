/* SPDX-License-Identifier: MIT */
#include "accel/tree.h"

#include "accel/build.h"
#include "base/prefetch.h"

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

static bool box_is_empty(const GiBox *box) { return box->low.x > box->high.x; }

/* Walks over what the tree stands over: the refs, then mesh by mesh the triangles. */
typedef struct Cursor {
    const GiShapes *shapes;
    const GiTreeInput *input;
    size_t next_ref, mesh;
    uint32_t next_triangle; /* of that mesh */
} Cursor;

static size_t input_count(const GiShapes *shapes, const GiTreeInput *input) {
    size_t count = input->ref_count;
    for (size_t i = 0; i < input->mesh_count; i++) {
        count += shapes->meshes[input->meshes[i]].triangle_count;
    }
    return count;
}

static Cursor cursor_at(const GiShapes *shapes, const GiTreeInput *input, size_t index) {
    Cursor cursor = {.shapes = shapes, .input = input, .next_ref = index};
    if (index < input->ref_count) return cursor;
    cursor.next_ref = input->ref_count;
    index -= input->ref_count;
    while (index >= shapes->meshes[input->meshes[cursor.mesh]].triangle_count) {
        index -= shapes->meshes[input->meshes[cursor.mesh++]].triangle_count;
    }
    cursor.next_triangle = (uint32_t)index;
    return cursor;
}

static GiShapeRef cursor_next(Cursor *cursor) {
    const GiTreeInput *input = cursor->input;
    if (cursor->next_ref < input->ref_count) return input->refs[cursor->next_ref++];
    const GiMesh *mesh = &cursor->shapes->meshes[input->meshes[cursor->mesh]];
    while (cursor->next_triangle == mesh->triangle_count) {
        mesh = &cursor->shapes->meshes[input->meshes[++cursor->mesh]];
        cursor->next_triangle = 0;
    }
    return gi_shape_ref(GI_SHAPE_TRIANGLE, mesh->first_triangle + cursor->next_triangle++);
}

/* The median of the centres of up to 255 shapes, evenly picked. */
static GiVec median_center(const GiShapes *shapes, const GiTreeInput *input, size_t count) {
    enum { SAMPLE = 255 };
    double samples[3][SAMPLE];
    size_t found = 0, step = count / SAMPLE + 1;
    for (size_t i = 0; i < count && found < SAMPLE; i += step) {
        Cursor cursor = cursor_at(shapes, input, i);
        GiBox box = gi_shape_bounds(shapes, cursor_next(&cursor), GI_SHAPE_NONE);
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

static inline double larger(double a, double b) { return a > b ? a : b; } /* fmax is a call */
static inline double smaller(double a, double b) { return a < b ? a : b; }

static double largest_component(const GiBox *box, GiVec center) {
    GiVec low = gi_sub(box->low, center), high = gi_sub(box->high, center);
    double x = larger(fabs(low.x), fabs(high.x)), y = larger(fabs(low.y), fabs(high.y)),
           z = larger(fabs(low.z), fabs(high.z));
    return larger(x, larger(y, z));
}

/* What one worker has seen of the shapes, on a cache line of its own. */
typedef struct Survey {
    _Alignas(64) GiBox bounds; /* of what has finite bounds */
    size_t bounded, unbounded;
} Survey;

typedef struct Prepare {
    const GiShapes *shapes;
    const GiTreeInput *input;
    GiVec center;
    double scale;
    Survey *surveys;
    GiBuildItem *items;
} Prepare;

static const GiBox empty_box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static GiBox box_around(const GiBox *a, const GiBox *b) {
    return (GiBox){
        {smaller(a->low.x, b->low.x), smaller(a->low.y, b->low.y), smaller(a->low.z, b->low.z)},
        {larger(a->high.x, b->high.x), larger(a->high.y, b->high.y), larger(a->high.z, b->high.z)}};
}

static void survey_shapes(void *context, size_t begin, size_t end, int worker) {
    const Prepare *prepare = context;
    Survey survey = prepare->surveys[worker];
    Cursor cursor = cursor_at(prepare->shapes, prepare->input, begin);
    for (size_t i = begin; i < end; i++) {
        GiBox box = gi_shape_bounds(prepare->shapes, cursor_next(&cursor), GI_SHAPE_NONE);
        if (box_is_finite(&box)) {
            survey.bounds = box_around(&survey.bounds, &box);
            survey.bounded++;
        } else if (!box_is_empty(&box)) {
            survey.unbounded++;
        }
    }
    prepare->surveys[worker] = survey;
}

typedef struct KernelBox {
    float low[3], high[3];
} KernelBox;

/* A shape's box in kernel space, grown by the error bound (layout.h). What has no finite box begins
 * with not-a-number. */
static KernelBox kernel_box(const GiShapes *shapes, GiShapeRef ref, GiVec center, double scale) {
    GiBox box = gi_shape_bounds(shapes, ref, GI_SHAPE_NONE);
    double growth = GI_TREE_GROWTH * largest_component(&box, center) + GI_TREE_GROWTH_LEAST / scale;
    const GiVec reach = {growth, growth, growth};
    GiVec low = gi_sub(gi_sub(box.low, center), reach);
    GiVec high = gi_add(gi_sub(box.high, center), reach);
    return (KernelBox){{box_is_finite(&box) ? (float)(low.x * scale) : NAN, (float)(low.y * scale),
                           (float)(low.z * scale)},
        {(float)(high.x * scale), (float)(high.y * scale), (float)(high.z * scale)}};
}

static void prepare_items(void *context, size_t begin, size_t end, int worker) {
    (void)worker;
    const Prepare *prepare = context;
    Cursor cursor = cursor_at(prepare->shapes, prepare->input, begin);
    for (size_t i = begin; i < end; i++) {
        GiShapeRef ref = cursor_next(&cursor);
        KernelBox box = kernel_box(prepare->shapes, ref, prepare->center, prepare->scale);
        GiBuildItem *item = &prepare->items[i];
        memcpy(item->low, box.low, sizeof box.low);
        memcpy(item->high, box.high, sizeof box.high);
        gi_build_set_id(item, ref.bits);
    }
}

/* ---------------------------------------------------------------- wide nodes */

typedef struct Layout {
    const GiShapes *shapes;
    const GiTreeInput *input;
    const GiShapeRef *refs;   /* in the order of the leaves */
    const GiBuildItem *items; /* the same with their boxes, or null */
    const GiBuildNode *nodes;
    GiTreeStore *store;
    double scale;
    GiVec center;
    double root_area;
} Layout;

static GiShapeRef item_ref(const Layout *layout, const GiBuildNode *leaf, uint32_t i) {
    return layout->refs[leaf->first + i];
}

static KernelBox item_box(const Layout *layout, const GiBuildNode *leaf, uint32_t i) {
    KernelBox box;
    if (layout->items == NULL) {
        return kernel_box(layout->shapes, item_ref(layout, leaf, i), layout->center, layout->scale);
    }
    const GiBuildItem *item = &layout->items[leaf->first + i];
    memcpy(box.low, item->low, sizeof box.low);
    memcpy(box.high, item->high, sizeof box.high);
    return box;
}

/* Spheres, triangles of one mesh, or boxes of anything. */
static GiChildKind leaf_kind(const Layout *layout, const GiBuildNode *leaf) {
    GiShapeKind kind = gi_shape_kind(item_ref(layout, leaf, 0));
    if (kind != GI_SHAPE_SPHERE && kind != GI_SHAPE_TRIANGLE) return GI_CHILD_BOXES;
    for (uint32_t i = 1; i < leaf->count; i++) {
        if (gi_shape_kind(item_ref(layout, leaf, i)) != kind) return GI_CHILD_BOXES;
    }
    if (kind == GI_SHAPE_SPHERE) return GI_CHILD_SPHERES;
    /* Out of the range of single precision the kernels' scale would be, and their products. */
    if (!(layout->scale > 0x1p-100 && layout->scale < 0x1p100)) return GI_CHILD_BOXES;
    uint32_t first = gi_shape_index(item_ref(layout, leaf, 0));
    const GiMesh *mesh = &layout->shapes->meshes[gi_shape_mesh(layout->shapes, first)];
    for (uint32_t i = 1; i < leaf->count; i++) {
        uint32_t at = gi_shape_index(item_ref(layout, leaf, i)) - mesh->first_triangle;
        if (at >= mesh->triangle_count) return GI_CHILD_BOXES;
    }
    return GI_CHILD_TRIANGLES;
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
        GiShapeRef ref = item_ref(layout, leaf, i);
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
    return gi_child(GI_CHILD_SPHERES, tree->sphere_block_count++);
}

static uint32_t emit_boxes(Layout *layout, const GiBuildNode *leaf) {
    GiTree *tree = &layout->store->tree;
    GiBoxBlock *block = &layout->store->box_blocks[tree->box_block_count];
    for (uint32_t i = 0; i < GI_TREE_WIDTH; i++) {
        if (i >= leaf->count) {
            for (int axis = 0; axis < 3; axis++) {
                block->low[axis][i] = INFINITY;
                block->high[axis][i] = -INFINITY;
            }
            block->shape[i].bits = GI_SHAPE_NONE;
            continue;
        }
        GiShapeRef ref = item_ref(layout, leaf, i);
        KernelBox box = item_box(layout, leaf, i);
        for (int axis = 0; axis < 3; axis++) {
            block->low[axis][i] = box.low[axis];
            block->high[axis][i] = box.high[axis];
        }
        bool triangle = gi_shape_kind(ref) == GI_SHAPE_TRIANGLE;
        block->shape[i] = triangle ? place_triangle(layout, ref) : ref;
    }
    return gi_child(GI_CHILD_BOXES, tree->box_block_count++);
}

/* The items of a leaf lie anywhere in the array of spheres: without this, emit_spheres waits for
 * memory more than for all else. */
static void fetch_leaf(const Layout *layout, const GiBuildNode *node) {
    for (uint32_t i = 0; i < node->count; i++) {
        GiShapeRef ref = item_ref(layout, node, i);
        if (gi_shape_kind(ref) != GI_SHAPE_SPHERE) continue;
        gi_prefetch(&layout->shapes->spheres[gi_shape_index(ref)]);
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
        const GiBuildNode *leaf = &nodes[index];
        switch (leaf_kind(layout, leaf)) {
        case GI_CHILD_SPHERES: return emit_spheres(layout, leaf);
        case GI_CHILD_TRIANGLES: return emit_triangles(layout, leaf);
        default: return emit_boxes(layout, leaf);
        }
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

static GlintStatus lay_out(GiMemory *memory, const GiShapes *shapes, const GiTreeInput *input,
    const GiShapeRef *refs, const GiBuildItem *items, const GiBuildTree *binary,
    GiTreeStore *store) {
    const GiBuildNode *root = &binary->nodes[0];
    Layout layout = {
        .shapes = shapes,
        .input = input,
        .refs = refs,
        .items = items,
        .nodes = binary->nodes,
        .store = store,
        .scale = store->tree.scale,
        .center = store->tree.center,
        .root_area = gi_build_area(root->low, root->high),
    };
    size_t leaves = 0, kinds[4] = {0};
    for (size_t i = 0; i < binary->node_count; i++) {
        if (binary->nodes[i].count == 0) continue;
        leaves++;
        kinds[leaf_kind(&layout, &binary->nodes[i])]++;
    }
    store->leaf_count = leaves;
    /* Every wide node swallows at least one inner node; memory that is not used is not touched. */
    store->node_capacity = binary->node_count - leaves;
    store->sphere_block_capacity = kinds[GI_CHILD_SPHERES];
    store->box_block_capacity = kinds[GI_CHILD_BOXES];
    store->nodes = gi_memory_allocate_lines(memory, store->node_capacity, sizeof *store->nodes);
    store->sphere_blocks = gi_memory_allocate_lines(
        memory, store->sphere_block_capacity, sizeof *store->sphere_blocks);
    store->box_blocks =
        gi_memory_allocate_lines(memory, store->box_block_capacity, sizeof *store->box_blocks);
    if (store->nodes == NULL || store->sphere_blocks == NULL || store->box_blocks == NULL) {
        return GLINT_ERROR_MEMORY;
    }
    store->tree.root = emit(&layout, 0);
    return GLINT_OK;
}

/* ---------------------------------------------------------------- the whole */

static GlintStatus list_unbounded(
    GiMemory *memory, const Prepare *prepare, size_t count, size_t unbounded, GiTreeStore *store) {
    store->unbounded = gi_memory_allocate(memory, unbounded * sizeof *store->unbounded);
    if (store->unbounded == NULL) return GLINT_ERROR_MEMORY;
    store->unbounded_capacity = unbounded;
    Cursor cursor = cursor_at(prepare->shapes, prepare->input, 0);
    for (size_t i = 0; i < count; i++) {
        GiShapeRef ref = cursor_next(&cursor);
        GiBox box = gi_shape_bounds(prepare->shapes, ref, GI_SHAPE_NONE);
        if (box_is_finite(&box) || box_is_empty(&box)) continue;
        store->unbounded[store->tree.unbounded_count++] = ref;
    }
    return GLINT_OK;
}

/* Finds the bounds and the scale, and sets apart what has no finite box; *bounded is the number of
 * the others. */
static GlintStatus sort_out(GiMemory *memory, GiPool *pool, Prepare *prepare, size_t count,
    GiTreeStore *store, size_t *bounded) {
    size_t workers = (size_t)gi_pool_worker_count(pool), unbounded = 0;
    prepare->surveys = gi_memory_allocate_lines(memory, workers, sizeof *prepare->surveys);
    if (prepare->surveys == NULL) return GLINT_ERROR_MEMORY;
    for (size_t i = 0; i < workers; i++) prepare->surveys[i] = (Survey){.bounds = empty_box};
    gi_parallel_for(pool, count, 4096, survey_shapes, prepare);
    GiBox bounds = empty_box;
    *bounded = 0;
    for (size_t i = 0; i < workers; i++) {
        bounds = box_around(&bounds, &prepare->surveys[i].bounds);
        *bounded += prepare->surveys[i].bounded;
        unbounded += prepare->surveys[i].unbounded;
    }
    gi_memory_free_lines(memory, prepare->surveys, workers, sizeof *prepare->surveys);
    double reach = *bounded > 0 ? largest_component(&bounds, store->tree.center) : 0;
    int exponent = 0;
    if (reach > 0 && isfinite(reach)) frexp(reach, &exponent);
    store->tree.scale = prepare->scale = ldexp(1, exponent < -1000 ? 1000 : -exponent);
    store->tree.bounds = bounds;
    if (unbounded == 0) return GLINT_OK;
    store->tree.bounds = (GiBox){empty_box.high, empty_box.low};
    return list_unbounded(memory, prepare, count, unbounded, store);
}

/* Drops the items that have no finite box, keeping the order. */
static void drop_items(GiBuildItem *items, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        if (!isnan(items[i].low[0])) items[kept++] = items[i];
    }
}

/* The items' ids, in the order of the leaves; *boxes_count of them will lie in blocks of boxes. */
static GiShapeRef *leaf_order(
    GiMemory *memory, const GiBuildItem *items, size_t count, size_t *boxes_count) {
    GiShapeRef *refs = gi_memory_allocate(memory, count * sizeof *refs);
    *boxes_count = 0;
    for (size_t i = 0; i < count && refs != NULL; i++) {
        refs[i].bits = gi_build_id(&items[i]);
        GiShapeKind kind = gi_shape_kind(refs[i]);
        *boxes_count += kind != GI_SHAPE_SPHERE && kind != GI_SHAPE_TRIANGLE;
    }
    return refs;
}

GlintStatus gi_tree_build(GiMemory *memory, GiPool *pool, const GiShapes *shapes,
    const GiTreeInput *input, const GlintMonitor *monitor, GiTreeStore *store) {
    size_t count = input_count(shapes, input), item_count = 0;
    memset(store, 0, sizeof *store);
    store->tree.root = GI_CHILD_NONE;
    store->tree.center = median_center(shapes, input, count);
    Prepare prepare = {.shapes = shapes, .input = input, .center = store->tree.center};
    GiBuildTree binary = {0};
    GlintStatus status = sort_out(memory, pool, &prepare, count, store, &item_count);
    if (status == GLINT_OK && item_count > 0) {
        prepare.items = gi_memory_allocate_lines(memory, count, sizeof *prepare.items);
        if (prepare.items == NULL) status = GLINT_ERROR_MEMORY;
    }
    if (status == GLINT_OK && item_count > 0) {
        gi_parallel_for(pool, count, 4096, prepare_items, &prepare);
        if (item_count < count) drop_items(prepare.items, count);
        status = gi_build(memory, pool, prepare.items, item_count, monitor, &binary);
    }
    GiShapeRef *refs = NULL;
    size_t boxes_count = 0;
    if (status == GLINT_OK && item_count > 0) {
        refs = leaf_order(memory, prepare.items, item_count, &boxes_count);
        if (refs == NULL) status = GLINT_ERROR_MEMORY;
    }
    /* Where few boxes are needed again, all go before the wide nodes ask for memory. */
    if (boxes_count <= item_count / 2) {
        gi_memory_free_lines(memory, prepare.items, count, sizeof *prepare.items);
        prepare.items = NULL;
    }
    if (refs != NULL) {
        status = lay_out(memory, shapes, input, refs, prepare.items, &binary, store);
    }
    gi_memory_free_lines(memory, prepare.items, count, sizeof *prepare.items);
    gi_memory_free(memory, refs, item_count * sizeof *refs);
    gi_build_free(memory, &binary);
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
