/* SPDX-License-Identifier: MIT
 * What happens while one pixel is drawn, written down for glint_explain: the stages call these
 * functions when gi_stage_records says so, and never otherwise. A record only looks on: what the
 * stages compute does not depend on it.
 *
 * It adds up what it is told, in the order in which it is told. That this gives the pixel, to the
 * last bit, is the proof that nothing was left out; the tests hold it against every pixel of the
 * golden scenes. */
#pragma once

#include "render/stage.h"

/* Who calls these does so hardly ever, and is to be compiled for the other case. */
#if defined(__GNUC__)
#define GI_RARELY __attribute__((cold))
#else
#define GI_RARELY
#endif

struct GiRecord {
    GiMemory *memory;
    const GlintExplainSink *sink;
    GI_ARRAY(GlintExplainRay) rays;
    GI_ARRAY(GlintExplainLayer) layers;
    GI_ARRAY(GlintExplainBranch) branches;
    GI_ARRAY(GlintExplainLight) lights;
    GI_ARRAY(GlintExplainAddition) additions;
    GI_ARRAY(uint32_t) points; /* of each point under way: the ray that met it */
    GI_ARRAY(uint32_t) beams;  /* lights whose shadow rays are under way, in their order */
    size_t next_beam;          /* the first of them whose ray has not been traced */
    GiScatterNotes notes;      /* of the surface being taken apart */
    uint32_t listed[GI_BRANCH_LIMIT + 1]; /* its branches; behind these, what the bsdf draws */
    uint32_t chosen;                      /* the branch along which a ray is being sent */
    GiVec color, sum;                     /* of the sample so far, of the samples so far */
    int samples;                          /* of the pixel */
    bool out_of_memory;
};

void gi_record_init(GiRecord *record, GiMemory *memory, const GlintExplainSink *sink);
void gi_record_reset(GiRecord *record);

/* ---- record.c: rays */

/* Which samples of a pixel are drawn: of first to end - 1 all, or the one that is asked for. */
void gi_record_choose_samples(const GiRecord *record, int *first, int *end);

/* A sample begins: its only camera ray lies traced in the bundle. */
GI_RARELY void gi_record_camera(const GiStage *stage);

/* Gives a ray that is sent along the chosen branch its number. */
GI_RARELY uint32_t gi_record_flight(const GiStage *stage, const GiFlight *flight);

/* What the ray with this number met; null: nothing. */
GI_RARELY void gi_record_hit(const GiStage *stage, uint32_t ray, const GiTraceHit *hit);

/* All points that have come since belong to this ray. */
GI_RARELY void gi_record_points(const GiStage *stage, uint32_t ray);

/* Where gi_bsdf_scatter is to leave its notes; null in drawing. */
static inline GiScatterNotes *gi_record_notes(const GiStage *stage) {
    return gi_stage_records(stage) ? &stage->record->notes : NULL;
}

/* What they say of the surface that the ray met. Until a branch is chosen it is not followed. */
GI_RARELY void gi_record_scatter(const GiStage *stage, uint32_t ray, const GiScatter *scatter);

/* The next ray goes along this branch of the surface, or, behind the last, in a direction that its
 * bsdf draws; a path does so with this chance. */
GI_RARELY void gi_record_choose(const GiStage *stage, int branch, double chance);

/* ... but chance decides whether the path goes on, and p is that of going on. */
GI_RARELY void gi_record_roulette(const GiStage *stage, double p);

/* What the end of a ray shows by itself is added. */
GI_RARELY void gi_record_add(const GiStage *stage, uint32_t ray, GiVec amount);

/* A sample has been drawn. */
GI_RARELY void gi_record_end(const GiStage *stage, int samples);

/* ---- record_light.c: lights. A light is an index into the scene's, or -1: the environment */

/* The shadow rays of all points have been traced, as the lit has it, and what arrives is added. */
GI_RARELY void gi_record_point_light(const GiStage *stage, size_t light);

GI_RARELY void gi_record_ambient(const GiStage *stage, size_t light, int point, GiVec adds);

/* A beam that adds so much, unless it is blocked, which is told later and in the same order; share
 * is what the product of its light and the bsdf has been multiplied by. */
GI_RARELY void gi_record_beam(
    const GiStage *stage, int light, int point, const GiBeam *beam, double share, GiVec adds);
GI_RARELY void gi_record_beam_traced(const GiStage *stage, const GiTraceRay *ray, bool blocked);

/* No beam goes to the light from there. */
GI_RARELY void gi_record_no_beam(const GiStage *stage, int light, int point);

/* ---- both */

static inline void gi_record_vec(double to[3], GiVec v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

/* Appends an addition and gives its index; GLINT_NONE when it adds nothing. */
uint32_t gi_record_sum(GiRecord *record, uint32_t ray, uint32_t light, GiVec amount);

/* What of a scene a surface is. light: from 1, of a rectangle that shines, or 0. */
typedef struct GiRecordThing {
    GlintSurfaceId surface;
    GlintSurfaceType type;
    uint32_t triangle, light;
    GlintShaderId shader;
} GiRecordThing;

GiRecordThing gi_record_thing(const GiWorld *world, GiShapeRef shape, uint32_t instance);
