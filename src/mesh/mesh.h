/* SPDX-License-Identifier: MIT
 * The meshes of a scene: the triangles of all files in common arrays, so that a triangle is one
 * index whatever mesh it is of. A mesh is added whole or not at all.
 *
 * All indices count from the first of the scene-wide arrays: corners name positions, normal_corners
 * normals, texcoord_corners texture coordinates. Where a mesh has no corners of their own for
 * these, the normal of position p is first_normal + (p - first_position), likewise the texcoord. */
#pragma once

#include "base/array.h"
#include "port/file.h"
#include "shape/shape.h"

typedef float GiFloat3[3];
typedef float GiFloat2[2];
typedef uint32_t GiCorners[3];

typedef struct GiMeshStore {
    GI_ARRAY(GiFloat3) positions, normals;
    GI_ARRAY(GiFloat2) texcoords;
    GI_ARRAY(GiCorners) corners;
    GI_ARRAY(GiMesh) meshes;
} GiMeshStore;

/* Why a mesh was refused: one sentence without a full stop, and the line of the file, counted from
 * 1; 0 where there is none. */
typedef struct GiMeshFault {
    uint64_t line;
    char message[256];
} GiMeshFault;

typedef enum GiMeshFormat {
    GI_MESH_MSH,
    GI_MESH_OBJ,
    GI_MESH_PLY,
    GI_MESH_FORMAT_COUNT /* no format */
} GiMeshFormat;

/* By the extension of the name, in capitals or not. */
GiMeshFormat gi_mesh_format(const char *path);

/* Reads a file and adds its mesh, which gets the index *mesh. bytes: what is in the file, for
 * callers that have it, of which nothing stays in memory that need not; null: it is opened here.
 * thread_count 0: one per core; only a large file takes more than one thread. monitor may be null,
 * and is called on this thread only.
 * A mesh has at least one triangle. Errors, with *fault filled: SCENE (what the file says), FILE,
 * MEMORY, THREAD, CANCELLED; the store then holds what it held. */
GlintStatus gi_mesh_load(GiMeshStore *store, GiMemory *memory, int thread_count, const char *path,
    const GiFileBytes *bytes, const GlintMonitor *monitor, uint32_t *mesh, GiMeshFault *fault);

/* The same from memory. */
typedef struct GiMeshSource {
    const char *bytes; /* not kept */
    size_t size;
    GiMeshFormat format;
    int thread_count;
    size_t chunk_size; /* bytes parsed at a time by one thread; 0: a good one */
    const GlintMonitor *monitor;
} GiMeshSource;
GlintStatus gi_mesh_read(GiMeshStore *store, GiMemory *memory, const GiMeshSource *source,
    uint32_t *mesh, GiMeshFault *fault);

/* A mesh by calls: normals and texcoords, one a vertex, may be null. All are copied. Errors: SCENE
 * (an index without vertex, a number that is not finite, no triangles, too many), MEMORY. */
typedef struct GiMeshArrays {
    const GiFloat3 *positions, *normals;
    const GiFloat2 *texcoords;
    const GiCorners *triangles;
    size_t vertex_count, triangle_count;
} GiMeshArrays;
GlintStatus gi_mesh_add(GiMeshStore *store, GiMemory *memory, const GiMeshArrays *arrays,
    uint32_t *mesh, GiMeshFault *fault);

void gi_mesh_store_free(GiMeshStore *store, GiMemory *memory);
