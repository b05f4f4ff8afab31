/* SPDX-License-Identifier: MIT */
#include "shade/shade.h"

GiVec gi_shade_ambient(const GiShading *at, const GiLight *light) {
    if (at->shader->type == GLINT_SHADER_RGB_NORMALS) return gi_vec(0, 0, 0);
    switch (light->type) {
    case GLINT_LIGHT_AMBIENT: return gi_multiply(light->intensity, at->diffuse);
    case GLINT_LIGHT_CONSTANT: return at->diffuse;
    case GLINT_LIGHT_NORMAL: return gi_shade_normal_color(at->normal);
    default: break;
    }
    return gi_vec(0, 0, 0);
}
