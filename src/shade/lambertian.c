/* SPDX-License-Identifier: MIT
 * Reflects alike in all directions (Lambert 1760): f n.l = kd n.l. */
#include "shade/lobe.h"

GiVec gi_lambertian_evaluate(const GiShading *at, GiVec l) {
    GiShader shader = *at->shader;
    shader.diffuse = at->diffuse;
    return gi_shade_lambertian(&shader, at->rules, gi_dot(at->normal, l));
}

GiLobes gi_lambertian_lobes(const GiShading *at, GiVec l) {
    return (GiLobes){.diffuse = gi_lambertian_evaluate(at, l)};
}

double gi_lambertian_density(const GiShading *at, GiVec l) {
    return gi_lobe_cosine_density(gi_dot(at->normal, l));
}

bool gi_lambertian_draw(const GiShading *at, const double u[3], GiVec *l) {
    *l = gi_lobe_cosine_draw(at->normal, u[1], u[2]);
    return true;
}
