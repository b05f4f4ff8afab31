/* SPDX-License-Identifier: MIT */
#include "scene/dialect.h"

#include <string.h>

/* A row a year, in the order of GlintDialect. The shadow distance is given where it shows in the
 * course's pictures; elsewhere rays begin at the error bound of the hit point. */
static const GiRules rules[GLINT_DIALECT_COUNT] = {
    [GLINT_DIALECT_AUTO] = {.name = "auto"},
    [GLINT_DIALECT_2011] =
        {
            .name = "2011",
            .schlick = true,
            .glass_by_flag = true,
            .glass_ends = true,
            .least_weight = 0.01,
            .last_level = 12,
            .entering_only = true,
            .default_diffuse = 1,
        },
    [GLINT_DIALECT_2012] =
        {
            .name = "2012",
            .schlick = true,
            .glass_by_flag = true,
            .glass_ends = true,
            .least_weight = 0.01,
            .last_level = 12,
            .entering_only = true,
            .default_diffuse = 1,
        },
    [GLINT_DIALECT_MATERIAL] =
        {
            .name = "material",
            .glazed_behind = true,
            .last_level = 12,
            .falloff = true,
            .phong_cosine = true,
            .sphere_shadows_itself = true,
            .default_diffuse = 1,
        },
    [GLINT_DIALECT_2013] =
        {
            .name = "2013",
            .glazed_behind = true,
            .last_level = 12,
            .default_diffuse = 1,
        },
    [GLINT_DIALECT_2017] =
        {
            .name = "2017",
            .glazed_behind = true,
            .last_level = 12,
            .falloff = true,
            .highlight_needs_light = true,
            .sphere_shadows_itself = true,
            .shadow_distance = 1e-3,
            .default_diffuse = 1,
        },
    [GLINT_DIALECT_2017B] =
        {
            .name = "2017b",
            .glazed_behind = true,
            .last_level = 12,
            .falloff = true,
            .highlight_needs_light = true,
            .sphere_shadows_itself = true,
            .first_listed_first = true,
            .shadow_distance = 1e-6,
            .default_diffuse = 1,
        },
    [GLINT_DIALECT_2018] =
        {
            .name = "2018",
            .glazed_behind = true,
            .last_level = 12,
            .falloff = true,
            .diffuse_over_pi = true,
            .highlight_needs_light = true,
            .black_from_behind = true,
            .sphere_shadows_itself = true,
            .shadow_distance = 1e-3,
            .default_diffuse = 1,
        },
    [GLINT_DIALECT_2018B] =
        {
            .name = "2018b",
            .glazed_behind = true,
            .last_level = 12,
            .glazed_adds = true,
            .area_light_visible = true,
            .environment_lights = true,
            .falloff = true,
            .diffuse_over_pi = true,
            .highlight_needs_light = true,
            .black_from_behind = true,
            .sphere_shadows_itself = true,
            .first_listed_first = true,
            .shadow_distance = 1e-6,
            .default_diffuse = 1,
        },
    [GLINT_DIALECT_2019] =
        {
            .name = "2019",
            .glazed_behind = true,
            .last_level = 12,
            .falloff = true,
            .diffuse_over_pi = true,
            .phong_cosine = true,
            .highlight_needs_light = true,
            .black_from_behind = true,
            .sphere_shadows_itself = true,
            .shadow_distance = 1e-3,
            .default_diffuse = 0.2,
        },
    [GLINT_DIALECT_GLINT] =
        {
            .name = "glint",
            .radiance_over_pi = true,
            .glazed_behind = true,
            .last_level = 12,
            .area_light_visible = true,
            .environment_lights = true,
            .highlight_needs_light = true,
            .sphere_shadows_itself = true,
            .cone_geometric = true,
            .default_diffuse = 1,
        },
};

const GiRules *gi_dialect_rules(GlintDialect dialect) { return &rules[dialect]; }

const char *glint_dialect_name(GlintDialect dialect) {
    return (unsigned)dialect < GLINT_DIALECT_COUNT ? rules[dialect].name : NULL;
}

bool glint_dialect_from_name(const char *name, GlintDialect *dialect) {
    for (int i = 0; i < GLINT_DIALECT_COUNT; i++) {
        if (strcmp(name, rules[i].name) == 0) {
            *dialect = (GlintDialect)i;
            return true;
        }
    }
    return false;
}

GlintDialect gi_dialect_detect(unsigned evidence) {
    bool typed_camera = evidence & GI_EVIDENCE_CAMERA_TYPE;
    bool typed_light = evidence & GI_EVIDENCE_LIGHT_TYPE;
    if (evidence & GI_EVIDENCE_BSDF) return GLINT_DIALECT_2018B;
    if (evidence & GI_EVIDENCE_MATERIAL) return GLINT_DIALECT_MATERIAL;
    if (!typed_camera) return typed_light ? GLINT_DIALECT_MATERIAL : GLINT_DIALECT_2012;
    if (typed_light || (evidence & GI_EVIDENCE_SECOND_TRACER)) return GLINT_DIALECT_2017B;
    if (evidence & GI_EVIDENCE_BRDF) return GLINT_DIALECT_2018;
    if (evidence & GI_EVIDENCE_2019) return GLINT_DIALECT_2019;
    if (evidence & GI_EVIDENCE_EXPOSURE) return GLINT_DIALECT_2017;
    return GLINT_DIALECT_2013;
}
