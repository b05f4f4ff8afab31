/* SPDX-License-Identifier: MIT */
#include "render/render.h"

#include "render/stage.h"

#include <string.h>

typedef struct Render {
    const GiWorld *world;
    GiPool *pool;
    const GiRenderArea *area;
    const GlintMonitor *monitor;
    const GiRenderTarget *target;
    GiTileScratch **scratch;
    GiRenderCounts *counts; /* a worker each */
    GiTileSize size;        /* of a tile */
    int columns, rows;
    _Atomic int next, done;
    _Atomic bool stop;
} Render;

/* On the caller's thread only. */
static void report(Render *render) {
    const GlintMonitor *monitor = render->monitor;
    if (monitor == NULL) return;
    if (monitor->progress != NULL) {
        double done = (double)atomic_load_explicit(&render->done, memory_order_relaxed);
        monitor->progress(
            monitor->user, GLINT_PHASE_TRACE, done / ((double)render->columns * render->rows));
    }
    if (monitor->cancelled != NULL && monitor->cancelled(monitor->user)) {
        atomic_store(&render->stop, true);
    }
}

/* The same. */
static void send(Render *render) {
    GiPng *png = render->target->png;
    if (png != NULL && !gi_png_send(png)) atomic_store(&render->stop, true);
}

/* No tile is left to begin, but bands can be sent, and the caller can still be asked. */
static void wait_for_others(Render *render) {
    while (!gi_parallel_wait(render->pool, 0.001)) {
        send(render);
        report(render);
    }
}

static void draw_tiles(void *context, size_t begin, size_t end, int worker) {
    (void)begin;
    (void)end;
    Render *render = context;
    GiRenderCounts counts = {0};
    GiTileControl control = {&render->stop, worker == 0 ? render->monitor : NULL, worker};
    for (;;) {
        int tile = atomic_fetch_add_explicit(&render->next, 1, memory_order_relaxed);
        if (tile >= render->columns * render->rows || atomic_load(&render->stop)) break;
        int x = tile % render->columns * render->size.width;
        int y = tile / render->columns * render->size.height;
        if (!gi_tile_draw(render->world, render->area, x, y, render->size, render->target,
                render->scratch[worker], &counts, &control)) {
            break;
        }
        atomic_fetch_add_explicit(&render->done, 1, memory_order_relaxed);
        if (worker == 0) {
            send(render);
            report(render);
        }
    }
    if (worker == 0) wait_for_others(render);
    /* A worker may be called more than once. */
    render->counts[worker].camera_rays += counts.camera_rays;
    render->counts[worker].shadow_rays += counts.shadow_rays;
    render->counts[worker].other_rays += counts.other_rays;
}

/* The size of tiles. In a large tree many rays share what they fetch of it; where the tree stays in
 * a core's cache, it is better that a tile's own numbers stay there too. And many tiles share out
 * better: at least sixteen for every worker. */
static GiTileSize tile_size(const GiWorld *world, const GiRenderArea *area, size_t workers) {
    static const struct {
        GiTileSize size;
        size_t tree_bytes; /* at least */
    } choices[] = {{{GI_TILE_SIDE_LIMIT, GI_TILE_SIDE_LIMIT}, 4 << 20}, {{64, 64}, 2 << 20},
        {{GI_BLOCK_WIDTH, GI_BLOCK_HEIGHT}, 0}};
    double pixels = (double)area->crop_width * area->crop_height / (double)workers;
    for (size_t i = 0; i < sizeof choices / sizeof *choices; i++) {
        GiTileSize size = choices[i].size;
        bool many = pixels >= 16.0 * size.width * size.height;
        if (many && world->tree_bytes >= choices[i].tree_bytes) return size;
    }
    return (GiTileSize){GI_RENDER_TILE_LEAST, GI_RENDER_TILE_LEAST};
}

GlintStatus gi_render(const GiWorld *world, GiPool *pool, const GiRenderArea *area,
    const GlintMonitor *monitor, const GiRenderTarget *target, GiRenderCounts *counts) {
    GiMemory *memory = world->scene->memory;
    size_t workers = (size_t)gi_pool_worker_count(pool);
    Render render = {
        .world = world, .pool = pool, .area = area, .monitor = monitor, .target = target};
    render.size = tile_size(world, area, workers);
    render.columns = (area->crop_width + render.size.width - 1) / render.size.width;
    render.rows = (area->crop_height + render.size.height - 1) / render.size.height;
    size_t scratch_size = workers * sizeof *render.scratch;
    size_t counts_size = workers * sizeof *render.counts;
    render.scratch = gi_memory_allocate(memory, scratch_size);
    render.counts = gi_memory_allocate(memory, counts_size);
    GlintStatus status = GLINT_ERROR_MEMORY;
    if (render.scratch != NULL) memset(render.scratch, 0, scratch_size);
    if (render.scratch == NULL || render.counts == NULL) goto done;
    memset(render.counts, 0, counts_size);
    for (size_t i = 0; i < workers; i++) {
        render.scratch[i] = gi_tile_scratch_create(world, target);
        if (render.scratch[i] == NULL) goto done;
    }
    report(&render);
    gi_parallel_for(pool, workers, 1, draw_tiles, &render);
    report(&render);
    *counts = (GiRenderCounts){0};
    for (size_t i = 0; i < workers; i++) {
        counts->camera_rays += render.counts[i].camera_rays;
        counts->shadow_rays += render.counts[i].shadow_rays;
        counts->other_rays += render.counts[i].other_rays;
    }
    bool whole = atomic_load(&render.done) == render.columns * render.rows;
    status = atomic_load(&render.stop) && !whole ? GLINT_CANCELLED : GLINT_OK;
    for (size_t i = 0; i < workers; i++) {
        if (gi_tile_out_of_memory(render.scratch[i])) status = GLINT_ERROR_MEMORY;
    }
done:
    for (size_t i = 0; render.scratch != NULL && i < workers; i++) {
        gi_tile_scratch_destroy(memory, render.scratch[i]);
    }
    gi_memory_free(memory, render.scratch, scratch_size);
    gi_memory_free(memory, render.counts, counts_size);
    return status;
}
