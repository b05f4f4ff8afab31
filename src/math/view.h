/* SPDX-License-Identifier: MIT
 * From a place in the picture to a ray. */
#pragma once

#include "math/vec.h"

/* A camera made ready: the window's centre relative to the eye and its two sides. */
typedef struct GiView {
    bool parallel;
    GiVec eye;
    GiVec center;     /* perspective: eye to centre of the window; parallel: unit direction */
    GiVec across, up; /* the window's whole width and height */
} GiView;

/* a and b run from 0 to 1, left to right and bottom to top. The direction has unit length. */
static inline void gi_view_ray(
    const GiView *view, double a, double b, GiVec *origin, GiVec *direction) {
    GiVec p = gi_add(gi_scale(view->across, a - 0.5), gi_scale(view->up, b - 0.5));
    *origin = view->parallel ? gi_add(view->eye, p) : view->eye;
    *direction = view->parallel ? view->center : gi_normalize(gi_add(view->center, p));
}
