/* SPDX-License-Identifier: MIT
 * Tracing with Glint's kernels: as the renderer calls them, and ray by ray. */
#pragma once

#include "rays_set.h"

/* One pass over all rays of a set. */
typedef struct RayPass {
    double seconds; /* of this thread */
    size_t hit_count;
} RayPass;

typedef struct GlintTracer GlintTracer;

GlintTracer *glint_tracer_create(const GiWorld *world);
void glint_tracer_destroy(GlintTracer *tracer);

/* Camera rays: tiles of 128 x 128 pixels in bundles; making the rays is part of the time. Shadow
 * rays: the points of a tile and a light, regrouped, in bundles; all of that is part of the time.
 * Bounces: many rays, 256 a call as the renderer hands them on. */
RayPass glint_trace_together(GlintTracer *tracer, const RaySet *set);
RayPass glint_trace_single(const GlintTracer *tracer, const RaySet *set);

/* What this thread has used of the processor. */
double rays_seconds(void);
