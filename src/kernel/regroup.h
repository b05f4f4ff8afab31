/* SPDX-License-Identifier: MIT
 * Puts rays that run to one point into an order in which neighbours are close together, so that
 * bundles and packets are narrow. */
#pragma once

#include "math/vec.h"

#include <stdint.h>

enum {
    GI_BUNDLE_SIZE = 2048,
    GI_BUNDLE_ROOM = GI_BUNDLE_SIZE + 16, /* else all arrays would meet in the same cache sets */
    GI_PACKET_SIZE = 16,
    GI_PACKET_COUNT = GI_BUNDLE_SIZE / GI_PACKET_SIZE,
    GI_REGROUP_LIMIT = 16384,
    GI_REGROUP_ROOM = GI_REGROUP_LIMIT + 16 /* kernels read and write whole vectors */
};

typedef struct GiRegroup {
    uint16_t order[GI_REGROUP_LIMIT]; /* a permutation */
    /* Of every bundle of rays in that order, a direction its packets are aligned with, or zero. */
    GiVec side[GI_REGROUP_LIMIT / GI_BUNDLE_SIZE];
    /* private */
    float a[GI_REGROUP_ROOM], b[GI_REGROUP_ROOM], x[GI_REGROUP_ROOM], y[GI_REGROUP_ROOM];
    uint16_t across[GI_REGROUP_LIMIT], along[GI_REGROUP_LIMIT], bundles[GI_REGROUP_LIMIT];
} GiRegroup;
