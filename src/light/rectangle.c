/* SPDX-License-Identifier: MIT
 * The frame, points evenly by area, and points evenly by solid angle (Urena, Fajardo and King 2013,
 * An Area-Preserving Parametrization for Spherical Rectangles). */
#include "light/rectangle.h"

#include "math/angle.h"
#include "math/elementary.h"

bool gi_rectangle_init(GiLightRectangle *rectangle, GiVec center, GiVec normal, GiVec up,
    double width, double height) {
    GiVec front = gi_normalize(normal);
    GiVec across = gi_normalize(gi_cross(gi_normalize(up), front));
    if (gi_vec_is_zero(across)) return false;
    *rectangle = (GiLightRectangle){.center = center,
        .across = gi_scale(across, width),
        .upward = gi_scale(gi_cross(front, across), height),
        .front = front,
        .area = width * height};
    rectangle->width = gi_length(rectangle->across);
    rectangle->height = gi_length(rectangle->upward);
    rectangle->x = gi_scale(rectangle->across, 1 / rectangle->width);
    rectangle->y = gi_scale(rectangle->upward, 1 / rectangle->height);
    return true;
}

/* Area to solid angle: cosine over square of the distance. */
static double solid_angle(const GiLightRectangle *rectangle, GiVec offset) {
    double square = gi_dot(offset, offset), cosine = -gi_dot(offset, rectangle->front);
    return cosine > 0 ? rectangle->area * cosine / (square * sqrt(square)) : 0;
}

double gi_rectangle_sample(
    const GiLightRectangle *rectangle, GiVec from, const double u[2], GiVec *point) {
    GiVec line = gi_along(rectangle->center, rectangle->across, u[0] - 0.5);
    *point = gi_along(line, rectangle->upward, u[1] - 0.5);
    return solid_angle(rectangle, gi_sub(*point, from));
}

double gi_rectangle_density(const GiLightRectangle *rectangle, GiVec offset) {
    double angle = solid_angle(rectangle, offset);
    return angle > 0 ? 1 / angle : 0;
}

/* ---------------------------------------------------------------- by solid angle */

/* The rectangle x0 ... x1, y0 ... y1 at height z < 0 over the one who looks, and what its four
 * sides look like: great circles, each with the z of its normal. */
typedef struct View {
    double x0, x1, y0, y1, z;
    double below, right, above, left;
    double high_left, low_left; /* the inner angles there, less a right angle */
    double angle;               /* solid; 0: nothing is seen but the back */
} View;

/* The z of the normal of the circle through a side at distance `side`, not yet turned outward. */
static double slope(double side, double z) { return side / sqrt(side * side + z * z); }

static View view_from(const GiLightRectangle *rectangle, GiVec from) {
    GiVec middle = gi_sub(rectangle->center, from);
    View view = {.z = gi_dot(middle, rectangle->front)};
    if (!(view.z < 0)) return view;
    double x = gi_dot(middle, rectangle->x), y = gi_dot(middle, rectangle->y);
    view.x0 = x - rectangle->width / 2;
    view.x1 = x + rectangle->width / 2;
    view.y0 = y - rectangle->height / 2;
    view.y1 = y + rectangle->height / 2;
    view.below = -slope(view.y0, view.z);
    view.right = slope(view.x1, view.z);
    view.above = slope(view.y1, view.z);
    view.left = -slope(view.x0, view.z);
    view.high_left = gi_asin(view.above * view.left);
    view.low_left = gi_asin(view.left * view.below);
    /* The sum of the inner angles over that of a flat rectangle; acos(-a) = pi / 2 + asin(a). */
    view.angle = gi_asin(view.below * view.right) + gi_asin(view.right * view.above) +
                 view.high_left + view.low_left;
    return view;
}

/* NaN gives low. */
static double clamp(double value, double low, double high) {
    return value > low ? value < high ? value : high : low;
}

/* The x up to which the part of the rectangle has the share u of its solid angle. */
static double choose_x(const View *view, double u) {
    double sine, cosine;
    gi_sincos(u * view->angle + (GI_PI - view->high_left - view->low_left), &sine, &cosine);
    double f = (cosine * view->below - view->above) / sine;
    double c = 1 / sqrt(f * f + view->below * view->below);
    c = clamp(f > 0 ? c : -c, -1, 1);
    return clamp(-(c * view->z) / sqrt(1 - c * c), view->x0, view->x1);
}

/* Along the line at x, equal parts of the sine of the elevation have equal angles. */
static double choose_y(const View *view, double x, double u) {
    double square = x * x + view->z * view->z;
    double h0 = view->y0 / sqrt(square + view->y0 * view->y0);
    double h1 = view->y1 / sqrt(square + view->y1 * view->y1);
    double h = h0 + u * (h1 - h0);
    return clamp(h * sqrt(square) / sqrt(1 - h * h), view->y0, view->y1);
}

static bool is_near(const GiLightRectangle *rectangle, GiVec from) {
    GiVec offset = gi_sub(rectangle->center, from);
    return gi_dot(offset, offset) < GI_RECTANGLE_FAR * rectangle->area;
}

double gi_rectangle_sample_angle(
    const GiLightRectangle *rectangle, GiVec from, const double u[2], GiVec *point) {
    if (!is_near(rectangle, from)) return gi_rectangle_sample(rectangle, from, u, point);
    View view = view_from(rectangle, from);
    if (!(view.angle > GI_RECTANGLE_LEAST_ANGLE))
        return gi_rectangle_sample(rectangle, from, u, point);
    double x = choose_x(&view, u[0]), y = choose_y(&view, x, u[1]);
    GiVec foot = gi_along(from, rectangle->front, view.z);
    *point = gi_along(gi_along(foot, rectangle->x, x), rectangle->y, y);
    return view.angle;
}

double gi_rectangle_density_angle(const GiLightRectangle *rectangle, GiVec from, GiVec point) {
    if (is_near(rectangle, from)) {
        View view = view_from(rectangle, from);
        if (view.angle > GI_RECTANGLE_LEAST_ANGLE) return 1 / view.angle;
    }
    return gi_rectangle_density(rectangle, gi_sub(point, from));
}
