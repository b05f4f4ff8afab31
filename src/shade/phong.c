/* SPDX-License-Identifier: MIT
 * Blinn's form of Phong's highlight (Blinn 1977), which is not normalised: ks (n.h)^e over kd. It
 * is drawn as a mixture of the cosine and of half vectors with a density in proportion to (n.h)^e.
 */
#include "shade/lobe.h"

GiLobes gi_phong_lobes(const GiShading *at, GiVec l) {
    GiShader shader = *at->shader;
    shader.diffuse = at->diffuse;
    return gi_shade_phong(&shader, at->rules, at->normal, at->toward_viewer, l);
}

GiVec gi_phong_evaluate(const GiShading *at, GiVec l) {
    GiLobes lobes = gi_phong_lobes(at, l);
    return gi_add(lobes.diffuse, lobes.highlight);
}

/* That of the lobe: a negative exponent has no density and is drawn as 0 is; a huge one, whose
 * highlight is a point, as one whose density is a number. */
static double exponent_of(const GiShading *at) {
    return fmin(gi_shade_positive(at->shader->exponent), 1e18);
}

/* Seen from above, the highlight sends back 8 pi ks / (e + 2), the cosine pi kd. */
static double share_of_cosine(const GiShading *at) {
    double diffuse = gi_largest(at->diffuse) * gi_shade_diffuse_factor(at->rules);
    double specular = gi_largest(at->shader->specular) * 8 / (exponent_of(at) + 2);
    return gi_lobe_share(diffuse, specular);
}

double gi_phong_density(const GiShading *at, GiVec l) {
    double nl = gi_dot(at->normal, l);
    /* Where the highlight goes on below the horizon, so does the lobe. */
    if (at->rules->highlight_needs_light && nl <= 0) return 0;
    GiVec h = gi_normalize(gi_add(l, at->toward_viewer));
    double e = exponent_of(at), nh = gi_dot(at->normal, h);
    double density_of_h = nh > 0 ? (e + 1) / (2 * GI_PI) * gi_pow(nh, e) : 0;
    double lobe = gi_lobe_half_density(density_of_h, gi_dot(at->toward_viewer, h));
    double share = share_of_cosine(at);
    return share * gi_lobe_cosine_density(nl) + (1 - share) * lobe;
}

bool gi_phong_draw(const GiShading *at, const double u[3], GiVec *l) {
    if (u[0] < share_of_cosine(at)) {
        *l = gi_lobe_cosine_draw(at->normal, u[1], u[2]);
        return true;
    }
    double cosine = gi_pow(1 - u[1], 1 / (exponent_of(at) + 1));
    GiVec h = gi_lobe_around(at->normal, cosine, sqrt(1 - cosine * cosine), u[2]);
    return gi_lobe_half_draw(at->toward_viewer, h, l);
}
