/* SPDX-License-Identifier: MIT
 * Loading a mesh from memory, and whether it comes out the same for any number of threads and any
 * borders of chunks. For the tests of mesh files. */
#pragma once

#include "test.h"

#include "mesh/mesh.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

typedef struct Loaded {
    GiMemory memory;
    GiMeshStore store;
    GiMeshFault fault;
    GlintStatus status;
    uint32_t mesh;
} Loaded;

static inline void load_more(Loaded *loaded, GiMeshFormat format, const char *bytes, size_t size,
    int thread_count, size_t chunk_size) {
    GiMeshSource source = {.bytes = bytes,
        .size = size,
        .format = format,
        .thread_count = thread_count,
        .chunk_size = chunk_size};
    loaded->fault = (GiMeshFault){0};
    loaded->mesh = UINT32_MAX;
    loaded->status =
        gi_mesh_read(&loaded->store, &loaded->memory, &source, &loaded->mesh, &loaded->fault);
}

static inline void load(Loaded *loaded, GiMeshFormat format, const char *text) {
    memset(loaded, 0, sizeof *loaded);
    gi_memory_init(&loaded->memory, NULL, 0);
    load_more(loaded, format, text, strlen(text), 1, 0);
}

static inline void unload(Loaded *loaded) {
    gi_mesh_store_free(&loaded->store, &loaded->memory);
    CHECK_INT(loaded->memory.used, 0);
}

/* The mesh as text, with all references followed, so that two of them can be compared. */
static inline char *describe(const Loaded *loaded) {
    static char texts[2][1 << 16];
    static int turn;
    char *text = texts[turn ^= 1], *end = text + sizeof texts[0], *p = text;
    *p = '\0';
    if (loaded->status != GLINT_OK) {
        snprintf(
            text, sizeof texts[0], "%" PRIu64 ": %s", loaded->fault.line, loaded->fault.message);
        return text;
    }
    const GiMeshStore *store = &loaded->store;
    const GiMesh *mesh = &store->meshes.data[loaded->mesh];
    for (uint32_t i = 0; i < mesh->triangle_count && end - p > 400; i++) {
        for (int k = 0; k < 3; k++) {
            uint32_t at = store->corners.data[mesh->first_triangle + i][k];
            const float *position = store->positions.data[at];
            p += sprintf(p, "%g %g %g", position[0], position[1], position[2]);
            uint32_t normal = at - mesh->first_position + mesh->first_normal, texcoord;
            if (mesh->normal_corners != NULL) {
                normal = mesh->normal_corners[i][k];
                if (mesh->normal_corners[i][0] == GI_SHAPE_NONE) normal = GI_SHAPE_NONE;
            }
            if (mesh->smooth && normal != GI_SHAPE_NONE) {
                const float *n = store->normals.data[normal];
                p += sprintf(p, " n %g %g %g", n[0], n[1], n[2]);
            }
            texcoord = at - mesh->first_position + mesh->first_texcoord;
            if (mesh->texcoord_corners != NULL) {
                texcoord = mesh->texcoord_corners[i][k];
                if (mesh->texcoord_corners[i][0] == GI_SHAPE_NONE) texcoord = GI_SHAPE_NONE;
            }
            if (mesh->textured && texcoord != GI_SHAPE_NONE) {
                const float *t = store->texcoords.data[texcoord];
                p += sprintf(p, " t %g %g", t[0], t[1]);
            }
            p += sprintf(p, k < 2 ? ", " : "; ");
        }
    }
    return text;
}

/* What a text gives, and that it gives the same for any borders and numbers of threads. */
static inline void check_bytes(
    GiMeshFormat format, const char *bytes, size_t size, const char *expected) {
    static const char *const extensions[] = {"msh", "obj", "ply"};
    static const int thread_counts[] = {1, 2, 3, 8};
    static const size_t chunk_sizes[] = {1, 2, 3, 5, 17, 64, 1000};
    for (size_t i = 0; i < sizeof chunk_sizes / sizeof chunk_sizes[0]; i++) {
        Loaded loaded = {.status = GLINT_OK};
        gi_memory_init(&loaded.memory, NULL, 0);
        load_more(&loaded, format, bytes, size, thread_counts[i % 4], chunk_sizes[i]);
        const char *text = describe(&loaded);
        if (strcmp(text, expected) != 0) {
            test_fail(__FILE__, __LINE__, "%s in chunks of %zu: \"%.60s\" is \"%s\", not \"%s\"",
                extensions[format], chunk_sizes[i], bytes, text, expected);
            i = sizeof chunk_sizes;
        }
        unload(&loaded);
    }
}

static inline void check(GiMeshFormat format, const char *text, const char *expected) {
    check_bytes(format, text, strlen(text), expected);
}
