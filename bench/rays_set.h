/* SPDX-License-Identifier: MIT
 * The rays that glint-bench-rays traces: of the camera, from what these meet to the point lights,
 * and one more from there in a direction drawn by the cosine. They are a function of the scene
 * alone. Points and directions are rounded to single precision where a ray begins there, so that
 * programs of either precision get the same rays. */
#pragma once

#include "render/world.h"

typedef enum RayKind { RAYS_CAMERA, RAYS_SHADOW, RAYS_BOUNCE, RAY_KIND_COUNT } RayKind;

/* Shadow rays to one light, from the points of one tile. */
typedef struct RayPart {
    size_t first;
    int count;
    GiVec light;
} RayPart;

/* Sixteen rays that follow each other are of 4 x 4 pixels, 1024 of 32 x 32, where none is left out.
 * A shadow ray ends at t_max 1, in the light. */
typedef struct RaySet {
    RayKind kind;
    GiTraceRay *rays;
    size_t count;
    RayPart *parts; /* of shadow rays */
    size_t part_count;
} RaySet;

/* Zeroed. Where there is none, the program ends. */
void *rays_allocate(size_t count, size_t size);

const char *rays_kind_name(RayKind kind);

/* Shadow rays and diffuse ones begin off the surface, 2^-17 of the scene's size along its normal:
 * whoever computes in single precision could not tell a nearer point from the surface. */
void rays_make(const GiWorld *world, RaySet sets[RAY_KIND_COUNT]);
void rays_free(RaySet sets[RAY_KIND_COUNT]);
