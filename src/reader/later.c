/* SPDX-License-Identifier: MIT */
#include "reader/later.h"

#include "scene/dialect.h"

#include <string.h>

static const GiLater rows[] = {
    {"bsdf", GI_KIND_SCENE, GI_EVIDENCE_BSDF},
    {"integrator", GI_KIND_SCENE, GI_EVIDENCE_BSDF},
    {"environment", GI_KIND_SCENE, GI_EVIDENCE_BSDF},
    {"cubemap", GI_KIND_SCENE, GI_EVIDENCE_SECOND_TRACER},
    {"brdf", GI_KIND_SCENE, GI_EVIDENCE_BRDF},
    {"mirrorCoefficient", GI_KIND_SCENE, GI_EVIDENCE_2019},
    {"texture", GI_KIND_SCENE, GI_EVIDENCE_EXPOSURE},

    {"Mesh", GI_KIND_SURFACE, 0},

    {"Glass", GI_KIND_SHADER, GI_EVIDENCE_SECOND_TRACER},
    {"Glazed", GI_KIND_SHADER, GI_EVIDENCE_SECOND_TRACER},
    {"CookTorrance", GI_KIND_SHADER, GI_EVIDENCE_SECOND_TRACER},
    {"Microfacet", GI_KIND_SHADER, 0},
    {"MicrofacetBeckmann", GI_KIND_SHADER, GI_EVIDENCE_2019},
    {"MicrofacetGGX", GI_KIND_SHADER, GI_EVIDENCE_2019},

    {"DirectionalLight", GI_KIND_LIGHT, GI_EVIDENCE_LIGHT_TYPE},
    {"RectangleLight", GI_KIND_LIGHT, GI_EVIDENCE_LIGHT_TYPE},
};
enum { ROW_COUNT = sizeof rows / sizeof rows[0] };

static bool same_in_any_case(const char *a, const char *b) {
    while (*a != '\0' && gi_lower(*a) == gi_lower(*b)) a++, b++;
    return *a == '\0' && *b == '\0';
}

const GiLater *gi_later_element(const char *name) {
    for (int i = 0; i < ROW_COUNT; i++) {
        if (rows[i].kind == GI_KIND_SCENE && same_in_any_case(rows[i].name, name)) return &rows[i];
    }
    return NULL;
}

const GiLater *gi_later_type(const char *name, GiKind kind) {
    for (int i = 0; i < ROW_COUNT; i++) {
        if (rows[i].kind == kind && strcmp(rows[i].name, name) == 0) return &rows[i];
    }
    return NULL;
}
