/* SPDX-License-Identifier: MIT
 * What the walks do, added up for each thread. The kernels do not count: only what is compiled with
 * GI_COUNT does, which is the bench's own kernel and kernel/counting.c. */
#pragma once

#ifdef GI_COUNT
#include <stdint.h>

typedef struct GiCounts {
    uint64_t nodes;  /* a ray, or a bundle, against the eight children of a node */
    uint64_t leaves; /* the same against the up to eight shapes of a leaf */
    uint64_t shapes; /* a ray against a shape by the exact formula */
} GiCounts;
extern _Thread_local GiCounts gi_counts; /* in counting.c */

#define COUNT(member, amount) (gi_counts.member += (uint64_t)(amount))
#else
#define COUNT(member, amount) ((void)0)
#endif
