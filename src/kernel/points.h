/* SPDX-License-Identifier: MIT
 * Points of surfaces in numbers, and what a point light does to those of one shader. Component by
 * component, so that the kernels take as many at a time as their vectors hold. */
#pragma once

#include "math/vec.h"

#include <stdint.h>

enum {
    GI_POINT_LIMIT = 16384,
    GI_POINT_ROOM = GI_POINT_LIMIT + 16 /* kernels read and write whole vectors */
};

/* In the place of the instance of what a ray does not meet: it is a triangle that the ray may well
 * meet, of no instance, but begins on: at a point that kernel->points made, and looks from the
 * error of that point on. Kernels that can tell that rounding does not bring it back need not test
 * the two. */
#define GI_LEFT (UINT32_MAX - 1)

/* What a shadow ray does with the shape it starts on. */
typedef enum GiOwn { GI_OWN_MET, GI_OWN_SPARED, GI_OWN_LEFT } GiOwn;

/* Of both, vectors begin on a line of the cache. */
typedef struct GiPoints {
    _Alignas(64) double px[GI_POINT_ROOM];
    double py[GI_POINT_ROOM], pz[GI_POINT_ROOM];
    double nx[GI_POINT_ROOM], ny[GI_POINT_ROOM], nz[GI_POINT_ROOM]; /* unit normal */
    double vx[GI_POINT_ROOM], vy[GI_POINT_ROOM], vz[GI_POINT_ROOM]; /* unit, toward the viewer */
    double error[GI_POINT_ROOM]; /* distance within which a ray may meet its own surface */
    double red[GI_POINT_ROOM], green[GI_POINT_ROOM], blue[GI_POINT_ROOM]; /* what it shows so far */
    uint32_t pixel[GI_POINT_ROOM];
    /* What shadow rays from here do not meet, or GI_SHAPE_NONE; or GI_LEFT for its instance. */
    uint32_t skip[GI_POINT_ROOM], skip_instance[GI_POINT_ROOM];
    /* The shape a point is of, and the cosine between normal and light from which on a shadow ray
     * that begins at `error` or farther away is certain not to meet that shape. */
    uint32_t own[GI_POINT_ROOM];
    float clear[GI_POINT_ROOM];
    int count;
} GiPoints;

typedef struct GiPointLight {
    GiVec position, intensity;
    bool falls; /* off with the square of the distance */
    /* Infinitely far away: `position` is the unit direction to it. Shadow rays are put in order as
     * if it stood there 1 / part away from `center`. */
    bool parallel;
    GiVec center;
    double part;
} GiPointLight;

/* A Lambertian or Blinn-Phong shader under a dialect's rules (shade/shade.h has the formulas). */
typedef struct GiGloss {
    GiVec diffuse, specular;
    double diffuse_factor; /* 1 or 1 / pi */
    bool phong;
    unsigned exponent;
    bool cosine;      /* the highlight is multiplied by n.l */
    bool needs_light; /* no highlight where n.l <= 0 */
    bool front_only;  /* black where n.v < 0 */
    double away;      /* distance from the point at which shadow rays begin; 0: at its error */
} GiGloss;

/* What one light adds to points, if nothing is in the way. */
typedef struct GiLit {
    /* Of every point. */
    _Alignas(64) double red[GI_POINT_ROOM];
    double green[GI_POINT_ROOM], blue[GI_POINT_ROOM];
    double t_min[GI_POINT_ROOM];    /* of the shadow ray; the light is at t = 1 */
    uint32_t skip[GI_POINT_ROOM];   /* what that ray need not be tested against, with the instance
                                       of GiPoints */
    uint8_t arrives[GI_POINT_ROOM]; /* 1: nothing is in the way */
    /* Of those points alone to which it adds something. */
    int count;
    uint32_t point[GI_POINT_ROOM];
    float x[GI_POINT_ROOM], y[GI_POINT_ROOM], z[GI_POINT_ROOM]; /* unit direction, nearly */
} GiLit;

/* Toward a rectangle of light, from points that stand side by side. */
enum { GI_AREA_TOGETHER = 64 };

/* Random numbers for points of it. */
typedef struct GiPairs {
    _Alignas(64) double u[GI_AREA_TOGETHER];
    double v[GI_AREA_TOGETHER];
} GiPairs;

typedef struct GiAreaBeams {
    _Alignas(64) double dx[GI_AREA_TOGETHER]; /* unit direction */
    double dy[GI_AREA_TOGETHER], dz[GI_AREA_TOGETHER];
    double factor[GI_AREA_TOGETHER]; /* as gi_rectangle_sample_angle has it */
    double distance[GI_AREA_TOGETHER];
    double t_max[GI_AREA_TOGETHER]; /* not as far as the rectangle, which may be a surface */
} GiAreaBeams;
