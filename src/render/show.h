/* SPDX-License-Identifier: MIT
 * Pictures that explain a picture: what the camera rays met, and what the pixels cost. The values
 * are the renderer's own, from the same kernels and shapes. */
#pragma once

#include "render/render.h"

typedef struct GiShow {
    GlintShow what;     /* not PICTURE */
    int samples;        /* of COST */
    const GiView *view; /* through which it is seen */
    float *color;       /* crop_width * crop_height triples, top row first */
    double range[2]; /* filled in: of DEPTH what is white and what is black, of COST 0 and what is
                        white; otherwise 0 */
} GiShow;

/* Errors: MEMORY, CANCELLED. */
GlintStatus gi_show(const GiWorld *world, GiPool *pool, const GiRenderArea *area,
    const GlintMonitor *monitor, GiShow *show, GiRenderCounts *counts);
