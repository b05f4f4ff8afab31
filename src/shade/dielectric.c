/* SPDX-License-Identifier: MIT */
#include "shade/dielectric.h"

double gi_dielectric_reflectance(double c, double ct, double m) {
    double across = c + m * ct, along = m * c + ct;
    if (!(across > 0 && along > 0)) return 1; /* grazing on both sides: 0/0 */
    double s = (c - m * ct) / across, p = (m * c - ct) / along;
    return 0.5 * (s * s + p * p);
}

double gi_dielectric_fresnel(double c, double m) {
    double ct;
    return gi_dielectric_cosine_behind(c, 1 / m, &ct) ? gi_dielectric_reflectance(c, ct, m) : 1;
}

double gi_dielectric_schlick(double c, double m) {
    double root = (m - 1) / (m + 1), r0 = root * root;
    double x = 1 - c, square = x * x;
    return r0 + (1 - r0) * (square * square * x);
}

GiVec gi_dielectric_mirror(GiVec n, GiVec v, double c) { return gi_sub(gi_scale(n, 2 * c), v); }

bool gi_dielectric_cosine_behind(double c, double e, double *ct) {
    double square = 1 - e * e * gi_shade_positive(1 - c * c);
    if (!(square >= 0)) return false;
    *ct = sqrt(square);
    return true;
}

GiVec gi_dielectric_refract(GiVec n, GiVec v, double c, double ct, double e) {
    return gi_add(gi_scale(v, -e), gi_scale(n, e * c - ct));
}
