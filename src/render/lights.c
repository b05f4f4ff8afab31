/* SPDX-License-Identifier: MIT */
#include "render/stage.h"
#include "shade/bsdf.h"
#include "shade/shade.h"

/* ---------------------------------------------------------------- point lights */

static GiVec vec_at(const double *x, const double *y, const double *z, int i) {
    return gi_vec(x[i], y[i], z[i]);
}

static GiShading gi_stage_shading(const GiStage *stage, int point) {
    const GiTileScratch *scratch = stage->scratch;
    const GiPoints *points = &scratch->points;
    const GiShader *shader = &stage->world->scene->shaders.data[scratch->spots[point].shader];
    return (GiShading){
        .scene = stage->world->scene,
        .rules = stage->world->rules,
        .shader = shader,
        .normal = vec_at(points->nx, points->ny, points->nz, point),
        .toward_viewer = vec_at(points->vx, points->vy, points->vz, point),
        .diffuse = shader->texture == GI_NONE ? shader->diffuse : scratch->diffuse[point],
    };
}

/* Whether the kernels know the shader's formula; *gloss is then made ready for them. */
static bool gloss_of(const GiRules *rules, const GiShader *shader, GiGloss *gloss) {
    bool phong = shader->type == GLINT_SHADER_PHONG;
    if (!phong && shader->type != GLINT_SHADER_LAMBERTIAN) return false;
    if (shader->texture != GI_NONE) return false;
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

/* The same as the kernels' light, for any shader. */
static void light_segment(const GiStage *stage, const GiLight *light, const GiSegment *segment) {
    GiTileScratch *scratch = stage->scratch;
    const GiRules *rules = stage->world->rules;
    const GiPoints *points = &scratch->points;
    GiLit *lit = &scratch->lit;
    for (int i = segment->begin; i < segment->end; i++) {
        GiVec d = gi_sub(light->position, vec_at(points->px, points->py, points->pz, i));
        double square = gi_dot(d, d);
        if (!(square > 0)) continue; /* the light is on the surface */
        double inverse = 1 / sqrt(square);
        GiVec l = gi_scale(d, inverse);
        GiShading at = gi_stage_shading(stage, i);
        GiVec adds = gi_multiply(gi_shade_light(light, rules, square),
            gi_shade_reflect(at.shader, rules, at.normal, at.toward_viewer, l));
        if (gi_vec_is_zero(adds)) continue;
        double away = rules->shadow_distance > 0 ? rules->shadow_distance : points->error[i];
        int k = lit->count++;
        lit->point[k] = (uint32_t)i;
        lit->red[k] = adds.x, lit->green[k] = adds.y, lit->blue[k] = adds.z;
        lit->t_min[k] = away * inverse;
        lit->x[k] = (float)l.x, lit->y[k] = (float)l.y, lit->z[k] = (float)l.z;
    }
}

/* Traces the shadow rays, in an order of the kernels' liking. */
static void trace_lit(const GiStage *stage, GiVec light) {
    GiTileScratch *scratch = stage->scratch;
    GiBundle *bundle = &scratch->bundle;
    const GiPoints *points = &scratch->points;
    const GiLit *lit = &scratch->lit;
    stage->world->kernel->regroup(&scratch->regroup, lit->x, lit->y, lit->z, lit->count);
    for (int begin = 0; begin < lit->count; begin += GI_BUNDLE_SIZE) {
        if (gi_stage_stopped(stage)) return;
        const uint16_t *order = scratch->regroup.order + begin;
        bundle->count = lit->count - begin < GI_BUNDLE_SIZE ? lit->count - begin : GI_BUNDLE_SIZE;
        bundle->apex = light;
        bundle->side = gi_vec(0, 0, 0);
        for (int i = 0; i < bundle->count; i++) {
            uint32_t point = lit->point[order[i]];
            double x = points->px[point], y = points->py[point], z = points->pz[point];
            bundle->ox[i] = x;
            bundle->oy[i] = y;
            bundle->oz[i] = z;
            bundle->dx[i] = light.x - x;
            bundle->dy[i] = light.y - y;
            bundle->dz[i] = light.z - z;
            bundle->t_min[i] = lit->t_min[order[i]];
            bundle->t_max[i] = 1;
            bundle->skip[i] = scratch->spots[point].skip;
            bundle->skip_instance[i] = scratch->spots[point].skip_instance;
        }
        stage->world->kernel->bundle_any(&stage->world->trace, bundle);
        for (int i = 0; i < bundle->count; i++) {
            scratch->arrives[order[i]] = bundle->shape[i] == GI_SHAPE_NONE;
        }
    }
}

static void add_lit(const GiStage *stage) {
    GiTileScratch *scratch = stage->scratch;
    const GiLit *lit = &scratch->lit;
    for (int k = 0; k < lit->count; k++) {
        if (!scratch->arrives[k]) continue;
        uint32_t point = lit->point[k];
        GiVec adds = {lit->red[k], lit->green[k], lit->blue[k]};
        if (scratch->weighted) adds = gi_multiply(scratch->factors[point], adds);
        GiVec *color = &scratch->color[scratch->spots[point].pixel];
        *color = gi_add(*color, adds);
    }
}

static void add_point_light(const GiStage *stage, const GiLight *light) {
    GiTileScratch *scratch = stage->scratch;
    const GiWorld *world = stage->world;
    const GiPointLight point = {
        light->position, light->intensity, gi_shade_light_falls(light, world->rules)};
    scratch->lit.count = 0;
    for (int i = 0; i < scratch->segment_count; i++) {
        const GiSegment *segment = &scratch->segments[i];
        GiGloss gloss;
        if (gloss_of(world->rules, &world->scene->shaders.data[segment->shader], &gloss)) {
            world->kernel->light(
                &scratch->points, segment->begin, segment->end, &point, &gloss, &scratch->lit);
        } else {
            light_segment(stage, light, segment);
        }
    }
    if (scratch->lit.count == 0) return;
    trace_lit(stage, light->position);
    stage->counts->shadow_rays += (uint64_t)scratch->lit.count;
    if (!gi_stage_stopped(stage)) add_lit(stage);
}

/* ---------------------------------------------------------------- all lights */

static void add_ambient(const GiStage *stage, const GiLight *light) {
    GiTileScratch *scratch = stage->scratch;
    for (int i = 0; i < scratch->point_count; i++) {
        GiShading at = gi_stage_shading(stage, i);
        GiVec adds = gi_shade_ambient(at.shader, light, at.normal);
        if (scratch->weighted) adds = gi_multiply(scratch->factors[i], adds);
        GiVec *color = &scratch->color[scratch->spots[i].pixel];
        *color = gi_add(*color, adds);
    }
}

void gi_lights_add(const GiStage *stage) {
    const GiScene *scene = stage->world->scene;
    for (size_t i = 0; i < scene->lights.count && !gi_stage_stopped(stage); i++) {
        const GiLight *light = &scene->lights.data[i];
        if (light->type == GLINT_LIGHT_POINT) {
            add_point_light(stage, light);
        } else {
            add_ambient(stage, light);
        }
    }
    stage->scratch->point_count = stage->scratch->segment_count = 0;
}
