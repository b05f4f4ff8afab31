/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L
#include "rays_glint.h"

#include "message.h"
#include "render/stage.h"

#include <stdlib.h>
#include <time.h>

struct GlintTracer {
    const GiWorld *world;
    _Atomic bool stop; /* never */
    GiTileControl control;
    GiRenderCounts counts;
    GiRenderTarget target;
    float depth; /* of no pixel: who asks for depths has t worked out, as the other tracer does */
    GiStage stage;
};

double rays_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

GlintTracer *glint_tracer_create(const GiWorld *world) {
    GlintTracer *tracer = rays_allocate(1, sizeof *tracer);
    tracer->world = world;
    tracer->control.stop = &tracer->stop;
    tracer->target.samples = 1;
    tracer->target.depth = &tracer->depth;
    GiTileScratch *scratch = gi_tile_scratch_create(world, &tracer->target);
    if (scratch == NULL) message_fail("not enough memory");
    scratch->bundle.stop = NULL;
    tracer->stage = (GiStage){
        world, &tracer->control, scratch, &tracer->counts, &tracer->target, NULL, 0, 0, 0};
    return tracer;
}

void glint_tracer_destroy(GlintTracer *tracer) {
    gi_tile_scratch_destroy(tracer->world->scene->memory, tracer->stage.scratch);
    free(tracer);
}

static int least(int a, int b) { return a < b ? a : b; }

static size_t trace_tile(const GiStage *stage, const GiRenderArea *area, int x, int y) {
    const GiBundle *bundle = &stage->scratch->bundle;
    const GiTileExtent extent = {
        x, y, least(area->width - x, GI_TILE_STRIDE), least(area->height - y, GI_TILE_STRIDE)};
    size_t hit_count = 0;
    gi_tile_aim(stage, area, &extent, 0.5, 0.5);
    for (int row = 0; row < extent.height; row += GI_BLOCK_HEIGHT) {
        for (int column = 0; column < extent.width; column += GI_BLOCK_WIDTH) {
            int count = gi_tile_trace_block(stage, &extent, column, row);
            for (int i = 0; i < count; i++) hit_count += bundle->shape[i] != GI_SHAPE_NONE;
        }
    }
    return hit_count;
}

static RayPass trace_camera(const GiStage *stage) {
    const GiScene *scene = stage->world->scene;
    const GiRenderArea area = {scene->width, scene->height, 0, 0, scene->width, scene->height};
    RayPass pass = {0, 0};
    double start = rays_seconds();
    for (int y = 0; y < area.height; y += GI_TILE_STRIDE) {
        for (int x = 0; x < area.width; x += GI_TILE_STRIDE) {
            pass.hit_count += trace_tile(stage, &area, x, y);
        }
    }
    pass.seconds = rays_seconds() - start;
    return pass;
}

/* Sets out the points of a part where the stages before have them. */
static void load_part(GiTileScratch *scratch, const RaySet *set, const RayPart *part) {
    GiPoints *points = &scratch->points;
    GiLit *lit = &scratch->lit;
    lit->count = points->count = part->count;
    scratch->shared = false;
    for (int i = 0; i < part->count; i++) {
        const GiTraceRay *ray = &set->rays[part->first + (size_t)i];
        points->px[i] = ray->origin.x, points->py[i] = ray->origin.y, points->pz[i] = ray->origin.z;
        GiVec toward = gi_normalize(ray->direction);
        lit->point[i] = (uint32_t)i;
        lit->t_min[i] = ray->t_min;
        lit->arrives[i] = 0;
        lit->x[i] = (float)toward.x, lit->y[i] = (float)toward.y, lit->z[i] = (float)toward.z;
        lit->skip[i] = ray->skip;
        points->skip_instance[i] = ray->skip_instance;
    }
}

static RayPass trace_shadow(const GiStage *stage, const RaySet *set) {
    GiTileScratch *scratch = stage->scratch;
    RayPass pass = {0, 0};
    for (size_t i = 0; i < set->part_count; i++) {
        load_part(scratch, set, &set->parts[i]);
        double start = rays_seconds();
        gi_lights_trace(stage, set->parts[i].light, false);
        for (int k = 0; k < scratch->lit.count; k++) pass.hit_count += scratch->lit.arrives[k] == 0;
        pass.seconds += rays_seconds() - start;
    }
    return pass;
}

static RayPass trace_many(const GiWorld *world, const RaySet *set) {
    enum { TOGETHER = 1024 };
    GiTraceHit hits[TOGETHER];
    RayPass pass = {0, 0};
    double start = rays_seconds();
    for (size_t begin = 0; begin < set->count; begin += TOGETHER) {
        int count = set->count - begin < TOGETHER ? (int)(set->count - begin) : TOGETHER;
        world->kernel->many_closest(&world->trace, set->rays + begin, count, hits);
        for (int i = 0; i < count; i++) pass.hit_count += hits[i].shape.bits != GI_SHAPE_NONE;
    }
    pass.seconds = rays_seconds() - start;
    return pass;
}

RayPass glint_trace_together(GlintTracer *tracer, const RaySet *set) {
    switch (set->kind) {
    case RAYS_CAMERA: return trace_camera(&tracer->stage);
    case RAYS_SHADOW: return trace_shadow(&tracer->stage, set);
    default: return trace_many(tracer->world, set);
    }
}

RayPass glint_trace_single(const GlintTracer *tracer, const RaySet *set) {
    const GiTrace *trace = &tracer->world->trace;
    const GiKernel *kernel = tracer->world->kernel;
    RayPass pass = {0, 0};
    double start = rays_seconds();
    for (size_t i = 0; i < set->count; i++) {
        GiTraceHit hit;
        pass.hit_count += set->kind == RAYS_SHADOW ? kernel->any(trace, &set->rays[i])
                                                   : kernel->closest(trace, &set->rays[i], &hit);
    }
    pass.seconds = rays_seconds() - start;
    return pass;
}
