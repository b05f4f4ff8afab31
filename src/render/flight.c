/* SPDX-License-Identifier: MIT
 * Rays under way lie in one array, range after range, a level each; the last range is followed
 * first. It is taken in chunks from its end, and what a chunk's points send on becomes the next
 * range, so that no more rays are ever stored than a chunk's for every level.
 *
 * The rays of a pixel stand side by side. A chunk holds all of a pixel's rays of its level, or, if
 * these are more than a chunk holds, that many, and in the last one the rest. So a pixel's light is
 * summed up in the same order whatever pixels it shares the tile with. */
#include "render/record.h"

#include <string.h>

void gi_flight_add(const GiStage *stage, const GiFlight *flight) {
    GiTileScratch *scratch = stage->scratch;
    if (!gi_array_push(stage->world->scene->memory, &scratch->flights, *flight)) {
        scratch->out_of_memory = true;
        atomic_store(stage->control->stop, true);
    } else if (gi_stage_records(stage)) {
        scratch->flights.data[scratch->flights.count - 1].ray = gi_record_flight(stage, flight);
    }
}

/* Where the last chunk of the range begins. */
static size_t chunk_begin(const GiFlight *flights, const GiFlightRange *range) {
    if (range->end - range->first <= GI_FLIGHT_CHUNK) return range->first;
    size_t begin = range->end - GI_FLIGHT_CHUNK;
    uint32_t pixel = flights[begin - 1].pixel;
    if (flights[begin].pixel != pixel) return begin;
    size_t next = begin;
    while (next < range->end && flights[next].pixel == pixel) next++;
    return next < range->end ? next : begin; /* begin: all is one pixel's */
}

/* Moves the last chunk out of the array. Returns its size. */
static int take_chunk(GiTileScratch *scratch) {
    GiFlightRange *range = &scratch->ranges.data[scratch->ranges.count - 1];
    size_t begin = chunk_begin(scratch->flights.data, range), count = range->end - begin;
    memcpy(scratch->chunk, scratch->flights.data + begin, count * sizeof *scratch->chunk);
    range->end = scratch->flights.count = begin;
    if (range->first == range->end) scratch->ranges.count--;
    return (int)count;
}

/* All flights after `first` become a range. */
static void push_range(const GiStage *stage, size_t first) {
    GiTileScratch *scratch = stage->scratch;
    if (scratch->flights.count == first) return;
    const GiFlightRange range = {first, scratch->flights.count};
    if (!gi_array_push(stage->world->scene->memory, &scratch->ranges, range)) {
        scratch->out_of_memory = true;
        atomic_store(stage->control->stop, true);
    }
}

enum { TRACED_TOGETHER = 1024 }; /* between two questions whether to stop */

static void follow_chunk(const GiStage *stage, int count) {
    const GiWorld *world = stage->world;
    GiTraceRay rays[TRACED_TOGETHER];
    GiTraceHit hits[TRACED_TOGETHER];
    for (int begin = 0; begin < count; begin += TRACED_TOGETHER) {
        if (gi_stage_stopped(stage)) return;
        const GiFlight *flights = stage->scratch->chunk + begin;
        int together = count - begin < TRACED_TOGETHER ? count - begin : TRACED_TOGETHER;
        for (int i = 0; i < together; i++) {
            rays[i] = (GiTraceRay){flights[i].origin, flights[i].direction, flights[i].t_min,
                INFINITY, GI_SHAPE_NONE, GI_SHAPE_NONE};
        }
        world->kernel->many_closest(&world->trace, rays, together, hits);
        for (int i = 0; i < together; i++) {
            bool met = hits[i].shape.bits != GI_SHAPE_NONE;
            gi_surface_flight(stage, &flights[i], met ? &hits[i] : NULL);
        }
    }
    stage->counts->other_rays += (uint64_t)count;
}

void gi_flight_follow(const GiStage *stage) {
    GiTileScratch *scratch = stage->scratch;
    push_range(stage, 0);
    scratch->weighted = scratch->shared = true;
    while (scratch->ranges.count > 0 && !gi_stage_stopped(stage)) {
        int count = take_chunk(scratch);
        size_t first = scratch->flights.count;
        follow_chunk(stage, count);
        gi_lights_add(stage);
        push_range(stage, first);
    }
    scratch->ranges.count = scratch->flights.count = 0;
}
