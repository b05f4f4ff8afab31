/* SPDX-License-Identifier: MIT
 * From the binary tree to the nodes and blocks of the kernels. */
#pragma once

#include "accel/build.h"
#include "accel/tree.h"

typedef struct GiWideInput {
    const GiShapes *shapes;
    const GiTreeInput *input;
    const GiShapeRef *refs;   /* in the order of the leaves */
    const GiBuildItem *items; /* the same with their boxes, or null */
    const GiBuildTree *binary;
} GiWideInput;

/* Fills the store, which has the centre and the scale. What it holds after a failure is the
 * caller's to free. Errors: MEMORY. */
GlintStatus gi_wide_build(
    GiMemory *memory, GiPool *pool, const GiWideInput *input, GiTreeStore *store);
