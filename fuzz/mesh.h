/* SPDX-License-Identifier: MIT
 * Feeds bytes to the loader of a mesh format, whole, in small chunks and to two threads, and checks
 * that all give the same outcome, that a good mesh names nothing that is not there, that memory is
 * bounded by the size of the input, and that none is left. */
#pragma once

#include "mesh/mesh.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void require(bool condition, const char *what) {
    if (condition) return;
    fprintf(stderr, "fuzz: %s\n", what);
    abort();
}

static uint32_t hash_bytes(uint32_t hash, const void *bytes, size_t size) {
    const uint8_t *p = bytes;
    for (size_t i = 0; i < size; i++) hash = (hash ^ p[i]) * UINT32_C(16777619);
    return hash;
}

static uint32_t check_own_corners(const GiMesh *mesh, uint32_t (*corners)[3], size_t count) {
    if (corners == NULL) return 0;
    uint32_t hash = 1;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        bool none = corners[i][0] == GI_SHAPE_NONE;
        for (int k = 0; k < 3 && !none; k++) {
            require(corners[i][k] < count, "a corner names what is not there");
        }
        hash = hash_bytes(hash, corners[i], none ? sizeof corners[i][0] : sizeof corners[i]);
    }
    return hash;
}

static uint32_t check_mesh(const GiMeshStore *store) {
    require(store->meshes.count == 1, "not one mesh");
    const GiMesh *mesh = &store->meshes.data[0];
    require(mesh->triangle_count > 0, "no triangles");
    require(mesh->triangle_count == store->corners.count, "corners without triangles");
    require(mesh->position_count == store->positions.count, "vertices of no mesh");
    require(mesh->smooth == (store->normals.count > 0), "normals of no mesh");
    require(mesh->textured == (store->texcoords.count > 0), "texture coordinates of no mesh");
    bool own_normals = mesh->normal_corners != NULL, own_texcoords = mesh->texcoord_corners != NULL;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        for (int k = 0; k < 3; k++) {
            uint32_t at = store->corners.data[i][k];
            require(at < store->positions.count, "a corner names no vertex");
            require(!mesh->smooth || own_normals || at < store->normals.count, "no normal");
            require(!mesh->textured || own_texcoords || at < store->texcoords.count, "no texcoord");
        }
    }
    uint32_t hash = hash_bytes(check_own_corners(mesh, mesh->normal_corners, store->normals.count),
        store->corners.data, store->corners.count * sizeof *store->corners.data);
    hash ^= check_own_corners(mesh, mesh->texcoord_corners, store->texcoords.count);
    hash = hash_bytes(
        hash, store->positions.data, store->positions.count * sizeof *store->positions.data);
    hash =
        hash_bytes(hash, store->normals.data, store->normals.count * sizeof *store->normals.data);
    return hash_bytes(
        hash, store->texcoords.data, store->texcoords.count * sizeof *store->texcoords.data);
}

/* A number that stands for the outcome. */
static uint32_t load(
    GiMeshFormat format, const uint8_t *data, size_t size, size_t chunk_size, int thread_count) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    GiMeshStore store = {.meshes = {.count = 0}};
    GiMeshSource source = {.bytes = (const char *)data,
        .size = size,
        .format = format,
        .thread_count = thread_count,
        .chunk_size = chunk_size};
    GiMeshFault fault = {.line = 0};
    uint32_t mesh, hash;
    GlintStatus status = gi_mesh_read(&store, &memory, &source, &mesh, &fault);
    if (status == GLINT_OK) {
        hash = check_mesh(&store);
    } else {
        require(status == GLINT_ERROR_SCENE, "a status that input cannot cause");
        require(fault.message[0] != '\0', "a fault without a message");
        require(fault.line <= size + 1, "a line that is not there");
        for (const char *p = fault.message; *p != '\0'; p++) {
            require(*p >= ' ' && *p <= '~', "a message that cannot be printed");
        }
        require(store.meshes.count == 0 && store.corners.count == 0, "half a mesh is left");
        hash = hash_bytes((uint32_t)fault.line, fault.message, strlen(fault.message));
    }
    gi_mesh_store_free(&store, &memory);
    require(memory.used == 0, "memory is left");
    require(chunk_size > 0 || memory.peak <= 48 * size + 4096, "too much memory");
    return hash;
}

static int fuzz(GiMeshFormat format, const uint8_t *data, size_t size) {
    uint32_t hash = load(format, data, size, 0, 1);
    require(hash == load(format, data, size, 1, 1), "the outcome depends on chunks of 1");
    require(hash == load(format, data, size, 13, 2), "the outcome depends on threads");
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
