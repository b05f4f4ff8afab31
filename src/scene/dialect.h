/* SPDX-License-Identifier: MIT
 * What the years of the course do differently. Every rule that depends on the dialect is a member
 * of GiRules, and the rules of a dialect are one row of the table in dialect.c, nowhere else. */
#pragma once

#include "glint/glint.h"

/* What shadow rays do. */
typedef enum GiShadowRule {
    GI_SHADOWS_CAST,
    GI_SHADOWS_MISSING,
    GI_SHADOWS_BEYOND,  /* surfaces behind the light count */
    GI_SHADOWS_REVERSED /* the rays run the other way */
} GiShadowRule;

/* Which of the surfaces on a ray of the camera is seen. */
typedef enum GiHitRule { GI_HIT_NEAREST, GI_HIT_FIRST, GI_HIT_LAST } GiHitRule;

typedef struct GiRules {
    const char *name;
    bool falloff;               /* point lights fall off with the square of the distance */
    bool diffuse_over_pi;       /* the diffuse term is kd / pi, not kd */
    bool radiance_over_pi;      /* ... but where light is given as radiance, it is kd / pi */
    bool phong_cosine;          /* the highlight is multiplied by n.l */
    bool highlight_needs_light; /* no highlight where n.l <= 0 */
    bool black_from_behind;     /* reflected light is black where n.v < 0 */
    bool sphere_shadows_itself;
    bool entering_only;      /* boxes and cylinders lose their exits (docs/scene-format.md) */
    bool cone_geometric;     /* normals of a cone's second nappe are geometric */
    bool first_listed_first; /* order in which the transforms of a group act */
    double shadow_distance;  /* a shadow ray begins at this distance; 0: at the error bound */
    double default_diffuse;  /* of a Lambertian shader */
    bool schlick;            /* Glazed and Glass reflect by Schlick's formula, not Fresnel's */
    bool glass_by_flag;      /* a ray knows whether it is in glass by counting, not by n.v */
    bool glass_ends;         /* Glass and Glazed are black to a ray of the last level */
    bool glazed_behind;      /* Glazed lets its substrate shine where n.v < 0 */
    bool glazed_adds;        /* Glazed does not weaken its substrate */
    double least_weight;     /* branches of the ray tree below it are dropped */
    int last_level;          /* deepest level shaded; camera rays are level 1 */
    bool area_light_visible; /* rectangle lights are surfaces too */
    bool environment_lights; /* the environment lights surfaces */
    /* Those of no year, but of programs with mistakes (render/broken.c). */
    bool odd_shading; /* one of the four that follow, which the kernels do not know */
    bool falloff_linear;
    bool diffuse_behind;      /* |n.l|, not max(0, n.l) */
    bool specular_behind;     /* |n.h| */
    bool reflected_highlight; /* r.v, not n.h (Phong 1975) */
    bool texture_flipped;
    GiShadowRule shadows;
    GiHitRule hit;
} GiRules;

/* The row of a dialect other than AUTO. */
const GiRules *gi_dialect_rules(GlintDialect dialect);

/* What the reader saw in a file that tells its year. */
typedef enum GiEvidence {
    GI_EVIDENCE_BSDF = 1 << 0,          /* bsdf, integrator or environment */
    GI_EVIDENCE_MATERIAL = 1 << 1,      /* material element, Plane or Disc */
    GI_EVIDENCE_CAMERA_TYPE = 1 << 2,   /* the camera has a type */
    GI_EVIDENCE_LIGHT_TYPE = 1 << 3,    /* some light has a type other than Light */
    GI_EVIDENCE_SECOND_TRACER = 1 << 4, /* cubemap, Group, Glass, Glazed, CookTorrance */
    GI_EVIDENCE_BRDF = 1 << 5,
    GI_EVIDENCE_2019 = 1 << 6,    /* mirrorCoefficient, MicrofacetBeckmann, -GGX */
    GI_EVIDENCE_EXPOSURE = 1 << 7 /* exposure or texture */
} GiEvidence;

/* The dialect that the evidence (a set of GiEvidence) points to. */
GlintDialect gi_dialect_detect(unsigned evidence);
