/* SPDX-License-Identifier: MIT */
#include "render/record.h"
#include "shade/shade.h"

/* What arrives at point i. */
static inline void add_point(const GiStage *stage, int i, GiVec light) {
    GiTileScratch *scratch = stage->scratch;
    GiPoints *points = &scratch->points;
    if (scratch->weighted) light = gi_multiply(scratch->factors[i], light);
    if (scratch->shared) {
        GiVec *color = &scratch->color[points->pixel[i]];
        *color = gi_add(*color, light);
    } else {
        points->red[i] += light.x, points->green[i] += light.y, points->blue[i] += light.z;
    }
}

/* ---------------------------------------------------------------- point lights */

bool gi_lights_gloss(const GiRules *rules, const GiShader *shader, GiGloss *gloss) {
    bool phong = shader->type == GLINT_SHADER_PHONG;
    if (!phong && shader->type != GLINT_SHADER_LAMBERTIAN) return false;
    if (shader->texture != GI_NONE || rules->odd_shading) return false;
    unsigned exponent = 0;
    if (phong) {
        if (!(shader->exponent >= 0 && shader->exponent <= 1024)) return false;
        exponent = (unsigned)shader->exponent;
        if (exponent != shader->exponent) return false;
    }
    *gloss = (GiGloss){
        .diffuse = shader->diffuse,
        .specular = shader->specular,
        .diffuse_factor = gi_shade_diffuse_factor(rules),
        .phong = phong,
        .exponent = exponent,
        .cosine = rules->phong_cosine,
        .needs_light = rules->highlight_needs_light,
        .front_only = rules->black_from_behind,
        .away = rules->shadow_distance,
    };
    return true;
}

static GiVec point_at(const GiPoints *points, int i) {
    return gi_vec(points->px[i], points->py[i], points->pz[i]);
}

/* From a point, as far as it is, or of length 1. */
static inline GiVec to_light(const GiPointLight *light, GiVec from) {
    return light->parallel ? light->position : gi_sub(light->position, from);
}

/* The same as the kernels' light, for any shader. */
static void light_segment(const GiStage *stage, const GiLight *model, const GiPointLight *light,
    const GiSegment *segment) {
    GiTileScratch *scratch = stage->scratch;
    const GiRules *rules = stage->world->rules;
    const GiPoints *points = &scratch->points;
    GiLit *lit = &scratch->lit;
    for (int i = segment->begin; i < segment->end; i++) {
        lit->arrives[i] = 0;
        GiVec d = to_light(light, point_at(points, i));
        double square = light->parallel ? 1 : gi_dot(d, d);
        if (!(square > 0)) continue; /* the light is on the surface */
        double inverse = 1 / sqrt(square);
        GiVec l = gi_scale(d, inverse);
        GiShading at = gi_surface_shading(stage, i);
        GiVec arrives = light->parallel ? light->intensity : gi_shade_light(model, rules, square);
        GiVec adds = gi_multiply(arrives, gi_bsdf_evaluate(&at, l));
        if (gi_vec_is_zero(adds)) continue;
        double away = rules->shadow_distance > 0 ? rules->shadow_distance : points->error[i];
        int k = lit->count++;
        lit->red[i] = adds.x, lit->green[i] = adds.y, lit->blue[i] = adds.z;
        lit->t_min[i] = away * inverse;
        lit->skip[i] = points->skip[i];
        lit->point[k] = (uint32_t)i;
        if (light->parallel) {
            l = gi_along(l, gi_sub(point_at(points, i), light->center), -light->part);
        }
        lit->x[k] = (float)l.x, lit->y[k] = (float)l.y, lit->z[k] = (float)l.z;
    }
}

/* What a shadow ray becomes in a program with mistakes. False: it is not traced at all. */
static bool spoil_shadow_ray(const GiRules *rules, GiTraceRay *ray) {
    if (rules->shadows == GI_SHADOWS_MISSING) return false;
    if (rules->shadows == GI_SHADOWS_BEYOND) ray->t_max = INFINITY;
    if (rules->shadows == GI_SHADOWS_REVERSED) ray->direction = gi_negate(ray->direction);
    return true;
}

/* As gi_lights_trace, for shadows that are wrong: one ray at a time. */
static void trace_spoiled(const GiStage *stage, GiVec light, bool parallel) {
    const GiPoints *points = &stage->scratch->points;
    GiLit *lit = &stage->scratch->lit;
    const GiWorld *world = stage->world;
    for (int k = 0; k < lit->count; k++) {
        if (k % 1024 == 0 && gi_stage_stopped(stage)) return;
        uint32_t i = lit->point[k];
        GiVec origin = point_at(points, (int)i);
        GiTraceRay ray = {origin, parallel ? light : gi_sub(light, origin), lit->t_min[i],
            parallel ? INFINITY : 1, points->skip[i], points->skip_instance[i]};
        lit->arrives[i] =
            !spoil_shadow_ray(world->rules, &ray) || !world->kernel->any(&world->trace, &ray);
    }
}

void gi_lights_trace(const GiStage *stage, GiVec light, bool parallel) {
    if (stage->world->rules->shadows != GI_SHADOWS_CAST) {
        trace_spoiled(stage, light, parallel);
        return;
    }
    GiTileScratch *scratch = stage->scratch;
    GiBundle *bundle = &scratch->bundle;
    const GiPoints *points = &scratch->points;
    GiLit *lit = &scratch->lit;
    const GiWorld *world = stage->world;
    double leaves = (double)world->leaf_count * (1 + (double)world->spread.instances.count);
    const int size = GI_BUNDLE_SIZE;
    world->kernel->regroup(&scratch->regroup, lit->x, lit->y, lit->z, lit->count, leaves);
    for (int begin = 0; begin < lit->count; begin += size) {
        if (gi_stage_stopped(stage)) return;
        const uint16_t *order = scratch->regroup.order + begin;
        bundle->count = lit->count - begin < size ? lit->count - begin : size;
        bundle->apex = light;
        bundle->end = 1;
        bundle->own = false;
        bundle->side = scratch->regroup.side[begin / size];
        world->kernel->shadows(points, lit, order, bundle);
        if (parallel) {
            world->kernel->bundle_parallel(&world->trace, bundle, light);
        } else {
            world->kernel->bundle_any(&world->trace, bundle);
        }
        for (int i = 0; i < bundle->count; i++) {
            lit->arrives[bundle->pixel[i]] = bundle->shape[i] == GI_SHAPE_NONE;
        }
    }
}

static void add_lit(const GiStage *stage) {
    GiTileScratch *scratch = stage->scratch;
    const GiLit *lit = &scratch->lit;
    if (!scratch->weighted && !scratch->shared) {
        stage->world->kernel->add(lit, &scratch->points);
        return;
    }
    for (int k = 0; k < lit->count; k++) {
        int i = (int)lit->point[k];
        if (lit->arrives[i] == 0) continue;
        add_point(stage, i, gi_vec(lit->red[i], lit->green[i], lit->blue[i]));
    }
}

static void trace_and_add(const GiStage *stage, const GiPointLight *light) {
    GiTileScratch *scratch = stage->scratch;
    gi_lights_trace(stage, light->position, light->parallel);
    stage->counts->shadow_rays += (uint64_t)scratch->lit.count;
    if (!gi_stage_stopped(stage)) add_lit(stage);
}

/* A point of light, or one that is infinitely far away. */
static void add_small_light(const GiStage *stage, const GiLight *model, const GiPointLight *light) {
    GiTileScratch *scratch = stage->scratch;
    const GiWorld *world = stage->world;
    scratch->lit.count = 0;
    for (int i = 0; i < scratch->segment_count; i++) {
        const GiSegment *segment = &scratch->segments[i];
        GiGloss gloss;
        if (gi_lights_gloss(world->rules, &world->scene->shaders.data[segment->shader], &gloss)) {
            world->kernel->light(
                &scratch->points, segment->begin, segment->end, light, &gloss, &scratch->lit);
        } else {
            light_segment(stage, model, light, segment);
        }
    }
    if (scratch->lit.count > 0) trace_and_add(stage, light);
}

static void add_point_light(const GiStage *stage, size_t index) {
    const GiWorld *world = stage->world;
    const GiLight *light = &world->scene->lights.data[index];
    const GiPointLight point = {.position = light->position,
        .intensity = light->intensity,
        .falls = gi_shade_light_falls(light, world->rules)};
    add_small_light(stage, light, &point);
    if (gi_stage_records(stage)) gi_record_point_light(stage, index);
}

/* ---------------------------------------------------------------- all other lights */

/* Where shadow rays begin: a distance. */
static double away_of(const GiStage *stage, int i) {
    double distance = stage->world->rules->shadow_distance;
    return distance > 0 ? distance : stage->scratch->points.error[i];
}

/* Shadow rays that are traced together, and what arrives if nothing is in the way. */
enum { BEAMS_TOGETHER = 1024 };
typedef struct BeamBatch {
    int count;
    int point[BEAMS_TOGETHER];
    GiVec light[BEAMS_TOGETHER];
    GiTraceRay ray[BEAMS_TOGETHER];
} BeamBatch;

static void flush_beams(const GiStage *stage, BeamBatch *batch) {
    const GiWorld *world = stage->world;
    bool blocked[BEAMS_TOGETHER] = {false};
    bool traced = true;
    for (int k = 0; k < batch->count && world->rules->shadows != GI_SHADOWS_CAST; k++) {
        traced = spoil_shadow_ray(world->rules, &batch->ray[k]);
    }
    if (traced) world->kernel->many_any(&world->trace, batch->ray, batch->count, blocked);
    stage->counts->shadow_rays += (uint64_t)batch->count;
    for (int k = 0; k < batch->count; k++) {
        if (!blocked[k]) add_point(stage, batch->point[k], batch->light[k]);
        if (gi_stage_records(stage)) gi_record_beam_traced(stage, &batch->ray[k], blocked[k]);
    }
    batch->count = 0;
}

static void add_beam(
    const GiStage *stage, int light_index, int i, const GiBeam *beam, BeamBatch *batch) {
    GiShading at = gi_surface_shading(stage, i);
    GiVec value = gi_bsdf_evaluate(&at, beam->direction);
    double factor = beam->radiance ? gi_stage_radiance(&at) : 1;
    if (beam->density > 0 && gi_surface_probes(stage->world, at.shader)) {
        factor *= gi_stage_share(
            stage, GI_TECHNIQUE_LIGHT, beam->density, gi_bsdf_density(&at, beam->direction));
    }
    GiVec light = gi_scale(gi_multiply(beam->light, value), factor);
    if (gi_stage_records(stage)) gi_record_beam(stage, light_index, i, beam, factor, light);
    if (gi_vec_is_zero(light)) return;
    const GiPoints *points = &stage->scratch->points;
    int k = batch->count++;
    batch->point[k] = i;
    batch->light[k] = light;
    batch->ray[k] = (GiTraceRay){point_at(points, i), beam->direction, beam->t_min, beam->t_max,
        points->skip[i], points->skip_instance[i]};
    if (batch->count == BEAMS_TOGETHER) flush_beams(stage, batch);
}

/* The random numbers for a large light at a point. */
static void draw_pair(const GiStage *stage, int i, uint32_t purpose, double u[2]) {
    const GiTileScratch *scratch = stage->scratch;
    GiSampler sampler = gi_stage_sampler(stage, scratch->points.pixel[i]);
    gi_sample_2d(&sampler, gi_stage_dimension(scratch->spots[i].level, purpose), u);
}

static bool sky_beam(const GiStage *stage, int i, GiBeam *beam) {
    double u[2];
    GiVec direction, radiance;
    draw_pair(stage, i, GI_PURPOSE_SKY, u);
    double density = gi_environment_sample(&stage->world->sky, u, &direction, &radiance);
    if (!(density > 0)) return false;
    *beam = (GiBeam){.direction = direction,
        .light = gi_scale(radiance, 1 / density),
        .t_min = away_of(stage, i),
        .t_max = INFINITY,
        .distance = INFINITY,
        .density = density,
        .radiance = true};
    return true;
}

static void add_ambient(const GiStage *stage, size_t index) {
    const GiLight *light = &stage->world->scene->lights.data[index];
    for (int i = 0; i < stage->scratch->points.count; i++) {
        GiShading at = gi_surface_shading(stage, i);
        GiVec adds = gi_shade_ambient(&at, light);
        add_point(stage, i, adds);
        if (gi_stage_records(stage)) gi_record_ambient(stage, index, i, adds);
    }
}

/* The same ray by ray, as it is written down when a pixel is to be explained. */
static void record_directional(const GiStage *stage, size_t index) {
    const GiLight *light = &stage->world->scene->lights.data[index];
    BeamBatch batch;
    batch.count = 0;
    for (int i = 0; i < stage->scratch->points.count; i++) {
        if (i % 16 == 0 && gi_stage_stopped(stage)) return;
        const GiBeam beam = {.direction = gi_normalize(light->direction),
            .light = light->intensity,
            .t_min = away_of(stage, i),
            .t_max = INFINITY,
            .distance = INFINITY};
        add_beam(stage, (int)index, i, &beam, &batch);
    }
    flush_beams(stage, &batch);
}

static void add_directional(const GiStage *stage, size_t index) {
    enum { FAR = 64 }; /* times the size of the scene: far enough for the order of rays */
    const GiLight *light = &stage->world->scene->lights.data[index];
    const GiTree *tree = &stage->world->store.tree;
    const GiPointLight sun = {.position = gi_normalize(light->direction),
        .intensity = light->intensity,
        .parallel = true,
        .center = tree->center,
        .part = tree->scale / FAR};
    if (gi_stage_records(stage)) {
        record_directional(stage, index);
    } else {
        add_small_light(stage, light, &sun);
    }
}

/* One point of the rectangle, drawn anew for every point of a surface. */
static void add_rectangle(const GiStage *stage, size_t index) {
    const GiWorld *world = stage->world;
    const GiPoints *points = &stage->scratch->points;
    GiVec intensity = world->scene->lights.data[index].intensity;
    GiPairs pairs = {.u = {0}};
    GiAreaBeams to;
    BeamBatch batch;
    batch.count = 0;
    for (int begin = 0, count; begin < points->count; begin += count) {
        if (gi_stage_stopped(stage)) return;
        int left = points->count - begin;
        count = left < GI_AREA_TOGETHER ? left : GI_AREA_TOGETHER;
        for (int k = 0; k < count; k++) {
            double u[2];
            draw_pair(stage, begin + k, GI_PURPOSE_LIGHT + (uint32_t)index, u);
            pairs.u[k] = u[0], pairs.v[k] = u[1];
        }
        world->kernel->area(&world->lights.data[index], points, begin, count, &pairs, &to);
        for (int k = 0; k < count; k++) {
            if (to.factor[k] > 0) {
                const GiBeam beam = {.direction = gi_vec(to.dx[k], to.dy[k], to.dz[k]),
                    .light = gi_scale(intensity, to.factor[k]),
                    .t_min = away_of(stage, begin + k),
                    .t_max = to.t_max[k],
                    .distance = to.distance[k],
                    .density = world->rules->area_light_visible ? 1 / to.factor[k] : 0,
                    .radiance = true};
                add_beam(stage, (int)index, begin + k, &beam, &batch);
            } else if (gi_stage_records(stage)) {
                gi_record_no_beam(stage, (int)index, begin + k);
            }
        }
    }
    flush_beams(stage, &batch);
}

static void add_sky(const GiStage *stage) {
    BeamBatch batch;
    batch.count = 0;
    for (int i = 0; i < stage->scratch->points.count; i++) {
        if (i % 16 == 0 && gi_stage_stopped(stage)) return;
        GiBeam beam;
        if (sky_beam(stage, i, &beam)) add_beam(stage, -1, i, &beam, &batch);
    }
    flush_beams(stage, &batch);
}

static void add_light(const GiStage *stage, size_t index) {
    const GiScene *scene = stage->world->scene;
    const GiLight *light = &scene->lights.data[index];
    switch (light->type) {
    case GLINT_LIGHT_POINT: add_point_light(stage, index); break;
    case GLINT_LIGHT_RECTANGLE:
        if (scene->integrator != GLINT_INTEGRATOR_POINT_LIGHT) add_rectangle(stage, index);
        break;
    case GLINT_LIGHT_DIRECTIONAL: add_directional(stage, index); break;
    case GLINT_LIGHT_AMBIENT:
    case GLINT_LIGHT_CONSTANT:
    case GLINT_LIGHT_NORMAL: add_ambient(stage, index); break;
    }
}

/* Of points that do not share their pixels. */
static void show_points(GiTileScratch *scratch) {
    const GiPoints *points = &scratch->points;
    for (int i = 0; i < points->count; i++) {
        scratch->color[points->pixel[i]] =
            gi_vec(points->red[i], points->green[i], points->blue[i]);
    }
}

void gi_lights_add(const GiStage *stage) {
    const GiScene *scene = stage->world->scene;
    for (size_t i = 0; i < scene->lights.count && !gi_stage_stopped(stage); i++) {
        if (gi_stage_draws(stage, (int)i)) add_light(stage, i);
    }
    if (stage->world->sky_lights && gi_stage_draws(stage, -1)) add_sky(stage);
    if (!stage->scratch->shared) show_points(stage->scratch);
    stage->scratch->points.count = stage->scratch->segment_count = 0;
    if (gi_stage_records(stage)) stage->record->points.count = 0;
}
