/* SPDX-License-Identifier: MIT */
#include "accel/tree.h"

#include "accel/build.h"
#include "accel/items.h"
#include "accel/wide.h"

#include <string.h>

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

static GlintStatus build(GiMemory *memory, GiPool *pool, const GiShapes *shapes,
    const GiTreeInput *input, const GlintMonitor *monitor, GiItems *items, GiTreeStore *store) {
    GiBuildTree binary;
    size_t count = items->count;
    GlintStatus status =
        gi_build(memory, pool, items->items, count, &items->extent, monitor, &binary);
    if (status != GLINT_OK) return status;
    LeafOrder order = {items->items, gi_memory_allocate(memory, count * sizeof *order.refs), 0};
    status = GLINT_ERROR_MEMORY;
    if (order.refs != NULL) {
        gi_parallel_for(pool, count, 4096, list_ids, &order);
        /* Where few boxes are needed again, all go before the wide nodes ask for memory. */
        if (order.boxes_count <= count / 2) gi_items_free(memory, items);
        const GiWideInput wide = {shapes, input, order.refs, items->items, &binary};
        status = gi_wide_build(memory, pool, &wide, store);
    }
    gi_memory_free(memory, order.refs, count * sizeof *order.refs);
    gi_build_free(memory, &binary);
    return status;
}

GlintStatus gi_tree_build(GiMemory *memory, GiPool *pool, const GiShapes *shapes,
    const GiTreeInput *input, const GlintMonitor *monitor, GiTreeStore *store) {
    memset(store, 0, sizeof *store);
    store->tree.root = GI_CHILD_NONE;
    GiItems items;
    GlintStatus status = gi_items_make(memory, pool, shapes, input, store, &items);
    if (status == GLINT_OK && items.items != NULL) {
        status = build(memory, pool, shapes, input, monitor, &items, store);
    }
    gi_items_free(memory, &items);
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
