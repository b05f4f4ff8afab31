/* SPDX-License-Identifier: MIT
 * Puts rays that run to one point into an order in which neighbours are close together, so that
 * the bundles of 1024 and packets of 16 are narrow. */
#pragma once

#include "math/vec.h"

#include <stdbool.h>
#include <stdint.h>

enum { GI_REGROUP_LIMIT = 16384 };

typedef struct GiRegroup {
    uint16_t order[GI_REGROUP_LIMIT]; /* a permutation */
    /* private */
    float a[GI_REGROUP_LIMIT + 16], b[GI_REGROUP_LIMIT + 16];
    uint16_t bucket[GI_REGROUP_LIMIT];
    uint16_t key[GI_REGROUP_LIMIT], curve[128 * 128];
    bool drawn; /* the curve; the caller sets it to false before the first use */
} GiRegroup;
