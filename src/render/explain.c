/* SPDX-License-Identifier: MIT */
#include "render/explain.h"

#include "math/gamma.h"
#include "render/record.h"

#include <string.h>

typedef struct Explainer {
    const GiWorld *world;
    GiRenderTarget target; /* one pixel, to color */
    float color[3];
    GiTileScratch *scratch;
    GiTileControl control;
    GiRecord record;
} Explainer;

static void tell_pixel(const Explainer *explainer, int x, int y, int samples) {
    const GlintExplainSink *sink = explainer->record.sink;
    if (sink->pixel == NULL || sink->only_sample > 0) return;
    double exposure = explainer->world->scene->exposure;
    GlintExplainPixel pixel = {
        .x = x, .y = y, .samples = samples, .exposure = exposure > 0 ? exposure : 1};
    gi_record_vec(pixel.sum, explainer->record.sum);
    memcpy(pixel.color, explainer->color, sizeof pixel.color);
    gi_gamma_encode(pixel.color, 3, pixel.rgb);
    sink->pixel(sink->user, &pixel);
}

static bool explain_pixel(Explainer *explainer, const GiRenderArea *area, int x, int y) {
    const GiRenderArea pixel = {area->width, area->height, x, y, 1, 1};
    GiRenderCounts counts = {0};
    if (!gi_tile_draw(explainer->world, &pixel, 0, 0, (GiTileSize){1, 1}, &explainer->target,
            explainer->scratch, &counts, &explainer->control)) {
        return false;
    }
    if (explainer->record.out_of_memory) return false; /* of the last sample */
    tell_pixel(explainer, x, y, explainer->record.samples);
    return true;
}

static void tell_progress(const GlintMonitor *monitor, double fraction) {
    if (monitor == NULL || monitor->progress == NULL) return;
    monitor->progress(monitor->user, GLINT_PHASE_TRACE, fraction);
}

GlintStatus gi_explain(const GiWorld *world, const GiRenderArea *area, const GlintMonitor *monitor,
    const GiRenderTarget *target, const GlintExplainSink *sink) {
    _Atomic bool stop = false;
    Explainer explainer = {.world = world,
        .target = {.samples = target->samples,
            .light = target->light,
            .sampling = target->sampling,
            .technique = target->technique,
            .view = target->view},
        .control = {&stop, monitor, 0}};
    explainer.target.color = explainer.color;
    explainer.target.record = &explainer.record;
    gi_record_init(&explainer.record, world->scene->memory, sink);
    explainer.scratch = gi_tile_scratch_create(world, &explainer.target);
    GlintStatus status = explainer.scratch != NULL ? GLINT_OK : GLINT_ERROR_MEMORY;
    for (int y = 0; y < area->crop_height && status == GLINT_OK; y++) {
        tell_progress(monitor, (double)y / area->crop_height);
        for (int x = 0; x < area->crop_width && status == GLINT_OK; x++) {
            if (explain_pixel(&explainer, area, area->x + x, area->y + y)) continue;
            bool short_of_memory = gi_tile_out_of_memory(explainer.scratch);
            status = short_of_memory ? GLINT_ERROR_MEMORY : GLINT_CANCELLED;
        }
    }
    if (status == GLINT_OK) tell_progress(monitor, 1);
    gi_tile_scratch_destroy(world->scene->memory, explainer.scratch);
    gi_record_reset(&explainer.record);
    return status;
}
