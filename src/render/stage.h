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
#include "sample/sampler.h"
#include "shade/bsdf.h"

enum {
    GI_TILE_STRIDE = GI_TILE_SIDE_LIMIT,
    GI_TILE_PIXELS = GI_TILE_STRIDE * GI_TILE_STRIDE,
    GI_FLIGHT_CHUNK = 4096 /* rays that are followed together */
};

/* What a point is beside its numbers. */
typedef struct GiSpot {
    uint32_t shader;
    uint32_t level; /* of the ray that met it */
} GiSpot;

/* What the camera rays of a pixel met, where it is asked for: sums over samples. */
typedef struct GiSeen {
    GiVec normal, albedo;
    double depth;
    int count;
    uint32_t surface; /* of the first sample */
} GiSeen;

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
    double density;        /* with which a bsdf drew it; 0: it is a mirror's or refracted */
    uint32_t pixel, level; /* rays of the camera: 1 */
    uint32_t ray;          /* its number in the record, or its parent's before it has one */
    bool inside;           /* in glass */
    bool probe;            /* looks for lights only */
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
    double across[GI_TILE_STRIDE], up[GI_TILE_STRIDE]; /* window coordinates of columns, rows */
    double a[GI_BUNDLE_ROOM], b[GI_BUNDLE_ROOM];       /* ... of a bundle's rays */
    GiVec color[GI_TILE_PIXELS];                       /* of the sample being drawn */
    GiVec sum[GI_TILE_PIXELS];                         /* of the samples before */
    GiSeen *seen;                                      /* GI_TILE_PIXELS, or null */
    GiFlight chunk[GI_FLIGHT_CHUNK];
    GI_ARRAY(GiFlight) flights;
    GI_ARRAY(GiFlightRange) ranges;
    int segment_count;
    bool weighted; /* factors are in use */
    bool shared;   /* points may have a pixel in common, so light goes to the pixels at once */
    bool out_of_memory;
};

/* What a light that is not a point sends to a surface: one ray. */
typedef struct GiBeam {
    GiVec direction;     /* toward the light, unit */
    GiVec light;         /* E of the direction, or radiance over density */
    double t_min, t_max; /* of the shadow ray */
    double distance;     /* to the light */
    double density;      /* per solid angle; 0: the bsdf cannot find this light */
    bool radiance;       /* light of a large source, not of a point */
} GiBeam;

/* What all stages need to know. */
typedef struct GiStage {
    const GiWorld *world;
    const GiTileControl *control;
    GiTileScratch *scratch;
    GiRenderCounts *counts;
    const GiRenderTarget *target;
    GiRecord *record;      /* the target's */
    uint32_t x, y, sample; /* the tile's corner in the whole picture; number of the sample */
} GiStage;

/* Whether the pixel is drawn to be explained (render/record.h). */
static inline bool gi_stage_records(const GiStage *stage) { return stage->record != NULL; }

/* Whether to stop; asks the caller now and then. */
bool gi_stage_stopped(const GiStage *stage);

/* The numbers of a pixel's sample. A dimension is a purpose at a level. */
static inline GiSampler gi_stage_sampler(const GiStage *stage, uint32_t pixel) {
    uint32_t x = stage->x + pixel % GI_TILE_STRIDE, y = stage->y + pixel / GI_TILE_STRIDE;
    return stage->target->sampling == GLINT_SAMPLING_SOBOL
               ? gi_sampler(x, y, stage->sample)
               : gi_sampler_independent(x, y, stage->sample);
}

typedef enum GiPurpose {
    GI_PURPOSE_CHOICE,   /* of what goes on */
    GI_PURPOSE_LOBE,     /* of a bsdf */
    GI_PURPOSE_BSDF,     /* its direction */
    GI_PURPOSE_ROULETTE, /* whether a path goes on */
    GI_PURPOSE_SKY,
    GI_PURPOSE_LIGHT /* the first of the lights; the others follow */
} GiPurpose;

static inline uint64_t gi_stage_dimension(uint32_t level, uint32_t purpose) {
    return (uint64_t)(purpose >> 16) << 32 | level << 16 | (purpose & 0xffff);
}

/* The weight of one of two ways to draw the same light, by their densities (Veach and Guibas 1995,
 * power heuristic). own: the technique that the first density is of. */
static inline double gi_stage_share(
    const GiStage *stage, GiTechnique own, double density, double other) {
    GiTechnique technique = stage->target->technique;
    if (technique != GI_TECHNIQUE_BOTH) return technique == own ? 1 : 0;
    /* Of a light without extent, as good as, the squares would be infinite. */
    double ratio = other / density;
    return 1 / (1 + ratio * ratio);
}

/* Whether light of that index (-1: of no light) is drawn. */
static inline bool gi_stage_draws(const GiStage *stage, int light) {
    int wanted = stage->target->light;
    return wanted == 0 || wanted == (light < 0 ? -1 : light + 1);
}

/* What light given as radiance counts beside that of point lights, given as intensity. On paths
 * surfaces send light to each other, and must not send back more than they get in any year. */
static inline double gi_stage_radiance(const GiShading *at) {
    bool path = at->scene->integrator == GLINT_INTEGRATOR_PATH;
    return path || at->rules->radiance_over_pi ? gi_bsdf_radiometric(at) : 1;
}

/* The camera that is drawn with. */
static inline const GiView *gi_stage_view(const GiStage *stage) {
    return stage->target->view != NULL ? stage->target->view : &stage->world->view;
}

/* ---- tile.c */

/* The tile's pixels that lie in the picture, or in the part of it that is drawn. */
typedef struct GiTileExtent {
    int x, y, width, height;
} GiTileExtent;

/* A bundle of camera rays: a block of pixels. */
enum { GI_BLOCK_WIDTH = 64, GI_BLOCK_HEIGHT = GI_BUNDLE_SIZE / GI_BLOCK_WIDTH };

/* Readies the camera rays of one sample of every pixel; offsets from 0 to 1. */
void gi_tile_aim(const GiStage *stage, const GiRenderArea *area, const GiTileExtent *extent,
    double offset_x, double offset_y);

/* Traces the block with the corner (x, y) in the tile. The bundle then has what its rays met.
 * Returns how many there are; 0 also when it is to stop. */
int gi_tile_trace_block(const GiStage *stage, const GiTileExtent *extent, int x, int y);

/* ---- surface.c */

/* The rays of the bundle. */
void gi_surface_bundle(const GiStage *stage);

/* A ray under way, with what it met; null: nothing. */
void gi_surface_flight(const GiStage *stage, const GiFlight *flight, const GiTraceHit *hit);

/* The shading of point i. */
GiShading gi_surface_shading(const GiStage *stage, int i);

/* Whether light from large sources is also looked for along directions that the bsdf draws. */
bool gi_surface_probes(const GiWorld *world, const GiShader *shader);

/* ---- lights.c */

/* Adds the light of all lights to all points, and forgets the points. */
void gi_lights_add(const GiStage *stage);

/* Traces the shadow rays of the lit to a point light, or in one direction (parallel), in an order
 * of the kernels' liking, and fills in which of them arrive. Less is done when it is to stop. */
void gi_lights_trace(const GiStage *stage, GiVec light, bool parallel);

/* Whether the kernels know the shader's formula; *gloss is then made ready for them. */
bool gi_lights_gloss(const GiRules *rules, const GiShader *shader, GiGloss *gloss);

/* ---- flight.c */

/* Keeps a ray to be followed. */
void gi_flight_add(const GiStage *stage, const GiFlight *flight);

/* Follows the flights until none is left. */
void gi_flight_follow(const GiStage *stage);
