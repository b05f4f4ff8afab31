/* SPDX-License-Identifier: MIT
 * What goes before the tree and comes after it: kernel space, the boxes in it, and what has none.
 */
#include "accel/tree.h"

#include "accel/build.h"
#include "accel/kernel_box.h"
#include "accel/wide.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- kernel space */

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
        if (!gi_box_is_finite(&box)) continue;
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
    return (GiBox){{gi_smaller(a->low.x, b->low.x), gi_smaller(a->low.y, b->low.y),
                       gi_smaller(a->low.z, b->low.z)},
        {gi_larger(a->high.x, b->high.x), gi_larger(a->high.y, b->high.y),
            gi_larger(a->high.z, b->high.z)}};
}

static void survey_shapes(void *context, size_t begin, size_t end, int worker) {
    const Prepare *prepare = context;
    Survey survey = prepare->surveys[worker];
    Cursor cursor = cursor_at(prepare->shapes, prepare->input, begin);
    for (size_t i = begin; i < end; i++) {
        GiBox box = gi_shape_bounds(prepare->shapes, cursor_next(&cursor), GI_SHAPE_NONE);
        if (gi_box_is_finite(&box)) {
            survey.bounds = box_around(&survey.bounds, &box);
            survey.bounded++;
        } else if (!box_is_empty(&box)) {
            survey.unbounded++;
        }
    }
    prepare->surveys[worker] = survey;
}

static void prepare_items(void *context, size_t begin, size_t end, int worker) {
    (void)worker;
    const Prepare *prepare = context;
    Cursor cursor = cursor_at(prepare->shapes, prepare->input, begin);
    for (size_t i = begin; i < end; i++) {
        GiShapeRef ref = cursor_next(&cursor);
        GiKernelBox box = gi_kernel_box(prepare->shapes, ref, prepare->center, prepare->scale);
        GiBuildItem *item = &prepare->items[i];
        memcpy(item->low, box.low, sizeof box.low);
        memcpy(item->high, box.high, sizeof box.high);
        gi_build_set_id(item, ref.bits);
    }
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
        if (gi_box_is_finite(&box) || box_is_empty(&box)) continue;
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
    double reach = *bounded > 0 ? gi_box_reach(&bounds, store->tree.center) : 0;
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

/* The items' ids, in the order of the leaves. */
typedef struct LeafOrder {
    const GiBuildItem *items;
    GiShapeRef *refs;
    _Atomic size_t boxes_count; /* how many will lie in blocks of boxes */
} LeafOrder;

static void list_ids(void *context, size_t begin, size_t end, int worker) {
    (void)worker;
    LeafOrder *order = context;
    size_t boxes_count = 0;
    for (size_t i = begin; i < end; i++) {
        GiShapeRef ref = {gi_build_id(&order->items[i])};
        GiShapeKind kind = gi_shape_kind(ref);
        order->refs[i] = ref;
        boxes_count += kind != GI_SHAPE_SPHERE && kind != GI_SHAPE_TRIANGLE;
    }
    atomic_fetch_add_explicit(&order->boxes_count, boxes_count, memory_order_relaxed);
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
    LeafOrder order = {.items = prepare.items};
    if (status == GLINT_OK && item_count > 0) {
        order.refs = gi_memory_allocate(memory, item_count * sizeof *order.refs);
        if (order.refs == NULL) status = GLINT_ERROR_MEMORY;
    }
    if (order.refs != NULL) gi_parallel_for(pool, item_count, 4096, list_ids, &order);
    /* Where few boxes are needed again, all go before the wide nodes ask for memory. */
    if (order.boxes_count <= item_count / 2) {
        gi_memory_free_lines(memory, prepare.items, count, sizeof *prepare.items);
        prepare.items = NULL;
    }
    if (order.refs != NULL) {
        const GiWideInput wide = {shapes, input, order.refs, prepare.items, &binary};
        status = gi_wide_build(memory, pool, &wide, store);
    }
    gi_memory_free_lines(memory, prepare.items, count, sizeof *prepare.items);
    gi_memory_free(memory, order.refs, item_count * sizeof *order.refs);
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
