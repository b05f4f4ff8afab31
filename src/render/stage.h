/* SPDX-License-Identifier: MIT
 * What the stages of a tile hand to each other. A stage works on many rays or points before the
 * next begins, so that rays meet the kernels in numbers:
 *
 *     tile.c      camera rays, in bundles
 *     surface.c   rays that met something become points; what shines by itself; mirror rays
 *     lights.c    points and lights become shadow rays; those that arrive add light
 *     flight.c    mirror rays and all that follow from them
 *
 * Light is summed up for each pixel in an order that depends on that pixel's own rays alone, never
 * on how the picture was cut into tiles. */
#pragma once

#include "render/tile.h"

enum {
    GI_TILE_STRIDE = GI_TILE_SIDE_LIMIT,
    GI_TILE_PIXELS = GI_TILE_STRIDE * GI_TILE_STRIDE,
    GI_FLIGHT_CHUNK = 4096 /* rays that are followed together */
};

/* What a point is beside its numbers. */
typedef struct GiSpot {
    uint32_t pixel, shader;
    uint32_t skip, skip_instance; /* what shadow rays from here do not meet, or GI_SHAPE_NONE */
} GiSpot;

/* Points begin to end - 1 have one shader. */
typedef struct GiSegment {
    uint32_t shader;
    int begin, end;
} GiSegment;

/* A ray under way: what it meets counts `factor`. */
typedef struct GiFlight {
    GiVec origin, direction; /* unit */
    GiVec factor;
    double t_min, weight;
    uint32_t pixel, level; /* rays of the camera: 1 */
    bool inside;           /* in glass */
} GiFlight;

/* Rays first to end - 1 of the flights; they have one level. */
typedef struct GiFlightRange {
    size_t first, end;
} GiFlightRange;

struct GiTileScratch {
    GiBundle bundle;
    GiRegroup regroup;
    GiPoints points;
    GiSpot spots[GI_POINT_ROOM];
    GiVec factors[GI_POINT_ROOM]; /* how much a point counts, unless all count 1 */
    GiVec diffuse[GI_POINT_ROOM]; /* of points whose shader has a texture */
    GiSegment segments[GI_POINT_LIMIT];
    GiLit lit;
    bool arrives[GI_POINT_LIMIT];                      /* of the lit */
    double across[GI_TILE_STRIDE], up[GI_TILE_STRIDE]; /* window coordinates of columns, rows */
    GiVec color[GI_TILE_PIXELS];                       /* of the sample being drawn */
    GiVec sum[GI_TILE_PIXELS];                         /* of the samples before */
    GiFlight chunk[GI_FLIGHT_CHUNK];
    GI_ARRAY(GiFlight) flights;
    GI_ARRAY(GiFlightRange) ranges;
    uint32_t *head; /* for each shader, while points are sorted: the first of its rays */
    size_t shader_count;
    int point_count, segment_count;
    bool weighted; /* factors are in use */
    bool out_of_memory;
};

/* What all stages need to know. */
typedef struct GiStage {
    const GiWorld *world;
    const GiTileControl *control;
    GiTileScratch *scratch;
    GiRenderCounts *counts;
} GiStage;

/* Whether to stop; asks the caller now and then. */
bool gi_stage_stopped(const GiStage *stage);

/* ---- surface.c */

/* The rays of the bundle: pixels[i] is where ray i began. */
void gi_surface_bundle(const GiStage *stage, const uint32_t *pixels);

/* A ray under way that met something. */
void gi_surface_flight(const GiStage *stage, const GiFlight *flight, const GiTraceHit *hit);

/* What a ray sees that meets nothing. */
GiVec gi_surface_background(const GiWorld *world, GiVec direction);

/* ---- lights.c: adds the light of all lights to all points, and forgets the points. */
void gi_lights_add(const GiStage *stage);

/* ---- flight.c: follows the flights until none is left. */
void gi_flight_follow(const GiStage *stage);
