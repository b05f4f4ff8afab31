/* SPDX-License-Identifier: MIT
 * Cook and Torrance 1982, "A Reflectance Model for Computer Graphics", as 2017 had it: Beckmann's D
 * without its 1/pi, Fresnel's term at n.v, and grooves of the shape of a V for G. Its kd is that of
 * a light of strength E, without 1/pi. */
#include "shade/dielectric.h"
#include "shade/microfacet.h"

/* F; none where v is behind the surface, and at n.v = 0, where the formula is 0/0. */
static double mirrored(const GiShading *at, double nv) {
    return nv > GI_LEAST_COSINE ? gi_dielectric_fresnel(nv, at->shader->index) : 0;
}

/* F D G / (pi n.v n.l) times n.l. D is pi times the distribution of the microfacets. */
static inline double highlight(const GiShading *at, GiVec l, double nl, double nv, GiLobes *lobes) {
    double f = mirrored(at, nv);
    if (f == 0) return 0;
    GiVec v = at->toward_viewer, h = gi_normalize(gi_add(l, v));
    double nh = gi_dot(at->normal, h), vh = gi_dot(v, h);
    if (vh <= GI_LEAST_COSINE) return 0;
    double d = gi_microfacet_beckmann(
        gi_microfacet_facet(at->normal, h), gi_microfacet_roughness(at->shader));
    double g = fmin(1, fmin(2 * nh * nv / vh, 2 * nh * nl / vh));
    lobes->fresnel = f, lobes->distribution = GI_PI * d, lobes->masking = g;
    return f * d * g / nv;
}

static inline GiLobes lobes_of(const GiShading *at, GiVec l) {
    double nl = gi_dot(at->normal, l), nv = gi_dot(at->normal, at->toward_viewer);
    GiLobes lobes = {{0, 0, 0}, {0, 0, 0}, 0, 0, 0};
    if (nl <= 0) return lobes;
    lobes.diffuse = gi_scale(at->diffuse, nl);
    lobes.highlight = gi_scale(at->shader->specular, highlight(at, l, nl, nv, &lobes));
    return lobes;
}

GiLobes gi_cook_torrance_lobes(const GiShading *at, GiVec l) { return lobes_of(at, l); }

GiVec gi_cook_torrance_evaluate(const GiShading *at, GiVec l) {
    GiLobes lobes = lobes_of(at, l);
    return gi_add(lobes.diffuse, lobes.highlight);
}

/* A sharp highlight sends back 4 ks F, the base pi kd. */
static double share_of_cosine(const GiShading *at, double nv) {
    double specular = 4 * gi_largest(at->shader->specular) * mirrored(at, nv);
    return gi_lobe_share(GI_PI * gi_largest(at->diffuse), specular);
}

double gi_cook_torrance_density(const GiShading *at, GiVec l) {
    GiVec n = at->normal, v = at->toward_viewer, h = gi_normalize(gi_add(l, v));
    double nl = gi_dot(n, l), share = share_of_cosine(at, gi_dot(n, v));
    if (nl <= 0) return 0;
    double d = 0;
    if (share < 1) {
        GiFacet facet = gi_microfacet_facet(n, h);
        d = gi_microfacet_beckmann(facet, gi_microfacet_roughness(at->shader)) * facet.cosine;
    }
    double lobe = gi_lobe_half_density(d, gi_dot(v, h));
    return share * gi_lobe_cosine_density(nl) + (1 - share) * lobe;
}

bool gi_cook_torrance_draw(const GiShading *at, const double u[3], GiVec *l) {
    GiVec n = at->normal, v = at->toward_viewer;
    if (u[0] < share_of_cosine(at, gi_dot(n, v))) {
        *l = gi_lobe_cosine_draw(n, u[1], u[2]);
        return true;
    }
    double alpha = gi_microfacet_roughness(at->shader);
    return gi_lobe_half_draw(v, gi_microfacet_beckmann_draw(n, alpha, u[1], u[2]), l);
}
