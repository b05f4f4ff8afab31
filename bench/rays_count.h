/* SPDX-License-Identifier: MIT
 * How much of the tree the rays look at: a pass with a kernel that counts. It is a portable one,
 * and much slower; it walks as all kernels do, so that what it meets is the same. */
#pragma once

#include "rays_glint.h"

/* Of all rays of a set together. A node or a leaf that a bundle of rays meets is met once. */
typedef struct RaysCounts {
    double nodes;  /* with eight children each */
    double leaves; /* with up to eight shapes each */
    double shapes; /* tested exactly, by each ray for itself */
    size_t hit_count;
} RaysCounts;

/* Lends the tracer's world another kernel meanwhile. */
RaysCounts rays_count(GiWorld *world, GlintTracer *tracer, const RaySet *set);
