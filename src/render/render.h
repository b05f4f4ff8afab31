/* SPDX-License-Identifier: MIT
 * Drawing a world into memory. */
#pragma once

#include "render/world.h"

typedef struct GiRenderCounts {
    uint64_t camera_rays, shadow_rays;
    uint64_t other_rays; /* mirrored, refracted, scattered */
} GiRenderCounts;

/* The part of a picture to draw; x and y count from the top left corner. */
typedef struct GiRenderArea {
    int width, height, x, y, crop_width, crop_height;
} GiRenderArea;

/* pixels: crop_width * crop_height * 3 floats, top row first. Errors: MEMORY, CANCELLED. */
GlintStatus gi_render(const GiWorld *world, GiPool *pool, const GiRenderArea *area,
    const GlintMonitor *monitor, float *pixels, GiRenderCounts *counts);
