/* SPDX-License-Identifier: MIT */
#include "kernel/counting.h"

#define GI_ISA   portable
#define GI_COUNT 1
#include "shape/hit.h"
#include "kernel/count.h"
#include "kernel/wide.h"

#define GI_KERNEL(name) count_##name
#include "kernel/single.h"

_Thread_local GiCounts gi_counts;

static void count_many_closest(
    const GiTrace *trace, const GiTraceRay *rays, int count, GiTraceHit *hits) {
    for (int i = 0; i < count; i++) count_closest(trace, &rays[i], &hits[i]);
}

static void count_many_any(const GiTrace *trace, const GiTraceRay *rays, int count, bool *blocked) {
    for (int i = 0; i < count; i++) blocked[i] = count_any(trace, &rays[i]);
}

static void count_bundle_closest(const GiTrace *trace, GiBundle *bundle) {
    for (int i = 0; i < bundle->count; i++) {
        GiTraceRay ray = {bundle->apex, gi_bundle_direction(bundle, i), bundle->start, bundle->t[i],
            GI_SHAPE_NONE, GI_SHAPE_NONE};
        GiTraceHit hit;
        count_closest(trace, &ray, &hit);
        bundle->shape[i] = hit.shape.bits;
        bundle->instance[i] = hit.instance;
        bundle->t[i] = hit.t;
    }
}

static void count_bundle_any(const GiTrace *trace, GiBundle *bundle) {
    for (int i = 0; i < bundle->count; i++) {
        GiVec origin = {bundle->ox[i], bundle->oy[i], bundle->oz[i]};
        GiTraceRay ray = {origin, gi_sub(bundle->apex, origin), bundle->t_min[i], bundle->end,
            bundle->skip[i], bundle->skip_instance[i]};
        bundle->shape[i] = count_any(trace, &ray) ? 0 : GI_SHAPE_NONE;
    }
}

GiKernel gi_counting_kernel(const GiKernel *kernel) {
    GiKernel counting = *kernel;
    counting.closest = count_closest;
    counting.any = count_any;
    counting.many_closest = count_many_closest;
    counting.many_any = count_many_any;
    counting.bundle_closest = count_bundle_closest;
    counting.bundle_any = count_bundle_any;
    return counting;
}

uint64_t gi_counting_take(void) {
    uint64_t sum = gi_counts.nodes + gi_counts.leaves + gi_counts.shapes;
    gi_counts = (GiCounts){0, 0, 0};
    return sum;
}
