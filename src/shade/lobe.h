/* SPDX-License-Identifier: MIT
 * What the families of shaders have in common: directions about a normal and reflection about a
 * half vector, with their densities; and what each family gives to bsdf.c. A density is per solid
 * angle. */
#pragma once

#include "math/elementary.h"
#include "shade/bsdf.h"
#include "shade/shade.h"

#define GI_PI         3.1415926535897931
#define GI_INVERSE_PI 0.31830988618379067

/* Cosines up to this are taken for zero where a formula divides by them. It is far below their
 * rounding, and powers of its inverse stay in the range of double. */
#define GI_LEAST_COSINE 1e-30

/* ---- each family: f n.l and what it consists of, the density with which it draws l, and the
 * drawing. A draw is false when it leads nowhere; the density of what it gives is what the density
 * function says. */

GiVec gi_lambertian_evaluate(const GiShading *at, GiVec l);
GiLobes gi_lambertian_lobes(const GiShading *at, GiVec l);
double gi_lambertian_density(const GiShading *at, GiVec l);
bool gi_lambertian_draw(const GiShading *at, const double u[3], GiVec *l);

GiVec gi_phong_evaluate(const GiShading *at, GiVec l);
GiLobes gi_phong_lobes(const GiShading *at, GiVec l);
double gi_phong_density(const GiShading *at, GiVec l);
bool gi_phong_draw(const GiShading *at, const double u[3], GiVec *l);

GiVec gi_microfacet_evaluate(const GiShading *at, GiVec l);
GiLobes gi_microfacet_lobes(const GiShading *at, GiVec l);
double gi_microfacet_density(const GiShading *at, GiVec l);
bool gi_microfacet_draw(const GiShading *at, const double u[3], GiVec *l);

GiVec gi_cook_torrance_evaluate(const GiShading *at, GiVec l);
GiLobes gi_cook_torrance_lobes(const GiShading *at, GiVec l);
double gi_cook_torrance_density(const GiShading *at, GiVec l);
bool gi_cook_torrance_draw(const GiShading *at, const double u[3], GiVec *l);

/* ---- geometry */

/* Two unit vectors at right angles to the unit vector n and to each other (Duff et al. 2017,
 * "Building an Orthonormal Basis, Revisited"). */
static inline void gi_lobe_frame(GiVec n, GiVec *a, GiVec *b) {
    double sign = copysign(1, n.z);
    double p = -1 / (sign + n.z), q = n.x * n.y * p;
    *a = gi_vec(1 + sign * n.x * n.x * p, sign * q, -sign * n.x);
    *b = gi_vec(q, sign + n.y * n.y * p, -n.y);
}

/* The unit vector with the given cosine and sine to n, turned about it by u of a full turn. */
static inline GiVec gi_lobe_around(GiVec n, double cosine, double sine, double u) {
    GiVec a, b;
    double s, c;
    gi_lobe_frame(n, &a, &b);
    gi_sincos(2 * GI_PI * u, &s, &c);
    GiVec across = gi_add(gi_scale(a, sine * c), gi_scale(b, sine * s));
    return gi_normalize(gi_add(across, gi_scale(n, cosine)));
}

/* v mirrored about h. */
static inline GiVec gi_lobe_mirror(GiVec v, GiVec h) {
    return gi_sub(gi_scale(h, 2 * gi_dot(v, h)), v);
}

/* ---- the lobe of the cosine: density n.l / pi */

static inline GiVec gi_lobe_cosine_draw(GiVec n, double u1, double u2) {
    return gi_lobe_around(n, sqrt(1 - u1), sqrt(u1), u2);
}

static inline double gi_lobe_cosine_density(double nl) {
    return gi_shade_positive(nl) * GI_INVERSE_PI;
}

/* ---- lobes of half vectors: h is drawn, and l is v mirrored about it. Of the solid angle of l
 * that of h is the 4 v.h-th part (Torrance and Sparrow 1967). */

static inline bool gi_lobe_half_draw(GiVec v, GiVec h, GiVec *l) {
    *l = gi_normalize(gi_lobe_mirror(v, h));
    return gi_dot(v, h) > GI_LEAST_COSINE;
}

static inline double gi_lobe_half_density(double density_of_h, double vh) {
    return vh > GI_LEAST_COSINE ? density_of_h / (4 * vh) : 0;
}

/* ---- mixtures: the share of the first of two lobes, by how much light they reflect at most */

static inline double gi_lobe_share(double first, double second) {
    double sum = first + second;
    return sum > 0 && sum <= 1e300 ? first / sum : 1;
}
