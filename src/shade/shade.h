/* SPDX-License-Identifier: MIT
 * What a surface sends toward the viewer. The code reads as docs/scene-format.md does; what differs
 * between years is asked of GiRules. What is done for every hit and light is inline. */
#pragma once

#include "math/elementary.h"
#include "shade/bsdf.h"

static inline GiVec gi_shade_normal_color(GiVec normal) {
    return gi_scale(gi_add(normal, gi_vec(1, 1, 1)), 0.5);
}

/* What is there without any light. */
static inline GiVec gi_shade_emit(const GiShader *shader, GiVec normal) {
    if (shader->type != GLINT_SHADER_RGB_NORMALS) return gi_vec(0, 0, 0);
    return gi_shade_normal_color(normal);
}

/* What lights without a place add: ambient, constant and normal lights. */
GiVec gi_shade_ambient(const GiShading *at, const GiLight *light);

static inline double gi_shade_positive(double x) { return x > 0 ? x : 0; }

static inline double gi_shade_diffuse_factor(const GiRules *rules) {
    return rules->diffuse_over_pi ? 0.31830988618379067 : 1;
}

/* What of n.l counts for the diffuse term. */
static inline double gi_shade_cosine(const GiRules *rules, double nl) {
    return rules->diffuse_behind ? fabs(nl) : gi_shade_positive(nl);
}

static inline GiVec gi_shade_lambertian(const GiShader *shader, const GiRules *rules, double nl) {
    return gi_scale(shader->diffuse, gi_shade_diffuse_factor(rules) * gi_shade_cosine(rules, nl));
}

/* The cosine whose power is the highlight. */
static inline double gi_shade_highlight_cosine(const GiRules *rules, GiVec n, GiVec v, GiVec l) {
    GiVec h = gi_normalize(gi_add(l, v));
    if (!rules->odd_shading) return gi_shade_positive(gi_dot(n, h));
    GiVec r = gi_sub(gi_scale(n, 2 * gi_dot(n, l)), l);
    double cosine = rules->reflected_highlight ? gi_dot(r, v) : gi_dot(n, h);
    return rules->specular_behind ? fabs(cosine) : gi_shade_positive(cosine);
}

/* Blinn (1977). */
static inline GiLobes gi_shade_phong(
    const GiShader *shader, const GiRules *rules, GiVec n, GiVec v, GiVec l) {
    double nl = gi_dot(n, l);
    GiLobes lobes = {{0, 0, 0}, {0, 0, 0}, 0, 0, 0};
    lobes.diffuse = gi_shade_lambertian(shader, rules, nl);
    if (rules->highlight_needs_light && nl <= 0) return lobes;
    double highlight = gi_pow(gi_shade_highlight_cosine(rules, n, v, l), shader->exponent);
    double cosine = gi_shade_positive(nl);
    lobes.highlight =
        gi_scale(shader->specular, rules->phong_cosine ? highlight * cosine : highlight);
    return lobes;
}

/* Whether a light falls off with the square of the distance. */
static inline bool gi_shade_light_falls(const GiLight *light, const GiRules *rules) {
    return light->falloff == GLINT_FALLOFF_INVERSE_SQUARE ||
           (light->falloff == GLINT_FALLOFF_DIALECT && rules->falloff);
}

/* E of a point light at the given squared distance. */
static inline GiVec gi_shade_light(
    const GiLight *light, const GiRules *rules, double distance_square) {
    if (!gi_shade_light_falls(light, rules)) return light->intensity;
    double fall = rules->falloff_linear ? sqrt(distance_square) : distance_square;
    return gi_scale(light->intensity, 1 / fall);
}
