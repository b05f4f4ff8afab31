/* SPDX-License-Identifier: MIT
 * Shapes' boxes in kernel space (layout.h). */
#pragma once

#include "accel/bounds.h"
#include "accel/layout.h"

#include <math.h>

static inline double gi_larger(double a, double b) { return a > b ? a : b; } /* fmax is a call */
static inline double gi_smaller(double a, double b) { return a < b ? a : b; }

/* Whether a tree can hold a box: it ends, and not so far out that the difference of two places in
 * such boxes might overflow. What it cannot hold is tested against every ray. */
static inline bool gi_box_is_bounded(const GiBox *box) {
    const double limit = 0x1p1000;
    return fabs(box->low.x) < limit && fabs(box->low.y) < limit && fabs(box->low.z) < limit &&
           fabs(box->high.x) < limit && fabs(box->high.y) < limit && fabs(box->high.z) < limit;
}

/* How far a box reaches from the centre along an axis, at most. */
static inline double gi_box_reach(const GiBox *box, GiVec center) {
    GiVec low = gi_sub(box->low, center), high = gi_sub(box->high, center);
    double x = gi_larger(fabs(low.x), fabs(high.x)), y = gi_larger(fabs(low.y), fabs(high.y)),
           z = gi_larger(fabs(low.z), fabs(high.z));
    return gi_larger(x, gi_larger(y, z));
}

/* A shape's bounded box in kernel space, grown by the error bound (layout.h). */
static inline GiBounds gi_kernel_box(const GiBox *box, GiVec center, double scale) {
    double growth = GI_TREE_GROWTH * gi_box_reach(box, center) + GI_TREE_GROWTH_LEAST / scale;
    const GiVec reach = {growth, growth, growth};
    GiVec low = gi_scale(gi_sub(gi_sub(box->low, center), reach), scale);
    GiVec high = gi_scale(gi_add(gi_sub(box->high, center), reach), scale);
    return (GiBounds){gi_four_of((float)low.x, (float)low.y, (float)low.z, NAN),
        gi_four_of((float)high.x, (float)high.y, (float)high.z, NAN)};
}
