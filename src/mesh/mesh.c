/* SPDX-License-Identifier: MIT */
#include "mesh/mesh.h"

#include "mesh/input.h"
#include "port/file.h"
#include "port/machine.h"

#include <float.h>
#include <string.h>

enum {
    CHUNK_SIZE = 256 * 1024, /* small enough to ask the monitor often, large enough to be cheap */
    THREAD_SIZE = 2 * 1024 * 1024 /* with less to do a thread takes longer to start than to help */
};

/* ---------------------------------------------------------------- store */

/* Room for more elements, exactly: the last mesh is the largest as a rule, and doubling would hold
 * twice of what is needed. An eighth more when that is not much, for scenes of many small files. */
static bool reserve(
    GiMemory *memory, void **data, size_t *capacity, size_t count, size_t more, size_t size) {
    if (more <= *capacity - count) return true;
    size_t wanted = count + more, bytes;
    if (wanted < *capacity + *capacity / 8) wanted = *capacity + *capacity / 8;
    if (!gi_size_multiply(wanted, size, &bytes)) return false;
    void *grown = gi_memory_resize(memory, *data, *capacity * size, bytes);
    if (grown == NULL) return false;
    if (*capacity == 0) gi_machine_large_pages(grown, bytes);
    *data = grown;
    *capacity = wanted;
    return true;
}

#define RESERVE(memory, array, more)                                                               \
    reserve((memory), (void **)&(array)->data, &(array)->capacity, (array)->count, (more),         \
        sizeof *(array)->data)

/* Gives back room that a mesh asked for and did not take. */
static void shrink(GiMemory *memory, void **data, size_t *capacity, size_t count, size_t size) {
    if (*capacity - count <= *capacity / 8) return;
    void *shrunk = gi_memory_resize(memory, *data, *capacity * size, count * size);
    if (shrunk == NULL && count > 0) return;
    *data = shrunk;
    *capacity = count;
}

#define SHRINK(memory, array)                                                                      \
    shrink((memory), (void **)&(array)->data, &(array)->capacity, (array)->count,                  \
        sizeof *(array)->data)

GlintStatus gi_mesh_check_triangles(size_t count, GiMeshFault *fault) {
    if (count > 0) return GLINT_OK;
    return gi_mesh_fault(fault, GLINT_ERROR_SCENE, "the mesh has no triangles");
}

GlintStatus gi_mesh_begin(GiMeshStore *store, GiMemory *memory, const GiMeshCounts *counts,
    GiMesh *mesh, GiMeshRoom *room, GiMeshFault *fault) {
    if (counts->triangles > GI_SHAPE_INDEX_LIMIT - store->corners.count) {
        return gi_mesh_fault(fault, GLINT_ERROR_SCENE,
            "the meshes of the scene would have more than %u triangles", GI_SHAPE_INDEX_LIMIT);
    }
    if (counts->positions >= GI_SHAPE_NONE - store->positions.count ||
        counts->normals >= GI_SHAPE_NONE - store->normals.count ||
        counts->texcoords >= GI_SHAPE_NONE - store->texcoords.count) {
        return gi_mesh_fault(fault, GLINT_ERROR_SCENE,
            "the meshes of the scene would have more than %u vertices", GI_SHAPE_NONE - 1);
    }
    if (!RESERVE(memory, &store->positions, counts->positions) ||
        !RESERVE(memory, &store->normals, counts->normals) ||
        !RESERVE(memory, &store->texcoords, counts->texcoords) ||
        !RESERVE(memory, &store->corners, counts->triangles) ||
        !gi_array_reserve(memory, &store->meshes, 1)) {
        return gi_mesh_fault(fault, GLINT_ERROR_MEMORY, "not enough memory");
    }
    *mesh = (GiMesh){.first_triangle = (uint32_t)store->corners.count,
        .triangle_count = (uint32_t)counts->triangles,
        .first_position = (uint32_t)store->positions.count,
        .position_count = (uint32_t)counts->positions,
        .first_normal = (uint32_t)store->normals.count,
        .first_texcoord = (uint32_t)store->texcoords.count};
    *room = (GiMeshRoom){NULL, NULL, NULL, NULL};
    if (counts->positions > 0) room->positions = store->positions.data + store->positions.count;
    if (counts->normals > 0) room->normals = store->normals.data + store->normals.count;
    if (counts->texcoords > 0) room->texcoords = store->texcoords.data + store->texcoords.count;
    if (counts->triangles > 0) room->corners = store->corners.data + store->corners.count;
    return GLINT_OK;
}

uint32_t gi_mesh_end(
    GiMeshStore *store, GiMemory *memory, const GiMeshCounts *counts, const GiMesh *mesh) {
    store->positions.count += counts->positions;
    store->normals.count += mesh->smooth ? counts->normals : 0;
    store->texcoords.count += mesh->textured ? counts->texcoords : 0;
    store->corners.count += counts->triangles;
    SHRINK(memory, &store->normals);
    SHRINK(memory, &store->texcoords);
    store->meshes.data[store->meshes.count] = *mesh;
    return (uint32_t)store->meshes.count++;
}

static void free_corners(GiMemory *memory, const GiMesh *mesh, GiCorners *corners) {
    gi_memory_free(memory, corners, mesh->triangle_count * sizeof *corners);
}

void gi_mesh_store_free(GiMeshStore *store, GiMemory *memory) {
    for (size_t i = 0; i < store->meshes.count; i++) {
        const GiMesh *mesh = &store->meshes.data[i];
        free_corners(memory, mesh, mesh->normal_corners);
        free_corners(memory, mesh, mesh->texcoord_corners);
    }
    gi_array_free(memory, &store->positions);
    gi_array_free(memory, &store->normals);
    gi_array_free(memory, &store->texcoords);
    gi_array_free(memory, &store->corners);
    gi_array_free(memory, &store->meshes);
}

/* ---------------------------------------------------------------- by calls */

static bool is_finite(const float *values, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (!(values[i] >= -FLT_MAX && values[i] <= FLT_MAX)) return false;
    }
    return true;
}

static GlintStatus check_arrays(const GiMeshArrays *arrays, GiMeshFault *fault) {
    size_t count = arrays->vertex_count;
    if (!is_finite((const float *)arrays->positions, count * 3) ||
        (arrays->normals != NULL && !is_finite((const float *)arrays->normals, count * 3)) ||
        (arrays->texcoords != NULL && !is_finite((const float *)arrays->texcoords, count * 2))) {
        return gi_mesh_fault(fault, GLINT_ERROR_SCENE, "a number of the mesh is not finite");
    }
    for (size_t i = 0; i < arrays->triangle_count; i++) {
        for (int k = 0; k < 3; k++) {
            if (arrays->triangles[i][k] >= count) {
                return gi_mesh_fault(fault, GLINT_ERROR_SCENE,
                    "triangle %zu names vertex %u, but there are %zu", i, arrays->triangles[i][k],
                    count);
            }
        }
    }
    return GLINT_OK;
}

GlintStatus gi_mesh_add(GiMeshStore *store, GiMemory *memory, const GiMeshArrays *arrays,
    uint32_t *index, GiMeshFault *fault) {
    size_t count = arrays->vertex_count;
    GiMeshCounts counts = {count, arrays->normals != NULL ? count : 0,
        arrays->texcoords != NULL ? count : 0, arrays->triangle_count};
    GiMesh mesh;
    GiMeshRoom room;
    GlintStatus status = gi_mesh_check_triangles(counts.triangles, fault);
    if (status == GLINT_OK) status = check_arrays(arrays, fault);
    if (status == GLINT_OK) status = gi_mesh_begin(store, memory, &counts, &mesh, &room, fault);
    if (status != GLINT_OK) return status;
    mesh.smooth = arrays->normals != NULL;
    mesh.textured = arrays->texcoords != NULL;
    memcpy(room.positions, arrays->positions, count * sizeof *room.positions);
    if (mesh.smooth) memcpy(room.normals, arrays->normals, count * sizeof *room.normals);
    if (mesh.textured) memcpy(room.texcoords, arrays->texcoords, count * sizeof *room.texcoords);
    for (size_t i = 0; i < arrays->triangle_count; i++) {
        for (int k = 0; k < 3; k++)
            room.corners[i][k] = mesh.first_position + arrays->triangles[i][k];
    }
    *index = gi_mesh_end(store, memory, &counts, &mesh);
    return GLINT_OK;
}

/* ---------------------------------------------------------------- from files */

static bool ends_with(const char *path, const char *extension) {
    size_t length = strlen(path), wanted = strlen(extension);
    if (length < wanted) return false;
    for (const char *p = path + length - wanted; *p != '\0'; p++, extension++) {
        char lower = *p >= 'A' && *p <= 'Z' ? (char)(*p - 'A' + 'a') : *p;
        if (lower != *extension) return false;
    }
    return true;
}

GiMeshFormat gi_mesh_format(const char *path) {
    static const char extensions[GI_MESH_FORMAT_COUNT][5] = {".msh", ".obj", ".ply"};
    int format = 0;
    while (format < GI_MESH_FORMAT_COUNT && !ends_with(path, extensions[format])) format++;
    return (GiMeshFormat)format;
}

static GlintStatus parse(
    GiMeshInput *input, GiMeshFormat format, GiMeshStore *store, uint32_t *mesh) {
    switch (format) {
    case GI_MESH_MSH: return gi_mesh_parse_msh(input, store, mesh);
    case GI_MESH_OBJ: return gi_mesh_parse_obj(input, store, mesh);
    case GI_MESH_PLY: return gi_mesh_parse_ply(input, store, mesh);
    case GI_MESH_FORMAT_COUNT: break;
    }
    return gi_mesh_fault(
        input->fault, GLINT_ERROR_SCENE, "the name of a mesh file ends in .msh, .obj or .ply");
}

static GlintStatus read_source(GiMeshStore *store, GiMemory *memory, const GiMeshSource *source,
    const GiFileBytes *file, uint32_t *mesh, GiMeshFault *fault) {
    GiMeshInput input = {.memory = memory,
        .text = source->bytes,
        .end = source->bytes + source->size,
        .chunk_size = source->chunk_size > 0 ? source->chunk_size : CHUNK_SIZE,
        .worker_count = 1,
        .monitor = source->monitor,
        .has_lines = true,
        .fault = fault,
        .file = file};
    int thread_count = source->thread_count;
    if (thread_count <= 0) thread_count = gi_machine_core_count();
    if (source->chunk_size == 0 && source->size / THREAD_SIZE < (size_t)thread_count) {
        thread_count = (int)(source->size / THREAD_SIZE);
    }
    GlintStatus status = GLINT_OK;
    if (thread_count > 1) status = gi_pool_create(memory, thread_count, &input.pool);
    if (status != GLINT_OK) return gi_mesh_fault(fault, status, "%s", glint_status_text(status));
    if (input.pool != NULL) input.worker_count = gi_pool_worker_count(input.pool);
    size_t size = (size_t)input.worker_count * sizeof *input.findings;
    input.findings = gi_memory_allocate(memory, size);
    if (input.findings == NULL) {
        status = gi_mesh_fault(fault, GLINT_ERROR_MEMORY, "not enough memory");
    } else {
        memset(input.findings, 0, size);
        status = parse(&input, source->format, store, mesh);
    }
    gi_memory_free(memory, input.findings, size);
    gi_pool_destroy(input.pool);
    return status;
}

GlintStatus gi_mesh_read(GiMeshStore *store, GiMemory *memory, const GiMeshSource *source,
    uint32_t *mesh, GiMeshFault *fault) {
    return read_source(store, memory, source, NULL, mesh, fault);
}

static GlintStatus map_file(GiFileBytes *file, GiMemory *memory, const char *path,
    const GlintMonitor *monitor, GiMeshFault *fault) {
    GlintError error = {.message = ""};
    GlintStatus status = gi_file_bytes_load(file, memory, path, monitor, &error);
    if (status == GLINT_CANCELLED) gi_error_set(&error, status, "%s", glint_status_text(status));
    return status == GLINT_OK ? status : gi_mesh_fault(fault, status, "%s", error.message);
}

GlintStatus gi_mesh_load(GiMeshStore *store, GiMemory *memory, int thread_count, const char *path,
    const GiFileBytes *bytes, const GlintMonitor *monitor, uint32_t *mesh, GiMeshFault *fault) {
    GiMeshSource source = {
        .format = gi_mesh_format(path), .thread_count = thread_count, .monitor = monitor};
    GiFileBytes own = {.bytes = NULL};
    const GiFileBytes *file = bytes != NULL ? bytes : &own;
    if (bytes == NULL && source.format != GI_MESH_FORMAT_COUNT) {
        GlintStatus status = map_file(&own, memory, path, monitor, fault);
        if (status != GLINT_OK) return status;
    }
    /* An empty file has no address, which arithmetic on pointers would like to see. */
    source.bytes = file->bytes != NULL ? file->bytes : "";
    source.size = file->size;
    GlintStatus status = read_source(store, memory, &source, file, mesh, fault);
    gi_file_bytes_free(&own, memory);
    return status;
}
