/* SPDX-License-Identifier: MIT
 * One scene traced by both, in turns. */
#pragma once

#include "rays_count.h"
#include "rays_options.h"
#include "rays_set.h"
#include "statistics.h"

/* Seconds of a pass over all rays of a kind. */
typedef struct RaysKindResult {
    size_t ray_count; /* 0: the scene has none */
    Spread together, single;
    Spread embree, harness; /* of Embree's best way; what of it is not Embree */
    char way[32];           /* that way: mode and tree */
    size_t hit_count, embree_hit_count;
    RaysCounts counts;
} RaysKindResult;

typedef struct RaysResult {
    char name[32];
    size_t primitive_count;
    bool has_embree;
    const char *no_embree; /* why not */
    RaysKindResult kinds[RAY_KIND_COUNT];
    double build_seconds, tree_bytes; /* of Glint */
    char tree[32];                    /* Embree's that is built fastest; it counts below */
    double embree_build_seconds, embree_tree_bytes;
} RaysResult;

void rays_contest(const RaysOptions *options, const char *scene, RaysResult *result);
