/* SPDX-License-Identifier: MIT
 * Vectors of three doubles. Everything that decides what a pixel shows is computed in double. */
#pragma once

#include <math.h>
#include <stdbool.h>

typedef struct GiVec {
    double x, y, z;
} GiVec;

static inline GiVec gi_vec(double x, double y, double z) { return (GiVec){x, y, z}; }
static inline GiVec gi_vec_from(const double v[3]) { return (GiVec){v[0], v[1], v[2]}; }
static inline GiVec gi_add(GiVec a, GiVec b) { return gi_vec(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline GiVec gi_sub(GiVec a, GiVec b) { return gi_vec(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline GiVec gi_scale(GiVec a, double s) { return gi_vec(a.x * s, a.y * s, a.z * s); }
static inline GiVec gi_negate(GiVec a) { return gi_vec(-a.x, -a.y, -a.z); }
/* Componentwise, for colours. */
static inline GiVec gi_multiply(GiVec a, GiVec b) {
    return gi_vec(a.x * b.x, a.y * b.y, a.z * b.z);
}
static inline double gi_dot(GiVec a, GiVec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline GiVec gi_cross(GiVec a, GiVec b) {
    return gi_vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double gi_length(GiVec a) { return sqrt(gi_dot(a, a)); }

/* a / |a|. A vector so long or so short that its square leaves the range of double is scaled
 * first; the zero vector stays zero. */
static inline GiVec gi_normalize(GiVec a) {
    double square = gi_dot(a, a);
    if (!(square > 1e-280 && square < 1e280)) {
        double largest = fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z)));
        if (largest == 0) return a;
        a = gi_vec(a.x / largest, a.y / largest, a.z / largest);
        square = gi_dot(a, a);
    }
    return gi_scale(a, 1 / sqrt(square));
}

/* The point at parameter t of the line o + t d. */
static inline GiVec gi_along(GiVec o, GiVec d, double t) {
    return gi_vec(o.x + d.x * t, o.y + d.y * t, o.z + d.z * t);
}

static inline bool gi_vec_is_zero(GiVec a) { return a.x == 0 && a.y == 0 && a.z == 0; }

/* The largest component, without its sign. */
static inline double gi_largest(GiVec v) {
    double x = fabs(v.x), y = fabs(v.y), z = fabs(v.z);
    double most = x > y ? x : y;
    return most > z ? most : z;
}
