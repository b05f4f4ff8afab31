/* SPDX-License-Identifier: MIT
 * A rectangle that shines from its front. */
#pragma once

#include "math/vec.h"

typedef struct GiLightRectangle {
    GiVec center;
    GiVec across, upward; /* its two sides, with their lengths */
    GiVec front;          /* unit */
    GiVec x, y;           /* the sides' directions, unit */
    double width, height; /* their lengths */
    double area;
} GiLightRectangle;

/* up need only point upward somehow; the rectangle stands across normal. False when the two are
 * parallel, or one is zero. */
bool gi_rectangle_init(
    GiLightRectangle *rectangle, GiVec center, GiVec normal, GiVec up, double width, double height);

/* A point of the rectangle, evenly by area, and the factor that makes of its radiance the light
 * that it sends to `from`: the area times the cosine at the light over the square of the distance.
 * 0 when only the back is seen. */
double gi_rectangle_sample(
    const GiLightRectangle *rectangle, GiVec from, const double u[2], GiVec *point);

/* The density per solid angle of the above, for a point at `offset` from where it is seen from. 0
 * at the back. */
double gi_rectangle_density(const GiLightRectangle *rectangle, GiVec offset);

/* Only from nearer than this, the square of the distance over the area, the rectangle looks so
 * large that points by area make noise. And a smaller angle is the difference of numbers too close
 * to each other. Else points by area are as good, and cheaper to find. */
enum { GI_RECTANGLE_FAR = 4 };
#define GI_RECTANGLE_LEAST_ANGLE 1e-5

/* The same, evenly by solid angle: the factor is that angle, whatever point is drawn, so a light
 * that is near makes less noise (Urena, Fajardo and King 2013); from farther away evenly by area.
 * The density is for a point of the rectangle. */
double gi_rectangle_sample_angle(
    const GiLightRectangle *rectangle, GiVec from, const double u[2], GiVec *point);
double gi_rectangle_density_angle(const GiLightRectangle *rectangle, GiVec from, GiVec point);
