/* SPDX-License-Identifier: MIT
 * The meshes of a scene: the triangles of all files in common arrays, so that a triangle is one
 * index whatever mesh it is of. */
#pragma once

#include "base/array.h"
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

void gi_mesh_store_free(GiMeshStore *store, GiMemory *memory);
