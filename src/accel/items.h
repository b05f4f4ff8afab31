/* SPDX-License-Identifier: MIT
 * What goes before the tree: kernel space, the shapes' boxes in it, and what has none. */
#pragma once

#include "accel/bounds.h"
#include "accel/tree.h"

/* Of all shapes that have a bounded box (kernel_box.h). */
typedef struct GiItems {
    GiBuildItem *items; /* null where there are none */
    size_t count, capacity;
    GiExtent extent;
} GiItems;

/* Gives the store's tree its kernel space, its bounds and what is unbounded. Errors: MEMORY; what
 * the store then holds is the caller's to free. */
GlintStatus gi_items_make(GiMemory *memory, GiPool *pool, const GiShapes *shapes,
    const GiTreeInput *input, GiTreeStore *store, GiItems *items);
void gi_items_free(GiMemory *memory, GiItems *items);
