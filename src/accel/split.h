/* SPDX-License-Identifier: MIT
 * One step of the builder: items, or clusters of items, sorted to the two sides of the best plane.
 */
#pragma once

#include "accel/build.h"
#include "math/four.h"

/* A box; the fourth lane holds nothing of use. */
typedef struct GiBounds {
    GiFour low, high;
} GiBounds;

static inline GiBounds gi_bounds_empty(void) {
    return (GiBounds){gi_four(INFINITY), gi_four(-INFINITY)};
}

static inline void gi_bounds_grow(GiBounds *bounds, GiFour low, GiFour high) {
    bounds->low = gi_four_min(bounds->low, low);
    bounds->high = gi_four_max(bounds->high, high);
}

/* Twice the centre; the factor does not matter to the bins. */
static inline GiFour gi_build_center(const GiBuildItem *item) {
    return gi_four_add(gi_four_load(item->low), gi_four_load(item->high));
}

/* The box round items, and the one round their centres. count > 0. */
GiBounds gi_bounds_of(const GiBuildItem *items, size_t count);
GiBounds gi_centers_of(const GiBuildItem *items, size_t count);

/* Sorts the items to two sides, and gives the box round each. Returns how many went left; 0: no
 * plane parts the centres. weights: of clusters, by id, how many items each stands for; null for
 * plain items. */
size_t gi_split(GiBuildItem *items, size_t count, const uint32_t *weights, GiBounds sides[2]);
