/* SPDX-License-Identifier: MIT */
#include "rays_count.h"

#define GI_COUNT 1
#include "kernel/count.h"

extern const GiKernel gi_kernel_counting;

RaysCounts rays_count(GiWorld *world, GlintTracer *tracer, const RaySet *set) {
    const GiKernel *kernel = world->kernel;
    gi_counts = (GiCounts){0, 0, 0};
    world->kernel = &gi_kernel_counting;
    size_t hit_count = glint_trace_together(tracer, set).hit_count;
    world->kernel = kernel;
    return (RaysCounts){
        (double)gi_counts.nodes, (double)gi_counts.leaves, (double)gi_counts.shapes, hit_count};
}
