/* SPDX-License-Identifier: MIT */
#include "mesh/mesh.h"

void gi_mesh_store_free(GiMeshStore *store, GiMemory *memory) {
    for (size_t i = 0; i < store->meshes.count; i++) {
        const GiMesh *mesh = &store->meshes.data[i];
        size_t size = mesh->triangle_count * sizeof *mesh->normal_corners;
        if (mesh->normal_corners != NULL) gi_memory_free(memory, mesh->normal_corners, size);
        if (mesh->texcoord_corners != NULL) gi_memory_free(memory, mesh->texcoord_corners, size);
    }
    gi_array_free(memory, &store->positions);
    gi_array_free(memory, &store->normals);
    gi_array_free(memory, &store->texcoords);
    gi_array_free(memory, &store->corners);
    gi_array_free(memory, &store->meshes);
}
