/* SPDX-License-Identifier: MIT
 * The hot loops: which shape a ray meets. A kernel sees the tree and the shapes' numbers, nothing
 * else of a scene. kernel.c is compiled once for each instruction set; dispatch.c chooses.
 *
 * All kernels give the same answer to the last bit: the smallest t at which shape/hit.h finds a
 * shape in the open interval (t_min, t_max), and of several shapes at that t the one that comes
 * first in document order. */
#pragma once

#include "accel/layout.h"
#include "math/view.h"
#include "kernel/points.h"
#include "kernel/regroup.h"
#include "light/rectangle.h"
#include "math/gamma.h"

typedef struct GiTrace {
    const GiTree *tree;
    const GiShapes *shapes;
} GiTrace;

typedef struct GiTraceRay {
    GiVec origin, direction; /* any length but zero */
    double t_min, t_max;
    /* What the ray does not meet: bits of a shape, or GI_SHAPE_NONE, and its instance, or
     * GI_SHAPE_NONE; or GI_LEFT (points.h). */
    uint32_t skip, skip_instance;
} GiTraceRay;

typedef struct GiTraceHit {
    double t;
    GiShapeRef shape;
    uint32_t instance; /* that the shape was met in, or GI_SHAPE_NONE */
} GiTraceHit;

/* Up to GI_BUNDLE_SIZE rays whose lines pass through one point, traced together. Neighbours in the
 * arrays, sixteen at a time, should be neighbours in space. Two uses:
 *     closest   the rays start at the apex and look from t = start on (camera rays)
 *     any       the rays end there, at t = 1, and look up to t = end (shadow rays of a point light)
 * In: for closest the directions, start, and in t how far each ray looks; for any the origins, end,
 * t_min, skip and skip_instance; what is the same for all rays, or follows from the rest, would
 * cost more to store and to load than to work out. Out: shape (GI_SHAPE_NONE: nothing met) and, for
 * closest, instance and t; without t it stays what it is for some of those rays that have met
 * triangles. */
typedef struct GiBundle {
    _Alignas(64) double ox[GI_BUNDLE_ROOM];
    double oy[GI_BUNDLE_ROOM], oz[GI_BUNDLE_ROOM];
    double dx[GI_BUNDLE_ROOM], dy[GI_BUNDLE_ROOM], dz[GI_BUNDLE_ROOM];
    double t_min[GI_BUNDLE_ROOM];
    uint32_t skip[GI_BUNDLE_ROOM], skip_instance[GI_BUNDLE_ROOM];
    double t[GI_BUNDLE_ROOM];
    uint32_t shape[GI_BUNDLE_ROOM], instance[GI_BUNDLE_ROOM];
    uint32_t pixel[GI_BUNDLE_ROOM]; /* of camera rays; of others the caller's */
    int count;                      /* 1 to GI_BUNDLE_SIZE */
    GiVec apex;
    double start, end; /* end: at most 1, unless the rays are parallel */
    /* The rays have their own origins and directions after all. For any: those of an instance,
     * whose directions are not just apex - origin, to the last bit, and parallel ones. For closest:
     * those of a parallel camera, which bundle_closest does not trace. */
    bool own;
    GiVec side;     /* a direction the packets are aligned with; zero: none known */
    bool without_t; /* closest: nobody needs t; see above */
    /* Asked every few thousand exact tests, when it is not null; true: the bundle may stay
     * unfinished. */
    bool (*stop)(const void *context);
    const void *stop_context;
    /* The kernel's own: 1 / d and 1 / d.d, where needed. */
    double ix[GI_BUNDLE_ROOM], iy[GI_BUNDLE_ROOM], iz[GI_BUNDLE_ROOM];
    double inverse_square[GI_BUNDLE_ROOM];
} GiBundle;

/* Of a camera ray. */
static inline GiVec gi_bundle_origin(const GiBundle *bundle, int i) {
    return bundle->own ? gi_vec(bundle->ox[i], bundle->oy[i], bundle->oz[i]) : bundle->apex;
}

static inline GiVec gi_bundle_direction(const GiBundle *bundle, int i) {
    return gi_vec(bundle->dx[i], bundle->dy[i], bundle->dz[i]);
}

typedef struct GiKernel {
    const char *name;
    bool (*closest)(const GiTrace *trace, const GiTraceRay *ray, GiTraceHit *hit);
    bool (*any)(const GiTrace *trace, const GiTraceRay *ray);
    /* Many rays that need not have anything in common; hits[i].shape is GI_SHAPE_NONE when ray i
     * meets nothing. */
    void (*many_closest)(const GiTrace *trace, const GiTraceRay *rays, int count, GiTraceHit *hits);
    void (*many_any)(const GiTrace *trace, const GiTraceRay *rays, int count, bool *blocked);
    void (*bundle_closest)(const GiTrace *trace, GiBundle *bundle);
    void (*bundle_any)(const GiTrace *trace, GiBundle *bundle);
    /* As bundle_any, of rays that all run in one direction, of any length but zero, without end:
     * those to the sun. In: origins, t_min, skip and skip_instance; apex is not looked at. */
    void (*bundle_parallel)(const GiTrace *trace, GiBundle *bundle, GiVec direction);
    /* Directions of the bundle's rays, and of a parallel camera's their origins, through the window
     * coordinates a and b. */
    void (*view)(const GiView *view, const double *a, const double *b, GiBundle *bundle);
    /* Sorts the places 0 to count - 1, at most GI_BUNDLE_SIZE, by their keys: those of equal keys
     * side by side, in order, up to ends[0], ends[1] and so on. Returns how many keys there are.
     * `keys` and `places` have GI_BUNDLE_ROOM. */
    int (*group)(const uint32_t *keys, int count, uint32_t *places, int *ends);
    /* Appends the points where rays of the bundle, named by their indices, met spheres, boxes,
     * cones or triangles (all of one kind, not placed, not an instance's). `own`: what shadow rays
     * do with the shape they start on; GI_OWN_LEFT, of triangles alone, says that they look from
     * the points' errors on. */
    void (*points)(const GiShapes *shapes, const GiBundle *bundle, const uint32_t *rays, int count,
        GiOwn own, bool second_nappe_geometric, GiPoints *points);
    /* What the light adds to the points begin to end - 1, all of one shader, as shade/shade.h has
     * it to the last bit: into *lit, whose list goes on with those to which it is not nothing. None
     * arrives as yet. */
    void (*light)(const GiPoints *points, int begin, int end, const GiPointLight *light,
        const GiGloss *gloss, GiLit *lit);
    /* For count points from `begin` on, at most GI_AREA_TOGETHER, what gi_rectangle_sample_angle
     * draws by these numbers. Of `pairs` and `beams` whole vectors are read and written. */
    void (*area)(const GiLightRectangle *rectangle, const GiPoints *points, int begin, int count,
        const GiPairs *pairs, GiAreaBeams *beams);
    /* The shadow rays to bundle->apex of the bundle->count lit that `order` names; bundle->pixel is
     * the point. */
    void (*shadows)(
        const GiPoints *points, const GiLit *lit, const uint16_t *order, GiBundle *bundle);
    /* Adds what arrives to what the points show. */
    void (*add)(const GiLit *lit, GiPoints *points);
    /* Sums of samples to a pixel's three numbers. */
    void (*colors)(const GiVec *sums, int count, int samples, double exposure, float *to);
    GiGammaFn encode; /* as gi_gamma_encode */
    /* x, y, z: count directions, at most GI_REGROUP_LIMIT, of about one length, or the order is
     * the worse for it; leaves: of the scene's trees. */
    void (*regroup)(GiRegroup *regroup, const float *x, const float *y, const float *z, int count,
        double leaves);
} GiKernel;

/* The kernels this build has and this machine can run, fastest first; null at the end. */
const GiKernel *gi_kernel_at(int index);

/* By name; null: the fastest. Null when there is none of that name. */
const GiKernel *gi_kernel_find(const char *name);
