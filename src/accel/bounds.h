/* SPDX-License-Identifier: MIT
 * What trees are built of: boxes with a name, and what encloses many of them. */
#pragma once

#include "math/four.h"

#include <string.h>

/* A box; the fourth lanes hold nothing of use. */
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

/* Twice the centre; the factor does not matter to the builder. */
static inline GiFour gi_bounds_center(const GiBounds *bounds) {
    return gi_four_add(bounds->low, bounds->high);
}

/* The box round many boxes, and the one round their centres. */
typedef struct GiExtent {
    GiBounds bounds, centers;
} GiExtent;

static inline void gi_extent_grow(GiExtent *extent, const GiBounds *box) {
    GiFour center = gi_bounds_center(box);
    gi_bounds_grow(&extent->bounds, box->low, box->high);
    gi_bounds_grow(&extent->centers, center, center);
}

/* One thing to be put into the tree: its box, and in the fourth lanes its id (bits of a uint32_t)
 * and a not-a-number, so that no sum of lanes is slow or means anything. */
typedef struct GiBuildItem {
    float low[4], high[4];
} GiBuildItem;

static inline void gi_build_set(GiBuildItem *item, const GiBounds *box, uint32_t id) {
    gi_four_store(item->low, box->low);
    gi_four_store(item->high, box->high);
    memcpy(&item->low[3], &id, sizeof id);
    item->high[3] = NAN;
}

static inline GiBounds gi_build_box(const GiBuildItem *item) {
    return (GiBounds){gi_four_load(item->low), gi_four_load(item->high)};
}

static inline uint32_t gi_build_id(const GiBuildItem *item) {
    uint32_t id;
    memcpy(&id, &item->low[3], sizeof id);
    return id;
}

static inline GiFour gi_build_center(const GiBuildItem *item) {
    const GiBounds box = gi_build_box(item);
    return gi_bounds_center(&box);
}
