/* SPDX-License-Identifier: MIT */
#include "shade/shade.h"

#include "math/elementary.h"

static inline double positive(double x) { return x > 0 ? x : 0; }

static const GiVec black = {0, 0, 0};

GiVec gi_shade_normal_color(GiVec normal) {
    return gi_scale(gi_add(normal, gi_vec(1, 1, 1)), 0.5);
}

static double diffuse_factor(const GiRules *rules) {
    return rules->diffuse_over_pi ? 0.31830988618379067 : 1;
}

static GiVec lambertian(const GiShader *shader, const GiRules *rules, double nl) {
    return gi_scale(shader->diffuse, diffuse_factor(rules) * positive(nl));
}

/* Blinn (1977). */
static GiVec phong(const GiShader *shader, const GiRules *rules, GiVec n, GiVec v, GiVec l) {
    double nl = gi_dot(n, l);
    if (rules->highlight_needs_light && nl <= 0) return black;
    GiVec h = gi_normalize(gi_add(l, v));
    double highlight = gi_pow(positive(gi_dot(n, h)), shader->exponent);
    double cosine = positive(nl);
    GiVec diffuse = gi_scale(shader->diffuse, diffuse_factor(rules) * cosine);
    GiVec specular = gi_scale(shader->specular, rules->phong_cosine ? highlight * cosine : highlight);
    return gi_add(diffuse, specular);
}

GiVec gi_shade_reflect(
    const GiShader *shader, const GiRules *rules, GiVec normal, GiVec toward_viewer, GiVec l) {
    if (rules->black_from_behind && gi_dot(normal, toward_viewer) < 0) return black;
    switch (shader->type) {
    case GLINT_SHADER_LAMBERTIAN: return lambertian(shader, rules, gi_dot(normal, l));
    case GLINT_SHADER_PHONG: return phong(shader, rules, normal, toward_viewer, l);
    case GLINT_SHADER_RGB_NORMALS: break;
    }
    return black;
}

GiVec gi_shade_emit(const GiShader *shader, GiVec normal) {
    return shader->type == GLINT_SHADER_RGB_NORMALS ? gi_shade_normal_color(normal) : black;
}

GiVec gi_shade_ambient(const GiShader *shader, const GiLight *light, GiVec normal) {
    if (shader->type == GLINT_SHADER_RGB_NORMALS) return black;
    switch (light->type) {
    case GLINT_LIGHT_AMBIENT: return gi_multiply(light->intensity, shader->diffuse);
    case GLINT_LIGHT_CONSTANT: return shader->diffuse;
    case GLINT_LIGHT_NORMAL: return gi_shade_normal_color(normal);
    case GLINT_LIGHT_POINT: break;
    }
    return black;
}

GiVec gi_light_strength(const GiLight *light, const GiRules *rules, double distance_square) {
    bool falls = light->falloff == GLINT_FALLOFF_INVERSE_SQUARE ||
                 (light->falloff == GLINT_FALLOFF_DIALECT && rules->falloff);
    return falls ? gi_scale(light->intensity, 1 / distance_square) : light->intensity;
}
