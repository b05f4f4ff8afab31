/* SPDX-License-Identifier: MIT
 * Groups spread out: from a tree of groups to flat lists of what stands where. A shape under a
 * transform becomes a placement. What a scene uses often is not copied but becomes an instance:
 * its content is spread out once, and each use costs a transform. Instances hold no instances.
 *
 * An instance is made of
 *     a mesh under a transform, or of one that is used more than once
 *     a group of more than GI_SPREAD_LIMIT shapes, and no mesh, that is used more than once
 * Of groups in groups the one is taken that makes contents and uses about equally many, so that
 * groups that double each other cost the square root of what they stand for. */
#pragma once

#include "scene/scene.h"

enum { GI_SPREAD_LIMIT = 16 };

/* What instances share: a mesh, or what a group spreads out to, a range of the refs. */
typedef struct GiContent {
    uint32_t mesh;  /* or GI_NONE */
    uint32_t group; /* or GI_NONE */
    size_t first, count;
} GiContent;

typedef struct GiSpread {
    /* Shapes, placements and instances: those of the scene, then those of the contents. The roots
     * themselves, when there is nothing to spread out. */
    const GiShapeRef *all;
    size_t ref_count, all_count; /* of the scene, and with the contents */
    GI_ARRAY(GiShapeRef) refs;
    GI_ARRAY(uint32_t) meshes; /* those that stand in the scene as triangles */
    GI_ARRAY(GiContent) contents;
    GI_ARRAY(uint32_t) content_of;  /* parallel to instances */
    GI_ARRAY(GiInstance) instances; /* tree and bounds are not yet set */
    GI_ARRAY(GiPlacement) placements;
    GI_ARRAY(GiTransform) transforms;
    GiShapeInfo *mesh_info; /* as in GiShapes */
} GiSpread;

/* *spread is zeroed first; whatever comes back, it can be reset. Errors: SCENE, MEMORY,
 * CANCELLED. */
GlintStatus gi_spread(const GiScene *scene, const GiRules *rules, const GlintMonitor *monitor,
    GiSpread *spread, GlintError *error);

/* Frees the lists down to content_of; what refs point to stays. */
void gi_spread_free_lists(GiSpread *spread, const GiScene *scene);
void gi_spread_reset(GiSpread *spread, const GiScene *scene);
