/* SPDX-License-Identifier: MIT
 * The shapes as plain numbers. A shape is named by a ref: its kind and its index in the array of
 * that kind. Nothing here knows shaders, scenes or trees. */
#pragma once

#include "math/affine.h"

#include <stdint.h>

typedef enum GiShapeKind {
    GI_SHAPE_SPHERE,
    GI_SHAPE_BOX,
    GI_SHAPE_CONE, /* cylinders too: a cylinder is a cone whose radius does not change */
    GI_SHAPE_DISC,
    GI_SHAPE_PLANE,
    GI_SHAPE_KIND_COUNT,
    GI_SHAPE_PLACED = GI_SHAPE_KIND_COUNT, /* index into the placements: a ref under a transform */
    GI_SHAPE_GROUP                         /* only before commit: index into the groups */
} GiShapeKind;

typedef struct GiShapeRef { uint32_t bits; } GiShapeRef; /* kind << 28 | index */

#define GI_SHAPE_INDEX_LIMIT (1u << 28)
#define GI_SHAPE_NONE        UINT32_MAX

static inline GiShapeRef gi_shape_ref(GiShapeKind kind, uint32_t index) {
    return (GiShapeRef){(uint32_t)kind << 28 | index};
}
static inline GiShapeKind gi_shape_kind(GiShapeRef ref) { return (GiShapeKind)(ref.bits >> 28); }
static inline uint32_t gi_shape_index(GiShapeRef ref) { return ref.bits & 0x0fffffffu; }

typedef struct GiSphere {
    GiVec center;
    double radius;
} GiSphere;

typedef struct GiBox { GiVec low, high; } GiBox;

/* Solid of revolution round the line x = center.x, y = center.y: at height z above the centre plane
 * the radius is |radius + slope * z|, for |z| <= half_height. slope 0: a cylinder. Otherwise the
 * apex is at z = -radius / slope; when that lies strictly inside, there are two nappes. */
typedef struct GiCone {
    GiVec center;
    double radius, slope, half_height;
} GiCone;

typedef struct GiDisc {
    GiVec center, normal; /* unit */
    double radius;
} GiDisc;

typedef struct GiPlane { GiVec point, normal; /* unit */ } GiPlane;

typedef struct GiPlacement {
    GiShapeRef shape; /* not itself placed */
    uint32_t transform;
} GiPlacement;

typedef struct GiTransform { GiAffine to_world, to_object; } GiTransform;
