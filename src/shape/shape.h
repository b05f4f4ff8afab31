/* SPDX-License-Identifier: MIT
 * The shapes as plain numbers. A shape is named by a ref: its kind and its index in the array of
 * that kind. Nothing here knows shaders, scenes or trees. */
#pragma once

#include "math/affine.h"

#include <stddef.h>
#include <stdint.h>

typedef enum GiShapeKind {
    GI_SHAPE_SPHERE,
    GI_SHAPE_BOX,
    GI_SHAPE_CONE, /* cylinders too: a cylinder is a cone whose radius does not change */
    GI_SHAPE_DISC,
    GI_SHAPE_PLANE,
    GI_SHAPE_RECTANGLE,
    GI_SHAPE_KIND_COUNT,
    GI_SHAPE_TRIANGLE = GI_SHAPE_KIND_COUNT, /* index into the triangles of all meshes */
    GI_SHAPE_PLACED,   /* index into the placements: a ref under a transform */
    GI_SHAPE_INSTANCE, /* index into the instances: a tree of its own under a transform */
    GI_SHAPE_MESH,     /* only before commit: index into the mesh surfaces */
    GI_SHAPE_GROUP     /* only before commit: index into the groups */
} GiShapeKind;

typedef struct GiShapeRef {
    uint32_t bits;
} GiShapeRef; /* kind << 28 | index */

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

typedef struct GiBox {
    GiVec low, high;
} GiBox;

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

typedef struct GiPlane {
    GiVec point, normal; /* unit */
} GiPlane;

/* The points center + s across + t up, s and t from -1 to 1. The three vectors are at right angles.
 */
typedef struct GiRectangle {
    GiVec center, across, up, normal; /* normal: unit */
} GiRectangle;

/* The triangles of all meshes of a scene, file after file. Corners are single precision, as the
 * files have them; a triangle's normals and texture coordinates are found by corner indices of
 * their own only where a file has such (otherwise the positions' indices serve). */
typedef struct GiTriangles {
    const float (*positions)[3];
    const float (*normals)[3];
    const float (*texcoords)[2];
    const uint32_t (*corners)[3]; /* indices of positions, a row a triangle */
    const uint32_t *original;     /* places in the file's order: commit rearranges rows; or null */
} GiTriangles;

/* One file. Indices count from the first of the scene-wide arrays. */
typedef struct GiMesh {
    uint32_t first_triangle, triangle_count;
    uint32_t first_position, position_count;
    bool smooth;   /* has normals */
    bool textured; /* has texture coordinates */
    /* Corner indices of normals and texture coordinates, a row a triangle; a row that begins with
     * GI_SHAPE_NONE has none. Null: vertex i of the file has normal first_normal + i, likewise
     * texcoords. */
    uint32_t (*normal_corners)[3], (*texcoord_corners)[3];
    uint32_t first_normal, first_texcoord;
} GiMesh;

/* What a shape is to the scene, beside its numbers. */
typedef struct GiShapeInfo {
    uint32_t shader; /* index; 0 is the default shader */
    uint32_t order;  /* its number in document order, groups not counted; ties go to the lower */
} GiShapeInfo;

typedef struct GiPlacement {
    GiShapeRef shape; /* not itself placed */
    uint32_t transform;
} GiPlacement;

typedef struct GiTransform {
    GiAffine to_world, to_object;
} GiTransform;

/* A tree of its own under a transform: a mesh or a group that is not spread out. */
typedef struct GiInstance {
    const struct GiTree *tree;
    const GiBox *bounds; /* of what is in the tree */
    GiShapeInfo info;    /* of a mesh; in a group each shape has its own */
    uint32_t transform;
} GiInstance;

/* Normals as programs with mistakes have them: a set. */
typedef enum GiNormalFault {
    GI_NORMAL_INWARD = 1 << 0,
    GI_NORMAL_FACING = 1 << 1, /* turned toward the viewer */
    GI_NORMAL_FLAT = 1 << 2,   /* those of the vertices are ignored */
    GI_NORMAL_LENGTH = 1 << 3, /* not normalised */
    GI_NORMAL_MATRIX = 1 << 4  /* transformed as directions are */
} GiNormalFault;

/* The arrays that refs index, with the one rule that changes where rays meet shapes. */
typedef struct GiShapes {
    const GiSphere *spheres;
    const GiBox *boxes;
    const GiCone *cones;
    const GiDisc *discs;
    const GiPlane *planes;
    const GiRectangle *rectangles;
    GiTriangles triangles;
    const GiMesh *meshes; /* in the order of their triangles */
    uint32_t mesh_count;
    const GiShapeInfo *mesh_info; /* parallel to meshes: of those that are not instances */
    const GiPlacement *placements;
    const GiTransform *transforms;
    const GiInstance *instances;
    const GiShapeInfo *info[GI_SHAPE_KIND_COUNT]; /* parallel to the arrays of each kind */
    bool entering_only;     /* boxes do without their exits, cylinders without exits through caps */
    unsigned normal_faults; /* a set of GiNormalFault; the kernels do not know them */
} GiShapes;

/* Height of the apex above the centre plane; infinite for a cylinder. */
static inline double gi_cone_apex(const GiCone *cone) { return -cone->radius / cone->slope; }

/* The shape itself of a ref that may be placed. */
static inline GiShapeRef gi_shape_unplaced(const GiShapes *shapes, GiShapeRef ref) {
    return gi_shape_kind(ref) == GI_SHAPE_PLACED ? shapes->placements[gi_shape_index(ref)].shape
                                                 : ref;
}

/* The mesh that a triangle is of, by halving: the last one that does not begin after it. */
static inline uint32_t gi_shape_mesh(const GiShapes *shapes, uint32_t triangle) {
    uint32_t low = 0, high = shapes->mesh_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (shapes->meshes[middle].first_triangle <= triangle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* From here on a surface is named by a ref and the index of the instance it stands in, or
 * GI_SHAPE_NONE. */

static inline const GiShapeInfo *gi_shape_info(
    const GiShapes *shapes, GiShapeRef ref, uint32_t instance) {
    ref = gi_shape_unplaced(shapes, ref);
    uint32_t i = gi_shape_index(ref);
    if (gi_shape_kind(ref) != GI_SHAPE_TRIANGLE) return &shapes->info[gi_shape_kind(ref)][i];
    if (instance != GI_SHAPE_NONE) return &shapes->instances[instance].info;
    return &shapes->mesh_info[gi_shape_mesh(shapes, i)];
}

/* Whether a goes before b where a ray meets both at the same t. A light before all surfaces: one
 * that lies in a ceiling is seen, as often as it is drawn. */
static inline bool gi_shape_before(
    const GiShapes *shapes, GiShapeRef a, uint32_t instance_a, GiShapeRef b, uint32_t instance_b) {
    bool light_a = gi_shape_kind(a) == GI_SHAPE_RECTANGLE;
    if (light_a != (gi_shape_kind(b) == GI_SHAPE_RECTANGLE)) return light_a;
    uint32_t order_a = gi_shape_info(shapes, a, instance_a)->order;
    uint32_t order_b = gi_shape_info(shapes, b, instance_b)->order;
    if (order_a != order_b) return order_a < order_b;
    if (instance_a != instance_b) return instance_a < instance_b;
    const uint32_t *original = shapes->triangles.original;
    if (gi_shape_kind(a) == GI_SHAPE_TRIANGLE && original != NULL) {
        return original[gi_shape_index(a)] < original[gi_shape_index(b)];
    }
    return a.bits < b.bits;
}

/* The corners of a triangle. */
static inline void gi_triangle_corners(
    const GiTriangles *triangles, uint32_t triangle, const float *corners[3]) {
    const uint32_t *rows = triangles->corners[triangle];
    for (int i = 0; i < 3; i++) corners[i] = triangles->positions[rows[i]];
}

/* A mesh's row of corner indices into the normals or the texture coordinates: those of its own,
 * `rows`, or, where it has none, the positions' rows, counted from `first`. False: the triangle has
 * no such corners. */
static inline bool gi_triangle_row(const GiTriangles *triangles, uint32_t triangle,
    const GiMesh *mesh, uint32_t (*const rows)[3], uint32_t first, uint32_t row[3]) {
    for (int i = 0; i < 3; i++) {
        row[i] = rows != NULL ? rows[triangle - mesh->first_triangle][i]
                              : triangles->corners[triangle][i] - mesh->first_position + first;
    }
    return row[0] != GI_SHAPE_NONE;
}

/* The same of normals alone. */
static inline bool gi_triangle_normals(
    const GiShapes *shapes, uint32_t triangle, const GiMesh *mesh, uint32_t row[3]) {
    return mesh->smooth && gi_triangle_row(&shapes->triangles, triangle, mesh, mesh->normal_corners,
                               mesh->first_normal, row);
}

/* The smallest box round a shape or an instance; infinite for a plane. Empty (low above high) for a
 * triangle without area: it can not be met, and is left out of trees. */
GiBox gi_shape_bounds(const GiShapes *shapes, GiShapeRef ref, uint32_t instance);

/* The point where a ray (origin, direction) met the shape at t, moved onto the surface to the last
 * bits, the unit normal to shade with and the one of the surface itself; both outward. They differ
 * on a smooth mesh, and on a cone's second nappe unless second_nappe_geometric (see
 * GiRules.cone_geometric). A ray that starts at the point may find the same surface again within
 * the distance `error`, by rounding alone: the numbers the point and the test are made of, times
 * GI_SURFACE_ERROR. */
typedef struct GiSurfacePoint {
    GiVec point, normal, geometric;
    double error;
} GiSurfacePoint;

/* 2048 roundings. A point on a surface and the test of a ray from it take about forty, and where
 * the ray leaves at a slant the error along it is larger by 1 / cosine: 2048 covers all but the
 * last degree, where the light that a wrong hit would take away is next to nothing. */
#define GI_SURFACE_ERROR 0x1p-42

GiSurfacePoint gi_shape_point(const GiShapes *shapes, GiShapeRef ref, uint32_t instance,
    GiVec origin, GiVec direction, double t, bool second_nappe_geometric);

/* Puts the normal as normal_faults have it in the place of the right one, of the same ray. */
void gi_shape_spoil_normal(const GiShapes *shapes, GiShapeRef ref, uint32_t instance, GiVec origin,
    GiVec direction, GiSurfacePoint *at);

/* Texture coordinates by a sphere's unit normal. */
void gi_sphere_texcoord(GiVec normal, double uv[2]);

/* Texture coordinates of a point of the surface: of spheres and of meshes that have them, otherwise
 * (0, 0). */
void gi_shape_texcoord(
    const GiShapes *shapes, GiShapeRef ref, uint32_t instance, GiVec point, double uv[2]);
