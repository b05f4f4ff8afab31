/* SPDX-License-Identifier: MIT
 * What lights do at points. Drawing computes what a light adds many points at a time and keeps no
 * more than the product; here its parts are worked out again, by the same formulas (src/shade/),
 * and the product is the one that drawing has. */
#include "render/record.h"
#include "shade/shade.h"

/* ---------------------------------------------------------------- what is in the way */

static void note_blocker(const GiStage *stage, const GiTraceRay *ray, GlintExplainLight *note) {
    const GiWorld *world = stage->world;
    GiTraceHit hit;
    if (!world->kernel->closest(&world->trace, ray, &hit)) return;
    GiRecordThing thing = gi_record_thing(world, hit.shape, hit.instance);
    note->fate = GLINT_LIGHT_BLOCKED;
    note->blocker = thing.surface;
    note->blocker_type = thing.type;
    note->blocker_triangle = thing.triangle;
    note->blocker_light = thing.light;
    note->blocker_distance = hit.t * gi_length(ray->direction);
    gi_record_vec(note->blocker_point, gi_along(ray->origin, ray->direction, hit.t));
}

/* ---------------------------------------------------------------- notes */

static GiVec point_at(const GiPoints *points, int i) {
    return gi_vec(points->px[i], points->py[i], points->pz[i]);
}

/* Why a light adds nothing, when no shadow ray is traced. */
static GlintLightFate fate_of_dark(const GlintExplainLight *note, const GiShading *at) {
    GlintShaderType type = at->shader->type;
    bool facets = type == GLINT_SHADER_BECKMANN || type == GLINT_SHADER_GGX;
    double nv = gi_dot(at->normal, at->toward_viewer);
    if (gi_vec_is_zero(gi_vec_from(note->strength))) return GLINT_LIGHT_OFF;
    if (nv < 0 && (facets || at->rules->black_from_behind)) return GLINT_LIGHT_UNSEEN_SIDE;
    return note->n_dot_l > 0 ? GLINT_LIGHT_ABSORBED : GLINT_LIGHT_BEHIND;
}

/* What a light of strength E does from direction l. */
static GlintExplainLight note_of(const GiStage *stage, int light, int i, GiVec l, GiVec strength) {
    const GiRecord *record = stage->record;
    GiShading at = gi_surface_shading(stage, i);
    GiLobes lobes = gi_bsdf_lobes(&at, l);
    GiVec h = gi_normalize(gi_add(l, at.toward_viewer));
    GlintExplainLight note = {
        .ray = (size_t)i < record->points.count ? record->points.data[i] : GLINT_NONE,
        .light = (uint32_t)(light + 1),
        .n_dot_l = gi_dot(at.normal, l),
        .n_dot_h = gi_dot(at.normal, h),
        .falloff = 1,
        .fresnel = lobes.fresnel,
        .distribution = lobes.distribution,
        .masking = lobes.masking,
        .share = 1,
        .blocker_triangle = GLINT_NONE,
        .addition = GLINT_NONE};
    gi_record_vec(note.direction, l);
    gi_record_vec(note.strength, strength);
    gi_record_vec(note.diffuse, lobes.diffuse);
    gi_record_vec(note.highlight, lobes.highlight);
    gi_record_vec(note.reflected, gi_add(lobes.diffuse, lobes.highlight));
    note.fate = fate_of_dark(&note, &at);
    return note;
}

/* Appends it. What arrives is added, as the factor of the point has it. */
static void keep(const GiStage *stage, int i, GlintExplainLight *note) {
    GiRecord *record = stage->record;
    bool adds = note->fate == GLINT_LIGHT_ARRIVES || note->fate == GLINT_LIGHT_EVERYWHERE;
    if (adds) {
        const GiTileScratch *scratch = stage->scratch;
        GiVec light = gi_vec_from(note->term);
        if (scratch->weighted) light = gi_multiply(scratch->factors[i], light);
        note->addition = gi_record_sum(record, note->ray, (uint32_t)record->lights.count, light);
    }
    if (!gi_array_push(record->memory, &record->lights, *note)) record->out_of_memory = true;
}

/* ---------------------------------------------------------------- point lights */

/* The shadow ray, as the kernels make it (kernel/stream.h). */
static GiTraceRay shadow_ray(const GiStage *stage, int i, GiVec light) {
    const GiPoints *points = &stage->scratch->points;
    GiVec p = point_at(points, i);
    return (GiTraceRay){p, gi_sub(light, p), stage->scratch->lit.t_min[i], 1, points->skip[i],
        points->skip_instance[i]};
}

static void record_point(const GiStage *stage, size_t index, int i, bool listed) {
    const GiLight *light = &stage->world->scene->lights.data[index];
    const GiRules *rules = stage->world->rules;
    const GiLit *lit = &stage->scratch->lit;
    GiVec d = gi_sub(light->position, point_at(&stage->scratch->points, i));
    double square = gi_dot(d, d);
    GiVec l = square > 0 ? gi_scale(d, 1 / sqrt(square)) : gi_vec(0, 0, 0);
    GiVec strength = square > 0 ? gi_shade_light(light, rules, square) : gi_vec(0, 0, 0);
    GlintExplainLight note = note_of(stage, (int)index, i, l, strength);
    note.distance = sqrt(square);
    if (gi_shade_light_falls(light, rules)) note.falloff = 1 / square;
    if (!(square > 0)) note.fate = GLINT_LIGHT_ON_SURFACE;
    if (listed) {
        GiTraceRay ray = shadow_ray(stage, i, light->position);
        note.fate = GLINT_LIGHT_ARRIVES;
        gi_record_vec(note.term, gi_vec(lit->red[i], lit->green[i], lit->blue[i]));
        note.shadow_begin = lit->t_min[i] * note.distance;
        note.shadow_end = note.distance;
        if (lit->arrives[i] == 0) note_blocker(stage, &ray, &note);
    }
    keep(stage, i, &note);
}

void gi_record_point_light(const GiStage *stage, size_t index) {
    const GiLit *lit = &stage->scratch->lit;
    int next = 0; /* of those to which the light adds something, which are listed in order */
    for (int i = 0; i < stage->scratch->points.count; i++) {
        bool listed = next < lit->count && lit->point[next] == (uint32_t)i;
        if (listed) next++;
        record_point(stage, index, i, listed);
    }
}

/* ---------------------------------------------------------------- all other lights */

void gi_record_ambient(const GiStage *stage, size_t index, int i, GiVec adds) {
    const GiRecord *record = stage->record;
    GlintExplainLight note = {.fate = GLINT_LIGHT_EVERYWHERE,
        .ray = (size_t)i < record->points.count ? record->points.data[i] : GLINT_NONE,
        .light = (uint32_t)index + 1,
        .blocker_triangle = GLINT_NONE,
        .addition = GLINT_NONE};
    gi_record_vec(note.term, adds);
    keep(stage, i, &note);
}

/* A note that waits for its shadow ray does so in its place among the lights. */
void gi_record_beam(
    const GiStage *stage, int light, int i, const GiBeam *beam, double share, GiVec adds) {
    GiRecord *record = stage->record;
    GlintExplainLight note = note_of(stage, light, i, beam->direction, beam->light);
    note.distance = beam->distance;
    note.density = beam->density;
    note.share = share;
    gi_record_vec(note.term, adds);
    if (!gi_vec_is_zero(adds)) {
        note.shadow_begin = beam->t_min;
        note.shadow_end = beam->t_max;
        note.fate = GLINT_LIGHT_BLOCKED;
        uint32_t place = (uint32_t)record->lights.count;
        if (!gi_array_push(record->memory, &record->beams, place)) record->out_of_memory = true;
    }
    keep(stage, i, &note);
}

void gi_record_beam_traced(const GiStage *stage, const GiTraceRay *ray, bool blocked) {
    GiRecord *record = stage->record;
    if (record->out_of_memory || record->next_beam == record->beams.count) return;
    uint32_t place = record->beams.data[record->next_beam++];
    GlintExplainLight *note = &record->lights.data[place];
    if (blocked) {
        note_blocker(stage, ray, note);
        return;
    }
    /* The factor of the point is that of the ray: both are noted from the same numbers. */
    const GlintExplainRay *at = &record->rays.data[note->ray];
    GiVec light = gi_vec_from(note->term);
    if (stage->scratch->weighted) light = gi_multiply(gi_vec_from(at->local_factor), light);
    note->fate = GLINT_LIGHT_ARRIVES;
    note->addition = gi_record_sum(record, note->ray, place, light);
}

void gi_record_no_beam(const GiStage *stage, int light, int i) {
    GlintExplainLight note = note_of(stage, light, i, gi_vec(0, 0, 0), gi_vec(0, 0, 0));
    note.fate = GLINT_LIGHT_TURNED_AWAY;
    keep(stage, i, &note);
}
