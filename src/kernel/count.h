/* SPDX-License-Identifier: MIT
 * What the walks do, added up. Only the bench wants to know: it compiles the portable kernel once
 * more with GI_COUNT, and of the library's own kernels nothing of this is a part. */
#pragma once

#ifdef GI_COUNT
#include <stdint.h>

typedef struct GiCounts {
    uint64_t nodes;  /* a ray, or a bundle, against the eight children of a node */
    uint64_t leaves; /* the same against the up to eight shapes of a leaf */
    uint64_t shapes; /* a ray against a shape by the exact formula */
} GiCounts;
extern GiCounts gi_counts;

#define COUNT(member, amount) (gi_counts.member += (uint64_t)(amount))
#else
#define COUNT(member, amount) ((void)0)
#endif
