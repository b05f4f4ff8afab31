/* SPDX-License-Identifier: MIT
 * What a surface does with light at one point: how it reflects light that comes from a direction
 * (the local part), and which rays it sends on (branches: mirror and refraction). The formulas are
 * docs/scene-format.md's; what differs between years is asked of GiRules. */
#pragma once

#include "scene/scene.h"

/* A point of a surface with its shader. */
typedef struct GiShading {
    const GiScene *scene; /* for substrates */
    const GiRules *rules;
    const GiShader *shader;
    GiVec normal;        /* n: unit, outward */
    GiVec toward_viewer; /* v: unit */
    GiVec diffuse;       /* kd: the shader's, or the texture's there */
} GiShading;

/* ---- the local part: all but mirrors and refraction */

/* f(l, v) n.l: light of strength E from the unit direction l adds E times this. It is finite, also
 * where l or v grazes the surface. Glazed, Glass and RGBNormals have none of their own. */
GiVec gi_bsdf_evaluate(const GiShading *at, GiVec l);

/* What gi_bsdf_evaluate consists of. */
typedef struct GiLobes {
    GiVec diffuse, highlight;              /* their sum is what it gives, to the last bit */
    double fresnel, distribution, masking; /* F, D and G of microfacets; 0 elsewhere */
} GiLobes;

GiLobes gi_bsdf_lobes(const GiShading *at, GiVec l);

/* What gi_bsdf_evaluate is to be multiplied by for light that comes as radiance from all around, as
 * in path tracing: 1, or 1/pi where a year writes kd for what radiometry calls kd/pi. Then, and
 * only then, no surface with sensible colours sends back more than it gets (docs/accuracy.md names
 * those that do). */
double gi_bsdf_radiometric(const GiShading *at);

/* Draws a direction from three numbers in [0, 1) and returns the density per solid angle with which
 * it does, 0 when it draws none. The light that comes from there counts evaluate / density. */
double gi_bsdf_sample(const GiShading *at, const double u[3], GiVec *l);

/* The density with which gi_bsdf_sample draws l, the same to the last bit. Its integral over the
 * sphere is one less the part of draws that give none. */
double gi_bsdf_density(const GiShading *at, GiVec l);

/* ---- branches */

enum { GI_BRANCH_LIMIT = GI_SUBSTRATE_LIMIT + 3 };

/* A ray that goes on from the surface: what it brings counts `factor`. */
typedef struct GiBranch {
    GiVec direction; /* unit, but for rounding */
    GiVec factor;    /* not zero */
    double weight; /* of the whole path so far, with this branch; rules->least_weight is about it */
    bool inside;   /* the new ray runs in glass (rules->glass_by_flag) */
    bool through;  /* it is refracted, not mirrored */
} GiBranch;

/* What a layer did, for those who want to know why; drawing does not. */
typedef enum GiBranchOutcome {
    GI_BRANCH_NONE,     /* the layer has no such branch */
    GI_BRANCH_LISTED,   /* in branch[index] */
    GI_BRANCH_NOTHING,  /* it would add nothing */
    GI_BRANCH_TOO_LIGHT /* it weighs less than rules->least_weight */
} GiBranchOutcome;

typedef struct GiBranchNote {
    GiBranchOutcome outcome;
    int index;
    GiVec factor;
    double weight;
} GiBranchNote;

typedef struct GiLayerNote {
    const GiShader *shader;
    bool inside;          /* glass: the ray that arrives runs in it */
    bool behind;          /* seen from behind, where the layer does nothing or is black */
    bool total;           /* glass: all is mirrored */
    double cosine;        /* n.v, n on the side of v */
    double cosine_behind; /* of the refracted ray; 0 where there is none */
    double ratio;         /* glass: index before the boundary divided by that behind */
    double reflectance; /* R of glazing and glass; of a mirror coefficient its largest component */
    GiBranchNote mirrored, refracted;
} GiLayerNote;

typedef struct GiScatterNotes {
    int count;
    GiLayerNote layers[GI_SUBSTRATE_LIMIT + 2];
} GiScatterNotes;

typedef struct GiScatter {
    GiShading local;    /* what is under all glazing, ready for gi_bsdf_...; its shader is null
                           when nothing is left for light sources to be reflected by. Under
                           glazing `diffuse` is the substrate's own colour: the caller, who knows
                           where on the surface this is, looks up a texture of local.shader. */
    GiVec local_factor; /* of its reflected light */
    int count;
    GiBranch branch[GI_BRANCH_LIMIT];
    GiScatterNotes *notes; /* null, or where what the layers do is written down */
} GiScatter;

/* The ray that met the surface: its level (camera rays: 1), weight (camera rays: 1) and whether it
 * runs in glass. */
typedef struct GiArrival {
    int level;
    double weight;
    bool inside;
} GiArrival;

/* Takes glazing, glass and mirror coefficients apart. Branches that add nothing or weigh less than
 * rules->least_weight are not listed; the caller drops those that would be deeper than
 * rules->last_level. notes may be null. */
void gi_bsdf_scatter(
    const GiShading *at, const GiArrival *arrival, GiScatter *scatter, GiScatterNotes *notes);
