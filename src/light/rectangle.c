/* SPDX-License-Identifier: MIT
 * The frame, and points evenly by area. */
#include "light/rectangle.h"

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
