/* SPDX-License-Identifier: MIT */
#include "shade/shade.h"

static GiVec normal_color(GiVec normal) { return gi_scale(gi_add(normal, gi_vec(1, 1, 1)), 0.5); }

GiVec gi_shade_emit(const GiShader *shader, GiVec normal) {
    return shader->type == GLINT_SHADER_RGB_NORMALS ? normal_color(normal) : gi_vec(0, 0, 0);
}

GiVec gi_shade_ambient(const GiShading *at, const GiLight *light) {
    if (at->shader->type == GLINT_SHADER_RGB_NORMALS) return gi_vec(0, 0, 0);
    switch (light->type) {
    case GLINT_LIGHT_AMBIENT: return gi_multiply(light->intensity, at->diffuse);
    case GLINT_LIGHT_CONSTANT: return at->diffuse;
    case GLINT_LIGHT_NORMAL: return normal_color(at->normal);
    default: break;
    }
    return gi_vec(0, 0, 0);
}
