/* SPDX-License-Identifier: MIT
 * A rough boundary of microfacets over a diffuse base: kd/pi + mc F D G / (4 n.l n.v), after Walter
 * et al. 2007, "Microfacet Models for Refraction through Rough Surfaces". D is Beckmann's or GGX, G
 * the product of a G1 for l and one for v.
 *
 * G1 is computed divided by its cosine. Then nothing is divided by n.l or n.v, and a grazing
 * direction gives a number. */
#include "shade/microfacet.h"

#include "shade/dielectric.h"

double gi_microfacet_roughness(const GiShader *shader) {
    return fmin(fmax(shader->roughness, 1e-9), 1e9);
}

/* The sine is that of the cross product, since 1 - cosine^2 would lose the digits that a smooth
 * surface's narrow lobe consists of. */
GiFacet gi_microfacet_facet(GiVec n, GiVec m) {
    double cosine = gi_dot(n, m);
    GiVec across = gi_cross(n, m);
    return (GiFacet){cosine, cosine * cosine, gi_dot(across, across)};
}

/* ---------------------------------------------------------------- distributions */

/* exp(-t^2 / alpha^2) / (pi alpha^2 cm^4), t being the tangent. */
double gi_microfacet_beckmann(GiFacet m, double alpha) {
    if (m.cosine <= GI_LEAST_COSINE) return 0;
    double a = alpha * alpha;
    double tangent_square = m.sine_square / m.cosine_square;
    return gi_exp(-tangent_square / a) / (GI_PI * a * m.cosine_square * m.cosine_square);
}

/* alpha^2 / (pi cm^4 (alpha^2 + t^2)^2) */
static double ggx(GiFacet m, double alpha) {
    if (m.cosine <= 0) return 0;
    double a = alpha * alpha, sum = a * m.cosine_square + m.sine_square;
    return a / (GI_PI * sum * sum);
}

static double distribution(const GiShader *shader, GiFacet m) {
    double alpha = gi_microfacet_roughness(shader);
    return shader->type == GLINT_SHADER_GGX ? ggx(m, alpha) : gi_microfacet_beckmann(m, alpha);
}

/* ---------------------------------------------------------------- masking */

/* G1(c) / c for Beckmann: (3.535 a + 2.181 a^2) / (1 + 2.276 a + 2.577 a^2) if a < 1.6, else 1,
 * with a = 1 / (alpha tan) = c / (alpha sin). */
static double beckmann_masking(double c, double alpha) {
    double spread = alpha * sqrt(gi_shade_positive(1 - c * c));
    if (c >= 1.6 * spread) return 1 / c;
    double a = c / spread;
    return (3.535 + 2.181 * a) / (1 + 2.276 * a + 2.577 * a * a) / spread;
}

/* G1(c) / c for GGX: G1 = 2 / (1 + sqrt(1 + alpha^2 tan^2)). */
static double ggx_masking(double c, double alpha) {
    return 2 / (c + sqrt(c * c + alpha * alpha * gi_shade_positive(1 - c * c)));
}

static double masking_over_cosine(const GiShader *shader, double c) {
    double alpha = gi_microfacet_roughness(shader);
    return shader->type == GLINT_SHADER_GGX ? ggx_masking(c, alpha) : beckmann_masking(c, alpha);
}

/* ---------------------------------------------------------------- light */

/* The masking that is kept is over both cosines. */
static inline GiLobes lobes_of(const GiShading *at, GiVec l) {
    const GiShader *shader = at->shader;
    GiVec n = at->normal, v = at->toward_viewer;
    double nl = gi_dot(n, l), nv = gi_dot(n, v);
    if (nl <= GI_LEAST_COSINE || nv <= GI_LEAST_COSINE) {
        return (GiLobes){{0, 0, 0}, {0, 0, 0}, 0, 0, 0};
    }
    GiVec m = gi_normalize(gi_add(l, v));
    double f = gi_dielectric_fresnel(gi_dot(l, m), shader->index);
    double d = distribution(shader, gi_microfacet_facet(n, m));
    double g = masking_over_cosine(shader, nl) * masking_over_cosine(shader, nv);
    GiVec diffuse = gi_scale(at->diffuse, GI_INVERSE_PI * nl);
    GiVec specular = gi_scale(shader->specular, f * d * g / 4 * nl);
    return (GiLobes){diffuse, specular, f, d, g};
}

GiVec gi_microfacet_evaluate(const GiShading *at, GiVec l) {
    GiLobes lobes = lobes_of(at, l);
    return gi_add(lobes.diffuse, lobes.highlight);
}

GiLobes gi_microfacet_lobes(const GiShading *at, GiVec l) {
    GiLobes lobes = lobes_of(at, l);
    lobes.masking *= gi_dot(at->normal, l) * gi_dot(at->normal, at->toward_viewer);
    return lobes;
}

/* ---------------------------------------------------------------- directions */

GiVec gi_microfacet_beckmann_draw(GiVec n, double alpha, double u1, double u2) {
    double tangent_square = -alpha * alpha * gi_log(1 - u1);
    double cosine_square = 1 / (1 + tangent_square);
    return gi_lobe_around(n, sqrt(cosine_square), sqrt(tangent_square * cosine_square), u2);
}

/* Draws m as often as v sees it, with the density G1(v) v.m D / n.v. The surface is stretched until
 * its microfacets are those of a hemisphere; what of it a ray from v meets, mirrored, is a cap of
 * the sphere (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps"; the
 * density is Heitz's of 2018). */
static GiVec visible_ggx_draw(GiVec n, GiVec v, double alpha, double u1, double u2) {
    GiVec a, b;
    double s, c;
    gi_lobe_frame(n, &a, &b);
    GiVec stretched =
        gi_normalize(gi_vec(alpha * gi_dot(v, a), alpha * gi_dot(v, b), gi_dot(v, n)));
    double z = (1 - u1) * (1 + stretched.z) - stretched.z;
    double radius = sqrt(gi_shade_positive(1 - z * z));
    gi_sincos(2 * GI_PI * u2, &s, &c);
    GiVec h = gi_add(gi_vec(radius * c, radius * s, z), stretched);
    GiVec m = gi_add(gi_scale(a, alpha * h.x), gi_scale(b, alpha * h.y));
    return gi_normalize(gi_add(m, gi_scale(n, h.z)));
}

static double share_of_cosine(const GiShading *at, double nv) {
    double mirrored = gi_dielectric_fresnel(nv, at->shader->index);
    return gi_lobe_share(gi_largest(at->diffuse), gi_largest(at->shader->specular) * mirrored);
}

double gi_microfacet_density(const GiShading *at, GiVec l) {
    const GiShader *shader = at->shader;
    GiVec n = at->normal, v = at->toward_viewer;
    double nl = gi_dot(n, l), nv = gi_dot(n, v);
    if (nl <= GI_LEAST_COSINE || nv <= GI_LEAST_COSINE) return 0;
    GiVec m = gi_normalize(gi_add(l, v));
    GiFacet facet = gi_microfacet_facet(n, m);
    double d = distribution(shader, facet);
    double lobe = shader->type == GLINT_SHADER_GGX
                      ? d * masking_over_cosine(shader, nv) / 4
                      : gi_lobe_half_density(d * facet.cosine, gi_dot(v, m));
    double share = share_of_cosine(at, nv);
    return share * gi_lobe_cosine_density(nl) + (1 - share) * lobe;
}

bool gi_microfacet_draw(const GiShading *at, const double u[3], GiVec *l) {
    GiVec n = at->normal, v = at->toward_viewer;
    double nv = gi_dot(n, v);
    if (nv <= GI_LEAST_COSINE) return false;
    if (u[0] < share_of_cosine(at, nv)) {
        *l = gi_lobe_cosine_draw(n, u[1], u[2]);
        return true;
    }
    double alpha = gi_microfacet_roughness(at->shader);
    GiVec m = at->shader->type == GLINT_SHADER_GGX
                  ? visible_ggx_draw(n, v, alpha, u[1], u[2])
                  : gi_microfacet_beckmann_draw(n, alpha, u[1], u[2]);
    return gi_lobe_half_draw(v, m, l);
}
