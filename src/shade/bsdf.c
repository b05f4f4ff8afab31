/* SPDX-License-Identifier: MIT
 * From the type of a shader to its family. Types without a local part reflect nothing. */
#include "shade/bsdf.h"

#include "shade/lobe.h"

/* Whether the year draws nothing because the surface is seen from behind. */
static bool turned_away(const GiShading *at) {
    return at->rules->black_from_behind && gi_dot(at->normal, at->toward_viewer) < 0;
}

GiVec gi_bsdf_evaluate(const GiShading *at, GiVec l) {
    if (turned_away(at)) return gi_vec(0, 0, 0);
    switch (at->shader->type) {
    case GLINT_SHADER_LAMBERTIAN: return gi_lambertian_evaluate(at, l);
    case GLINT_SHADER_PHONG: return gi_phong_evaluate(at, l);
    case GLINT_SHADER_BECKMANN:
    case GLINT_SHADER_GGX: return gi_microfacet_evaluate(at, l);
    case GLINT_SHADER_COOK_TORRANCE: return gi_cook_torrance_evaluate(at, l);
    case GLINT_SHADER_RGB_NORMALS:
    case GLINT_SHADER_GLAZED:
    case GLINT_SHADER_GLASS: break;
    }
    return gi_vec(0, 0, 0);
}

GiLobes gi_bsdf_lobes(const GiShading *at, GiVec l) {
    const GiLobes none = {{0, 0, 0}, {0, 0, 0}, 0, 0, 0};
    if (turned_away(at)) return none;
    switch (at->shader->type) {
    case GLINT_SHADER_LAMBERTIAN: return gi_lambertian_lobes(at, l);
    case GLINT_SHADER_PHONG: return gi_phong_lobes(at, l);
    case GLINT_SHADER_BECKMANN:
    case GLINT_SHADER_GGX: return gi_microfacet_lobes(at, l);
    case GLINT_SHADER_COOK_TORRANCE: return gi_cook_torrance_lobes(at, l);
    case GLINT_SHADER_RGB_NORMALS:
    case GLINT_SHADER_GLAZED:
    case GLINT_SHADER_GLASS: break;
    }
    return none;
}

double gi_bsdf_radiometric(const GiShading *at) {
    switch (at->shader->type) {
    case GLINT_SHADER_LAMBERTIAN:
    case GLINT_SHADER_PHONG: return at->rules->diffuse_over_pi ? 1 : GI_INVERSE_PI;
    case GLINT_SHADER_COOK_TORRANCE: return GI_INVERSE_PI;
    case GLINT_SHADER_BECKMANN:
    case GLINT_SHADER_GGX:
    case GLINT_SHADER_RGB_NORMALS:
    case GLINT_SHADER_GLAZED:
    case GLINT_SHADER_GLASS: break;
    }
    return 1;
}

double gi_bsdf_density(const GiShading *at, GiVec l) {
    if (turned_away(at)) return 0;
    switch (at->shader->type) {
    case GLINT_SHADER_LAMBERTIAN: return gi_lambertian_density(at, l);
    case GLINT_SHADER_PHONG: return gi_phong_density(at, l);
    case GLINT_SHADER_BECKMANN:
    case GLINT_SHADER_GGX: return gi_microfacet_density(at, l);
    case GLINT_SHADER_COOK_TORRANCE: return gi_cook_torrance_density(at, l);
    case GLINT_SHADER_RGB_NORMALS:
    case GLINT_SHADER_GLAZED:
    case GLINT_SHADER_GLASS: break;
    }
    return 0;
}

static bool draw(const GiShading *at, const double u[3], GiVec *l) {
    switch (at->shader->type) {
    case GLINT_SHADER_LAMBERTIAN: return gi_lambertian_draw(at, u, l);
    case GLINT_SHADER_PHONG: return gi_phong_draw(at, u, l);
    case GLINT_SHADER_BECKMANN:
    case GLINT_SHADER_GGX: return gi_microfacet_draw(at, u, l);
    case GLINT_SHADER_COOK_TORRANCE: return gi_cook_torrance_draw(at, u, l);
    case GLINT_SHADER_RGB_NORMALS:
    case GLINT_SHADER_GLAZED:
    case GLINT_SHADER_GLASS: break;
    }
    return false;
}

/* The density is asked of l as it was rounded, so that it is that of gi_bsdf_density to the bit. */
double gi_bsdf_sample(const GiShading *at, const double u[3], GiVec *l) {
    *l = at->normal;
    if (turned_away(at) || !draw(at, u, l)) return 0;
    return gi_bsdf_density(at, *l);
}
