/* SPDX-License-Identifier: MIT
 * One ray through the middle of each pixel, by itself; cost draws each pixel by itself. Nothing
 * here is in a hurry: it is for pictures that somebody looks at to understand another one. */
#include "render/show.h"

#include "kernel/counting.h"
#include "render/paint.h"
#include "render/tile.h"
#include "sample/sampler.h"
#include "shade/shade.h"

#include <string.h>

enum { RUN = 64 }; /* pixels that a worker claims at a time */

typedef struct Showing {
    const GiWorld *world;
    const GiRenderArea *area;
    const GlintMonitor *monitor;
    GiShow *show;
    float *values;           /* of DEPTH and COST: a number a pixel, below 0 where there is none */
    const GiWorld *counting; /* of COST: the world with a kernel that counts */
    GiTileScratch **scratch; /* of COST: one a worker */
    GiRenderCounts *counts;  /* one a worker */
    size_t run_count;
    _Atomic size_t next, done;
    _Atomic bool stop;
} Showing;

/* What a camera ray met. */
typedef struct Seen {
    GiVec origin, direction;
    GiTraceHit hit;
    GiSurfacePoint at;
    bool is_light;
} Seen;

/* ---------------------------------------------------------------- what a ray met */

/* Where nothing is. */
static GiVec nowhere(void) { return gi_paint_shown(0.08, 0.08, 0.2); }

static bool has_texcoords(const GiWorld *world, const GiTraceHit *hit) {
    GiShapeRef own = gi_shape_unplaced(&world->shapes, hit->shape);
    if (gi_shape_kind(own) == GI_SHAPE_SPHERE) return true;
    if (gi_shape_kind(own) != GI_SHAPE_TRIANGLE) return false;
    return world->shapes.meshes[gi_shape_mesh(&world->shapes, gi_shape_index(own))].textured;
}

/* Coordinates run on where a texture is repeated, so their whole part is left out. */
static GiVec texcoord_color(const GiWorld *world, const Seen *seen) {
    double uv[2];
    if (seen->is_light || !has_texcoords(world, &seen->hit)) return gi_paint_shown(0, 0, 0.5);
    gi_shape_texcoord(&world->shapes, seen->hit.shape, seen->hit.instance, seen->at.point, uv);
    for (int i = 0; i < 2; i++) {
        if (uv[i] < 0 || uv[i] > 1) uv[i] -= floor(uv[i]);
    }
    return gi_paint_shown(uv[0], uv[1], 0);
}

static GiVec number_color(const GiWorld *world, const Seen *seen) {
    if (seen->is_light) return gi_vec(1, 1, 1);
    const GiShapeInfo *info = gi_shape_info(&world->shapes, seen->hit.shape, seen->hit.instance);
    return gi_paint_number(info->order + 1);
}

/* ---------------------------------------------------------------- shadows */

/* Whether nothing stands between the point and a place, or a direction when t_max is infinite. d is
 * as long as 1 / per_length tells. The ray is that of render/lights.c. */
static bool is_free(
    const GiWorld *world, const Seen *seen, GiVec d, double per_length, double t_max) {
    double distance = world->rules->shadow_distance;
    if (gi_dot(seen->at.normal, d) <= 0) return false;
    GiTraceRay ray = {seen->at.point, d, (distance > 0 ? distance : seen->at.error) * per_length,
        t_max, gi_world_skip(world, seen->hit.shape), seen->hit.instance};
    return !world->kernel->any(&world->trace, &ray);
}

/* The part of a rectangle that is seen. */
static double free_part(
    const GiWorld *world, const Seen *seen, size_t light, uint32_t x, uint32_t y) {
    enum { SAMPLES = 16 };
    int free_count = 0;
    for (uint32_t sample = 0; sample < SAMPLES; sample++) {
        GiSampler sampler = gi_sampler(x, y, sample);
        double u[2];
        GiVec to;
        gi_sample_2d(&sampler, light, u);
        double factor =
            gi_rectangle_sample_angle(&world->lights.data[light], seen->at.point, u, &to);
        if (!(factor > 0)) continue;
        GiVec offset = gi_sub(to, seen->at.point);
        double length = gi_length(offset);
        double t_max = length - (gi_largest(to) + length) * GI_SURFACE_ERROR;
        free_count += is_free(world, seen, gi_scale(offset, 1 / length), 1, t_max);
    }
    return (double)free_count / SAMPLES;
}

/* The part of the lights that the point sees; without any lights all of it. */
static double light_part(const GiWorld *world, const Seen *seen, uint32_t x, uint32_t y) {
    const GiScene *scene = world->scene;
    double free_lights = 0;
    int count = 0;
    for (size_t i = 0; i < scene->lights.count; i++) {
        const GiLight *light = &scene->lights.data[i];
        GiVec d = gi_sub(light->position, seen->at.point);
        switch (light->type) {
        case GLINT_LIGHT_POINT:
            free_lights += is_free(world, seen, d, 1 / gi_length(d), 1);
            count++;
            break;
        case GLINT_LIGHT_DIRECTIONAL:
            free_lights += is_free(world, seen, gi_normalize(light->direction), 1, INFINITY);
            count++;
            break;
        case GLINT_LIGHT_RECTANGLE:
            free_lights += free_part(world, seen, i, x, y);
            count++;
            break;
        default: break; /* it has no place, and no shadow */
        }
    }
    return count > 0 ? free_lights / count : 1;
}

/* ---------------------------------------------------------------- pixels */

static bool look(const Showing *showing, uint32_t x, uint32_t y, Seen *seen) {
    const GiWorld *world = showing->world;
    const GiRenderArea *area = showing->area;
    const GiView *view = showing->show->view;
    double a = (x + 0.5) / area->width;
    double b = ((double)area->height - 1 - y + 0.5) / area->height;
    gi_view_ray(view, a, b, &seen->origin, &seen->direction);
    GiTraceRay ray = {seen->origin, seen->direction, gi_world_eye_error(world, view->eye), INFINITY,
        GI_SHAPE_NONE, GI_SHAPE_NONE};
    if (!world->kernel->closest(&world->trace, &ray, &seen->hit)) return false;
    seen->at = gi_shape_point(&world->shapes, seen->hit.shape, seen->hit.instance, seen->origin,
        seen->direction, seen->hit.t, world->rules->cone_geometric);
    seen->is_light = gi_shape_kind(seen->hit.shape) == GI_SHAPE_RECTANGLE;
    return true;
}

static GiVec color_of(const Showing *showing, const Seen *seen, uint32_t x, uint32_t y) {
    const GiWorld *world = showing->world;
    switch (showing->show->what) {
    case GLINT_SHOW_NORMAL: return gi_shade_normal_color(seen->at.normal);
    case GLINT_SHOW_UV: return texcoord_color(world, seen);
    case GLINT_SHOW_ID: return number_color(world, seen);
    default: {
        double part = seen->is_light ? 1 : light_part(world, seen, x, y);
        return gi_paint_shown(part, part, part);
    }
    }
}

/* What drawing the pixel takes, alone. False: memory, or stopped. */
static bool cost_of(Showing *showing, uint32_t x, uint32_t y, int worker, float *value) {
    const GiRenderTarget target = {.samples = showing->show->samples, .view = showing->show->view};
    const GiRenderArea area = {.width = showing->area->width,
        .height = showing->area->height,
        .x = (int)x,
        .y = (int)y,
        .crop_width = 1,
        .crop_height = 1};
    const GiTileControl control = {&showing->stop, NULL, worker};
    gi_counting_take();
    bool drawn = gi_tile_draw(showing->counting, &area, 0, 0, (GiTileSize){1, 1}, &target,
        showing->scratch[worker], &showing->counts[worker], &control);
    *value = (float)gi_counting_take();
    return drawn;
}

static bool show_pixel(Showing *showing, size_t pixel, int worker) {
    const GiRenderArea *area = showing->area;
    size_t width = (size_t)area->crop_width;
    uint32_t x = (uint32_t)area->x + (uint32_t)(pixel % width);
    uint32_t y = (uint32_t)area->y + (uint32_t)(pixel / width);
    if (showing->show->what == GLINT_SHOW_COST) {
        return cost_of(showing, x, y, worker, &showing->values[pixel]);
    }
    Seen seen;
    bool any = look(showing, x, y, &seen);
    showing->counts[worker].camera_rays++;
    if (showing->values != NULL) {
        showing->values[pixel] = any ? (float)seen.hit.t : -1;
        return true;
    }
    GiVec color = any ? color_of(showing, &seen, x, y) : nowhere();
    float *to = showing->show->color + 3 * pixel;
    to[0] = (float)color.x, to[1] = (float)color.y, to[2] = (float)color.z;
    return true;
}

/* ---------------------------------------------------------------- runs of pixels */

/* On the caller's thread only. */
static void report(Showing *showing) {
    const GlintMonitor *monitor = showing->monitor;
    if (monitor == NULL) return;
    if (monitor->progress != NULL) {
        monitor->progress(monitor->user, GLINT_PHASE_TRACE,
            (double)atomic_load(&showing->done) / (double)showing->run_count);
    }
    if (monitor->cancelled != NULL && monitor->cancelled(monitor->user)) {
        atomic_store(&showing->stop, true);
    }
}

static void show_runs(void *context, size_t begin, size_t end, int worker) {
    (void)begin;
    (void)end;
    Showing *showing = context;
    size_t pixels = (size_t)showing->area->crop_width * (size_t)showing->area->crop_height;
    for (;;) {
        size_t run = atomic_fetch_add(&showing->next, 1);
        if (run >= showing->run_count) return;
        for (size_t i = run * RUN; i < (run + 1) * RUN && i < pixels; i++) {
            if (atomic_load(&showing->stop) || !show_pixel(showing, i, worker)) return;
        }
        atomic_fetch_add(&showing->done, 1);
        if (worker == 0) report(showing);
    }
}

/* ---------------------------------------------------------------- ranges */

/* The value that is at a place of the list once it is sorted; -1 for an empty list. Values below 0
 * are not in it. Floats from 0 on are in the order of their bits, so that these are counted, first
 * the upper half and then the lower one. */
static bool value_at(
    GiMemory *memory, const float *values, size_t count, double part, double *value) {
    enum { HALF = 1 << 16 };
    size_t *counts = gi_memory_allocate(memory, HALF * sizeof *counts);
    if (counts == NULL) return false;
    size_t total = 0;
    for (size_t i = 0; i < count; i++) total += values[i] >= 0;
    size_t rank = total > 0 ? (size_t)(part * (double)(total - 1)) : 0;
    uint32_t found = 0;
    *value = -1;
    for (int pass = 0; pass < 2 && total > 0; pass++) {
        memset(counts, 0, HALF * sizeof *counts);
        for (size_t i = 0; i < count; i++) {
            uint32_t bits;
            if (!(values[i] >= 0)) continue;
            memcpy(&bits, &values[i], sizeof bits);
            if (pass == 1 && bits >> 16 != found >> 16) continue;
            counts[pass == 0 ? bits >> 16 : bits & 0xffff]++;
        }
        uint32_t bucket = 0;
        while (rank >= counts[bucket]) rank -= counts[bucket++];
        found = pass == 0 ? bucket << 16 : found | bucket;
    }
    float result;
    memcpy(&result, &found, sizeof result);
    if (total > 0) *value = (double)result;
    gi_memory_free(memory, counts, HALF * sizeof *counts);
    return true;
}

/* From the nearest to the farthest; but a plane that runs to the horizon must not make all else
 * white, so that nothing beyond eight times the median counts. */
static bool paint_depth(Showing *showing, GiMemory *memory, size_t count) {
    GiShow *show = showing->show;
    double middle;
    if (!value_at(memory, showing->values, count, 0, &show->range[0]) ||
        !value_at(memory, showing->values, count, 1, &show->range[1]) ||
        !value_at(memory, showing->values, count, 0.5, &middle)) {
        return false;
    }
    if (show->range[1] > 8 * middle) show->range[1] = 8 * middle;
    if (middle < 0) show->range[0] = show->range[1] = 0;
    double span = show->range[1] - show->range[0];
    for (size_t i = 0; i < count; i++) {
        double value = (double)showing->values[i];
        double white = span > 0 ? 1 - (value - show->range[0]) / span : 1;
        GiVec color = value < 0 ? nowhere() : gi_paint_shown(white, white, white);
        float *to = show->color + 3 * i;
        to[0] = (float)color.x, to[1] = (float)color.y, to[2] = (float)color.z;
    }
    return true;
}

/* Two digits that count, not below the number. */
static double round_up(double number) {
    double step = 1;
    while (number > 100 * step) step *= 10;
    return ceil(number / step) * step;
}

/* A few pixels may cost many times what the others do: of two hundred one is beyond the scale. */
static bool paint_cost(Showing *showing, GiMemory *memory, size_t count) {
    GiShow *show = showing->show;
    if (!value_at(memory, showing->values, count, 0.995, &show->range[1])) return false;
    show->range[1] = round_up(show->range[1] > 2 ? show->range[1] : 2);
    for (size_t i = 0; i < count; i++) {
        GiVec color = gi_paint_heat((double)showing->values[i] / show->range[1]);
        float *to = show->color + 3 * i;
        to[0] = (float)color.x, to[1] = (float)color.y, to[2] = (float)color.z;
    }
    gi_paint_legend(
        show->color, showing->area->crop_width, showing->area->crop_height, show->range[1]);
    return true;
}

/* ---------------------------------------------------------------- the whole */

static bool allocate(Showing *showing, GiMemory *memory, size_t workers, size_t pixels) {
    const GlintShow what = showing->show->what;
    const GiRenderTarget target = {.samples = 1};
    showing->counts = gi_memory_allocate(memory, workers * sizeof *showing->counts);
    if (showing->counts == NULL) return false;
    memset(showing->counts, 0, workers * sizeof *showing->counts);
    if (what != GLINT_SHOW_DEPTH && what != GLINT_SHOW_COST) return true;
    showing->values = gi_memory_allocate(memory, pixels * sizeof *showing->values);
    if (showing->values == NULL || what == GLINT_SHOW_DEPTH) return showing->values != NULL;
    showing->scratch = gi_memory_allocate(memory, workers * sizeof *showing->scratch);
    if (showing->scratch == NULL) return false;
    memset(showing->scratch, 0, workers * sizeof *showing->scratch);
    for (size_t i = 0; i < workers; i++) {
        showing->scratch[i] = gi_tile_scratch_create(showing->world, &target);
        if (showing->scratch[i] == NULL) return false;
    }
    return true;
}

static void release(Showing *showing, GiMemory *memory, size_t workers, size_t pixels) {
    for (size_t i = 0; showing->scratch != NULL && i < workers; i++) {
        gi_tile_scratch_destroy(memory, showing->scratch[i]);
    }
    gi_memory_free(memory, showing->scratch, workers * sizeof *showing->scratch);
    gi_memory_free(memory, showing->values, pixels * sizeof *showing->values);
    gi_memory_free(memory, showing->counts, workers * sizeof *showing->counts);
}

static GlintStatus run(Showing *showing, GiPool *pool, GiMemory *memory, size_t pixels) {
    size_t workers = (size_t)gi_pool_worker_count(pool);
    report(showing);
    gi_parallel_for(pool, workers, 1, show_runs, showing);
    report(showing);
    for (size_t i = 0; showing->scratch != NULL && i < workers; i++) {
        if (gi_tile_out_of_memory(showing->scratch[i])) return GLINT_ERROR_MEMORY;
    }
    if (atomic_load(&showing->done) < showing->run_count) return GLINT_CANCELLED;
    GlintShow what = showing->show->what;
    bool good = what == GLINT_SHOW_DEPTH  ? paint_depth(showing, memory, pixels)
                : what == GLINT_SHOW_COST ? paint_cost(showing, memory, pixels)
                                          : true;
    return good ? GLINT_OK : GLINT_ERROR_MEMORY;
}

GlintStatus gi_show(const GiWorld *world, GiPool *pool, const GiRenderArea *area,
    const GlintMonitor *monitor, GiShow *show, GiRenderCounts *counts) {
    GiMemory *memory = world->scene->memory;
    size_t workers = (size_t)gi_pool_worker_count(pool);
    size_t pixels = (size_t)area->crop_width * (size_t)area->crop_height;
    GiKernel kernel = gi_counting_kernel(world->kernel);
    GiWorld counting = *world;
    counting.kernel = &kernel;
    Showing showing = {.world = world,
        .area = area,
        .monitor = monitor,
        .show = show,
        .counting = &counting,
        .run_count = (pixels + RUN - 1) / RUN};
    show->range[0] = show->range[1] = 0;
    *counts = (GiRenderCounts){0};
    GlintStatus status = allocate(&showing, memory, workers, pixels)
                             ? run(&showing, pool, memory, pixels)
                             : GLINT_ERROR_MEMORY;
    for (size_t i = 0; showing.counts != NULL && i < workers; i++) {
        counts->camera_rays += showing.counts[i].camera_rays;
        counts->shadow_rays += showing.counts[i].shadow_rays;
        counts->other_rays += showing.counts[i].other_rays;
    }
    release(&showing, memory, workers, pixels);
    return status;
}
