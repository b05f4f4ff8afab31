/* SPDX-License-Identifier: MIT
 * What trees are built of: boxes with a name, and what encloses many of them. */
#pragma once

#include "math/four.h"

#include <string.h>

/* One thing to be put into the tree: its box, and in the fourth lanes its id (bits of a uint32_t)
 * and nothing. */
typedef struct GiBuildItem {
    float low[4], high[4];
} GiBuildItem;

static inline uint32_t gi_build_id(const GiBuildItem *item) {
    uint32_t id;
    memcpy(&id, &item->low[3], sizeof id);
    return id;
}

static inline void gi_build_set_id(GiBuildItem *item, uint32_t id) {
    memcpy(&item->low[3], &id, sizeof id);
    item->high[3] = NAN;
}

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

/* The box round items, and the one round their centres. */
typedef struct GiExtent {
    GiBounds bounds, centers;
} GiExtent;

static inline void gi_extent_grow(GiExtent *extent, const GiBuildItem *item) {
    GiFour center = gi_build_center(item);
    gi_bounds_grow(&extent->bounds, gi_four_load(item->low), gi_four_load(item->high));
    gi_bounds_grow(&extent->centers, center, center);
}
