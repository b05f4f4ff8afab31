/* SPDX-License-Identifier: MIT */
#include "render/record.h"

#include <string.h>

enum {
    PACKET_SIDE = 4, /* a packet: 4 x 4 */
    STRIDE = GI_TILE_STRIDE
};

#define SEEN_SIZE (GI_TILE_PIXELS * sizeof(GiSeen))

GiTileScratch *gi_tile_scratch_create(const GiWorld *world, const GiRenderTarget *target) {
    GiMemory *memory = world->scene->memory;
    GiTileScratch *scratch = gi_memory_allocate_lines(memory, 1, sizeof *scratch);
    if (scratch == NULL) return NULL;
    bool sees = target->depth != NULL || target->normal != NULL || target->albedo != NULL ||
                target->surface != NULL;
    memset(&scratch->flights, 0, sizeof scratch->flights);
    memset(&scratch->ranges, 0, sizeof scratch->ranges);
    scratch->points.count = scratch->segment_count = 0;
    scratch->weighted = scratch->out_of_memory = false;
    scratch->seen = sees ? gi_memory_allocate(memory, SEEN_SIZE) : NULL;
    if (sees && scratch->seen == NULL) {
        gi_tile_scratch_destroy(memory, scratch);
        return NULL;
    }
    return scratch;
}

void gi_tile_scratch_destroy(GiMemory *memory, GiTileScratch *scratch) {
    if (scratch == NULL) return;
    gi_array_free(memory, &scratch->flights);
    gi_array_free(memory, &scratch->ranges);
    gi_memory_free(memory, scratch->seen, SEEN_SIZE);
    gi_memory_free_lines(memory, scratch, 1, sizeof *scratch);
}

bool gi_tile_out_of_memory(const GiTileScratch *scratch) { return scratch->out_of_memory; }

static bool stopped(const GiTileControl *control) {
    const GlintMonitor *monitor = control->monitor;
    if (monitor != NULL && monitor->cancelled != NULL && monitor->cancelled(monitor->user)) {
        atomic_store(control->stop, true);
    }
    return atomic_load_explicit(control->stop, memory_order_relaxed);
}

bool gi_stage_stopped(const GiStage *stage) { return stopped(stage->control); }

/* The same for the kernels. */
static bool ask(const void *control) { return stopped(control); }

/* ---------------------------------------------------------------- camera rays */

/* The rays of a parallel camera have no point in common. */
static void trace_apart(const GiStage *stage) {
    const GiWorld *world = stage->world;
    GiBundle *bundle = &stage->scratch->bundle;
    GiTraceRay rays[GI_BUNDLE_SIZE];
    GiTraceHit hits[GI_BUNDLE_SIZE];
    for (int i = 0; i < bundle->count; i++) {
        rays[i] = (GiTraceRay){gi_bundle_origin(bundle, i), gi_bundle_direction(bundle, i),
            bundle->start, INFINITY, GI_SHAPE_NONE, GI_SHAPE_NONE};
    }
    world->kernel->many_closest(&world->trace, rays, bundle->count, hits);
    for (int i = 0; i < bundle->count; i++) {
        bundle->shape[i] = hits[i].shape.bits;
        bundle->t[i] = hits[i].t;
        bundle->instance[i] = hits[i].instance;
    }
}

/* What a program sees that does not look for the nearest of all surfaces: of those on the ray, each
 * where it is met first, the first or the last of the file. The rays go from hit to hit. */
static void trace_listed(const GiStage *stage) {
    enum { HIT_LIMIT = 1000 };
    const GiWorld *world = stage->world;
    GiBundle *bundle = &stage->scratch->bundle;
    bool last = world->rules->hit == GI_HIT_LAST;
    for (int i = 0; i < bundle->count; i++) {
        GiTraceRay ray = {gi_bundle_origin(bundle, i), gi_bundle_direction(bundle, i),
            bundle->start, INFINITY, GI_SHAPE_NONE, GI_SHAPE_NONE};
        GiTraceHit hit;
        uint32_t best = 0;
        bundle->shape[i] = GI_SHAPE_NONE;
        for (int k = 0; k < HIT_LIMIT && world->kernel->closest(&world->trace, &ray, &hit); k++) {
            uint32_t order = gi_shape_info(&world->shapes, hit.shape, hit.instance)->order;
            if (k == 0 || (last ? order > best : order < best)) {
                best = order;
                bundle->shape[i] = hit.shape.bits;
                bundle->t[i] = hit.t;
                bundle->instance[i] = hit.instance;
            }
            ray.t_min = hit.t;
        }
    }
}

void gi_tile_aim(const GiStage *stage, const GiRenderArea *area, const GiTileExtent *extent,
    double offset_x, double offset_y) {
    GiTileScratch *scratch = stage->scratch;
    for (int x = 0; x < extent->width; x++) {
        scratch->across[x] = (extent->x + x + offset_x) / area->width;
    }
    for (int y = 0; y < extent->height; y++) {
        /* Rows of the picture run down, the window's coordinate runs up. */
        scratch->up[y] = (area->height - 1 - (extent->y + y) + offset_y) / area->height;
    }
}

static inline int minimum(int a, int b) { return a < b ? a : b; }

/* Fills the bundle with the rays of a block's pixels, packet by packet. */
static void set_rays(const GiStage *stage, const GiTileExtent *extent, int block_x, int block_y) {
    const GiWorld *world = stage->world;
    const GiView *view = gi_stage_view(stage);
    GiTileScratch *scratch = stage->scratch;
    GiBundle *bundle = &scratch->bundle;
    const int across = GI_BLOCK_WIDTH / PACKET_SIDE;
    int count = 0;
    for (int packet = 0; packet < GI_PACKET_COUNT; packet++) {
        int packet_x = block_x + packet % across * PACKET_SIDE;
        int packet_y = block_y + packet / across * PACKET_SIDE;
        int end_x = minimum(packet_x + PACKET_SIDE, extent->width);
        int end_y = minimum(packet_y + PACKET_SIDE, extent->height);
        for (int y = packet_y; y < end_y; y++) {
            uint32_t pixel = (uint32_t)(y * STRIDE + packet_x);
            /* A row is written as a whole, and what is too much of it is overwritten. */
            for (int x = 0; x < PACKET_SIDE; x++) {
                scratch->a[count + x] = scratch->across[packet_x + x];
                scratch->b[count + x] = scratch->up[y];
                bundle->pixel[count + x] = pixel + (uint32_t)x;
            }
            count += end_x > packet_x ? end_x - packet_x : 0;
        }
    }
    bundle->count = count;
    bundle->apex = view->eye;
    bundle->own = view->parallel;
    bundle->side = view->across;
    /* The point on a triangle does not depend on t (shape.c), but depths do. */
    bundle->without_t = scratch->seen == NULL && !gi_stage_records(stage);
    world->kernel->view(view, scratch->a, scratch->b, bundle);
    bundle->start = gi_world_eye_error(world, view->eye);
    for (int i = 0; i < count; i++) bundle->t[i] = INFINITY;
}

int gi_tile_trace_block(
    const GiStage *stage, const GiTileExtent *extent, int block_x, int block_y) {
    const GiWorld *world = stage->world;
    GiBundle *bundle = &stage->scratch->bundle;
    if (gi_stage_stopped(stage)) return 0;
    set_rays(stage, extent, block_x, block_y);
    if (world->rules->hit != GI_HIT_NEAREST) {
        trace_listed(stage);
    } else if (gi_stage_view(stage)->parallel) {
        trace_apart(stage);
    } else {
        world->kernel->bundle_closest(&world->trace, bundle);
    }
    return bundle->count;
}

/* ---------------------------------------------------------------- the tile */

/* One of the n x n samples of every pixel. */
static void draw_sample(const GiStage *stage, const GiRenderArea *area, const GiTileExtent *extent,
    double offset_x, double offset_y) {
    GiTileScratch *scratch = stage->scratch;
    scratch->points.count = scratch->segment_count = 0;
    scratch->weighted = scratch->shared = false;
    gi_tile_aim(stage, area, extent, offset_x, offset_y);
    for (int y = 0; y < extent->height; y += GI_BLOCK_HEIGHT) {
        for (int x = 0; x < extent->width; x += GI_BLOCK_WIDTH) {
            if (gi_tile_trace_block(stage, extent, x, y) == 0) return;
            gi_surface_bundle(stage);
        }
    }
    stage->counts->camera_rays += (uint64_t)extent->width * (uint64_t)extent->height;
    gi_lights_add(stage);
    gi_flight_follow(stage);
}

static void store_vec(float *to, GiVec v) {
    to[0] = (float)v.x;
    to[1] = (float)v.y;
    to[2] = (float)v.z;
}

static void store_seen(
    const GiSeen *seen, int width, int samples, size_t at, const GiRenderTarget *target) {
    double part = 1.0 / samples;
    for (int i = 0; i < width; i++, seen++, at++) {
        double depth = seen->count > 0 ? seen->depth / seen->count : 0;
        if (target->depth != NULL) target->depth[at] = (float)depth;
        if (target->normal != NULL)
            store_vec(target->normal + 3 * at, gi_scale(seen->normal, part));
        if (target->albedo != NULL)
            store_vec(target->albedo + 3 * at, gi_scale(seen->albedo, part));
        if (target->surface != NULL) target->surface[at] = seen->surface;
    }
}

/* The samples of a pixel are a grid of so many rows and columns. */
static int grid_of(int samples) {
    int n = (int)floor(sqrt((double)samples) + 0.5);
    return n > 1 ? n : 1;
}

static void add_sample(const GiTileExtent *extent, GiTileScratch *scratch, bool first) {
    for (int row = 0; row < extent->height; row++) {
        for (int i = row * STRIDE; i < row * STRIDE + extent->width; i++) {
            scratch->sum[i] =
                first ? scratch->color[i] : gi_add(scratch->sum[i], scratch->color[i]);
        }
    }
}

/* The tile's pixels to where they are wanted; x and y as for gi_tile_draw. False: no memory. */
static bool store(const GiStage *stage, const GiRenderArea *area, const GiTileExtent *extent, int x,
    int y, int count) {
    const GiTileScratch *scratch = stage->scratch;
    const GiRenderTarget *target = stage->target;
    const GiScene *scene = stage->world->scene;
    double exposure = scene->exposure > 0 ? scene->exposure : 1;
    /* One sample is its own sum. */
    const GiVec *sum = count > 1 ? scratch->sum : scratch->color;
    for (int row = 0; row < extent->height; row++) {
        size_t at = (size_t)(y + row) * (size_t)area->crop_width + (size_t)x;
        float own[3 * STRIDE], *color = target->color != NULL ? target->color + 3 * at : own;
        stage->world->kernel->colors(sum + row * STRIDE, extent->width, count, exposure, color);
        if (target->png != NULL && !gi_png_put(target->png, x, y + row, extent->width, color)) {
            return false;
        }
        if (scratch->seen == NULL) continue;
        store_seen(scratch->seen + row * STRIDE, extent->width, count, at, target);
    }
    return target->png == NULL ||
           gi_png_account(target->png, y, extent->height, extent->width, stage->control->worker);
}

bool gi_tile_draw(const GiWorld *world, const GiRenderArea *area, int x, int y, GiTileSize size,
    const GiRenderTarget *target, GiTileScratch *scratch, GiRenderCounts *counts,
    const GiTileControl *control) {
    GiTileExtent extent = {area->x + x, area->y + y, area->crop_width - x, area->crop_height - y};
    if (extent.width > size.width) extent.width = size.width;
    if (extent.height > size.height) extent.height = size.height;
    GiStage stage = {world, control, scratch, counts, target, target->record, (uint32_t)extent.x,
        (uint32_t)extent.y, 0};
    scratch->bundle.stop = ask;
    scratch->bundle.stop_context = control;
    int n = grid_of(target->samples);
    if (scratch->seen != NULL) {
        memset(scratch->seen, 0, (size_t)(extent.height * STRIDE) * sizeof *scratch->seen);
    }
    int first = 0, end = n * n;
    if (gi_stage_records(&stage)) gi_record_choose_samples(target->record, &first, &end);
    for (int sample = first; sample < end; sample++) {
        stage.sample = (uint32_t)sample;
        draw_sample(&stage, area, &extent, (sample % n + 0.5) / n, (sample / n + 0.5) / n);
        if (stopped(control)) return false;
        if (n > 1) add_sample(&extent, scratch, sample == first);
        if (gi_stage_records(&stage)) gi_record_end(&stage, n * n);
    }
    if (first >= end || store(&stage, area, &extent, x, y, n * n)) return true;
    scratch->out_of_memory = true;
    atomic_store(control->stop, true);
    return false;
}
