/* SPDX-License-Identifier: MIT
 * Points of a rectangle of light for many points of surfaces: light/rectangle.c and the functions
 * of math/elementary.c that it takes, operation by operation in the same order, so that the bits
 * are the same. Part of kernel.c. */
#pragma once

/* For |x| < 2^51. */
static inline R wide_floor(R x) {
    const R large = R_OF(0x1.8p52);
    R nearest = (x + large) - large;
    return R_SELECT(R_LESS(x, nearest), nearest - R_OF(1), nearest);
}

/* The sum of coefficient[i] x^i. */
static inline R wide_polynomial(const double *coefficient, int count, R x) {
    R sum = R_OF(coefficient[count - 1]);
    for (int i = count - 2; i >= 0; i--) sum = sum * x + R_OF(coefficient[i]);
    return sum;
}

/* As atan_of_octant. */
static inline R wide_atan_of_octant(R y, R x) {
    R eighth = wide_floor(y / x * R_OF(8) + R_OF(0.5)), c = eighth * R_OF(0.125);
    R z = (y - c * x) / (x + c * y), q = z * z;
    R whole = R_OF(gi_atan_of_eighths[0]);
    for (int i = 1; i < GI_ATAN_EIGHTHS; i++) {
        whole = R_SELECT(R_LESS(R_OF(i - 0.5), eighth), R_OF(gi_atan_of_eighths[i]), whole);
    }
    return whole + (z + z * (q * wide_polynomial(gi_atan_series, GI_ATAN_TERMS, q)));
}

/* As gi_asin, from -1 to 1. */
static inline R wide_asin(R sine) {
    R y = R_ABS(sine), x = R_SQRT((R_OF(1) - sine) * (R_OF(1) + sine));
    M low = R_LESS_EQUAL(y, x);
    R angle = wide_atan_of_octant(R_SELECT(low, y, x), R_SELECT(low, x, y));
    angle = R_SELECT(low, angle, R_OF(GI_HALF_PI) - (angle - R_OF(GI_HALF_PI_REST)));
    return R_SELECT(R_LESS(sine, R_OF(0)), -angle, angle);
}

/* As gi_sincos, from -1e6 to 1e6. */
static inline void wide_sincos(R x, R *sine, R *cosine) {
    R quarter = wide_floor(x * R_OF(GI_QUARTERS) + R_OF(0.5)), r = x;
    for (int i = 0; i < 3; i++) r = r - quarter * R_OF(gi_quarter_parts[i]);
    R q = r * r, half = R_OF(0.5) * q, high = R_OF(1) - half;
    R s = r + r * (q * wide_polynomial(gi_sine_series, GI_SINE_TERMS, q));
    R rest = q * q * wide_polynomial(gi_cosine_series, GI_SINE_TERMS, q);
    R c = high + (((R_OF(1) - high) - half) + rest);
    R turn = quarter - R_OF(4) * wide_floor(quarter * R_OF(0.25)); /* 0 to 3 */
    M odd = R_EQUAL(turn, R_OF(1)) | R_EQUAL(turn, R_OF(3));
    M left = R_EQUAL(turn, R_OF(1)) | R_EQUAL(turn, R_OF(2)), low = R_LESS(R_OF(1.5), turn);
    R rising = R_SELECT(odd, c, s), across = R_SELECT(odd, s, c);
    *sine = R_SELECT(low, -rising, rising);
    *cosine = R_SELECT(left, -across, across);
}

/* NaN gives low. */
static inline R wide_clamp(R value, R low, R high) {
    return R_SELECT(R_LESS(low, value), R_SELECT(R_LESS(value, high), value, high), low);
}

static inline R area_slope(R side, R z) { return side / R_SQRT(side * side + z * z); }

/* By solid angle; `angle` is no number or nothing where that is not to be had. */
static inline Wide area_by_angle(
    const GiLightRectangle *rectangle, Wide from, Wide middle, R u, R v, R *angle) {
    const GiVec *front = &rectangle->front, *across = &rectangle->x, *upward = &rectangle->y;
    const Wide normal = {R_OF(front->x), R_OF(front->y), R_OF(front->z)};
    const Wide x_axis = {R_OF(across->x), R_OF(across->y), R_OF(across->z)};
    const Wide y_axis = {R_OF(upward->x), R_OF(upward->y), R_OF(upward->z)};
    const R half_width = R_OF(rectangle->width / 2), half_height = R_OF(rectangle->height / 2);
    R z = wide_dot(middle, normal), x = wide_dot(middle, x_axis), y = wide_dot(middle, y_axis);
    R x0 = x - half_width, x1 = x + half_width, y0 = y - half_height, y1 = y + half_height;
    R below = -area_slope(y0, z), right = area_slope(x1, z);
    R above = area_slope(y1, z), left = -area_slope(x0, z);
    R high_left = wide_asin(above * left), low_left = wide_asin(left * below);
    R sum = wide_asin(below * right) + wide_asin(right * above) + high_left + low_left;
    *angle = R_SELECT(R_LESS(z, R_OF(0)), sum, R_OF(0));
    R sine, cosine;
    wide_sincos(u * sum + (R_OF(GI_PI) - high_left - low_left), &sine, &cosine);
    R f = (cosine * below - above) / sine, c = R_OF(1) / R_SQRT(f * f + below * below);
    c = wide_clamp(R_SELECT(R_LESS(R_OF(0), f), c, -c), R_OF(-1), R_OF(1));
    x = wide_clamp(-(c * z) / R_SQRT(R_OF(1) - c * c), x0, x1);
    R square = x * x + z * z;
    R h0 = y0 / R_SQRT(square + y0 * y0), h1 = y1 / R_SQRT(square + y1 * y1);
    R h = h0 + v * (h1 - h0);
    y = wide_clamp(h * R_SQRT(square) / R_SQRT(R_OF(1) - h * h), y0, y1);
    return wide_along(wide_along(wide_along(from, normal, z), x_axis, x), y_axis, y);
}

/* By area. */
static inline Wide area_evenly(const GiLightRectangle *rectangle, Wide from, R u, R v, R *factor) {
    const GiVec *center = &rectangle->center, *front = &rectangle->front;
    const GiVec *across = &rectangle->across, *upward = &rectangle->upward;
    Wide point = {R_OF(center->x), R_OF(center->y), R_OF(center->z)};
    point =
        wide_along(point, (Wide){R_OF(across->x), R_OF(across->y), R_OF(across->z)}, u - R_OF(0.5));
    point =
        wide_along(point, (Wide){R_OF(upward->x), R_OF(upward->y), R_OF(upward->z)}, v - R_OF(0.5));
    Wide offset = {point.x - from.x, point.y - from.y, point.z - from.z};
    R square = wide_dot(offset, offset);
    R cosine = -wide_dot(offset, (Wide){R_OF(front->x), R_OF(front->y), R_OF(front->z)});
    R part = R_OF(rectangle->area) * cosine / (square * R_SQRT(square));
    *factor = R_SELECT(R_LESS(R_OF(0), cosine), part, R_OF(0));
    return point;
}

static void GI_KERNEL(area)(const GiLightRectangle *rectangle, const GiPoints *points, int begin,
    int count, const GiPairs *pairs, GiAreaBeams *beams) {
    const GiVec *center = &rectangle->center;
    const R near = R_OF(GI_RECTANGLE_FAR * rectangle->area), one = R_OF(1);
    for (int i = 0; i < count; i += GI_DOUBLES) {
        Wide from = {r_load(points->px + begin + i), r_load(points->py + begin + i),
            r_load(points->pz + begin + i)};
        R u = r_load(pairs->u + i), v = r_load(pairs->v + i), factor, angle;
        Wide middle = {
            R_OF(center->x) - from.x, R_OF(center->y) - from.y, R_OF(center->z) - from.z};
        Wide point = area_evenly(rectangle, from, u, v, &factor);
        M close = R_LESS(wide_dot(middle, middle), near);
        if (m_bits(close) != 0) {
            Wide better = area_by_angle(rectangle, from, middle, u, v, &angle);
            close = close & R_LESS(R_OF(GI_RECTANGLE_LEAST_ANGLE), angle);
            point = (Wide){R_SELECT(close, better.x, point.x), R_SELECT(close, better.y, point.y),
                R_SELECT(close, better.z, point.z)};
            factor = R_SELECT(close, angle, factor);
        }
        Wide offset = {point.x - from.x, point.y - from.y, point.z - from.z};
        R distance = R_SQRT(wide_dot(offset, offset));
        Wide direction = wide_scale(offset, one / distance);
        r_store(beams->dx + i, direction.x);
        r_store(beams->dy + i, direction.y);
        r_store(beams->dz + i, direction.z);
        r_store(beams->factor + i, factor);
        r_store(beams->distance + i, distance);
        r_store(
            beams->t_max + i, distance - (wide_largest(point) + distance) * R_OF(GI_SURFACE_ERROR));
    }
}
