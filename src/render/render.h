/* SPDX-License-Identifier: MIT
 * Drawing a world into memory. */
#pragma once

#include "image/png.h"
#include "render/world.h"

typedef struct GiRenderCounts {
    uint64_t camera_rays, shadow_rays;
    uint64_t other_rays; /* mirrored, refracted, scattered */
} GiRenderCounts;

/* The part of a picture to draw; x and y count from the top left corner. */
typedef struct GiRenderArea {
    int width, height, x, y, crop_width, crop_height;
} GiRenderArea;

/* How large lights are found; the mean is the same. Tests compare them, pictures take both. */
typedef enum GiTechnique {
    GI_TECHNIQUE_BOTH, /* weighted by their densities */
    GI_TECHNIQUE_LIGHT,
    GI_TECHNIQUE_BSDF
} GiTechnique;

typedef struct GiRecord GiRecord; /* render/record.h */

/* What to draw, and where to: crop_width * crop_height values or triples, top row first; any may be
 * null. */
typedef struct GiRenderTarget {
    int samples;        /* per pixel, at least 1 */
    const GiView *view; /* null: the scene's own */
    float *color, *depth, *normal, *albedo;
    uint32_t *surface;
    GiPng *png; /* of crop_width * crop_height pixels; what is ready is sent while others draw */
    int light;  /* as in GlintRenderDesc */
    GlintSampling sampling;
    GiTechnique technique;
    GiRecord *record; /* null; or what happens is noted, and the area is one pixel */
} GiRenderTarget;

/* No tile is smaller, but at the border: a picture has no use for more workers than it has squares
 * of this side. */
enum { GI_RENDER_TILE_LEAST = 32 };

/* Errors: MEMORY, CANCELLED (also when the receiver of the PNG has stopped). */
GlintStatus gi_render(const GiWorld *world, GiPool *pool, const GiRenderArea *area,
    const GlintMonitor *monitor, const GiRenderTarget *target, GiRenderCounts *counts);
