/* SPDX-License-Identifier: MIT
 * A committed scene: everything tracing needs, immutable. */
#pragma once

#include "accel/tree.h"
#include "camera/camera.h"
#include "kernel/kernel.h"
#include "light/environment.h"
#include "light/rectangle.h"
#include "render/spread.h"
#include "scene/scene.h"

typedef struct GiWorld {
    const GiScene *scene;
    const GiRules *rules;
    const GiKernel *kernel;
    GiShapes shapes;
    GiTreeStore store;
    GiTreeStore *inner; /* trees of what instances share */
    size_t inner_count;
    GiTrace trace;
    GiView view;                                                /* of the scene's own camera */
    size_t primitive_count, node_count, leaf_count, tree_bytes; /* of all trees */
    GiSpread spread;    /* its lists are empty again once the trees stand */
    uint32_t *original; /* of triangles, see GiTriangles */
    size_t original_count;
    GI_ARRAY(GiRectangle) rectangles;  /* lights that can be seen; their info.shader is the light */
    GI_ARRAY(GiLightRectangle) lights; /* an entry for every light; those of rectangles count */
    GiEnvironmentSampler sky;
    bool sky_lights;       /* the environment lights surfaces */
    bool has_large_lights; /* that can be found by chance: the sky or a visible rectangle */
} GiWorld;

/* What shadow rays from a point of the shape do not meet. */
static inline uint32_t gi_world_skip(const GiWorld *world, GiShapeRef shape) {
    if (world->rules->sphere_shadows_itself) return GI_SHAPE_NONE;
    GiShapeRef own = gi_shape_unplaced(&world->shapes, shape);
    return gi_shape_kind(own) == GI_SHAPE_SPHERE ? shape.bits : GI_SHAPE_NONE;
}

/* Spreads out the groups and builds the trees. The scene must have a camera, an image and a
 * dialect, and stay as it is while the world lives; its lists of children are released. *world is
 * zeroed first; on failure it can be reset. Errors: SCENE, MEMORY, CANCELLED. */
GlintStatus gi_world_commit(GiWorld *world, GiScene *scene, const GiKernel *kernel, GiPool *pool,
    const GlintMonitor *monitor, GlintError *error);
/* Where camera rays begin, past a surface that the eye lies on. */
double gi_world_eye_error(const GiWorld *world, GiVec eye);

void gi_world_reset(GiWorld *world, GiMemory *memory);
