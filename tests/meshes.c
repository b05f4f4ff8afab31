/* SPDX-License-Identifier: MIT */
#include "meshes.h"

#include "test.h"

GiMesh *mesh_begin(GiScene *scene) {
    GiMeshStore *store = &scene->meshes;
    GiMesh mesh = {.first_triangle = (uint32_t)store->corners.count,
        .first_position = (uint32_t)store->positions.count,
        .first_normal = (uint32_t)store->normals.count,
        .first_texcoord = (uint32_t)store->texcoords.count};
    CHECK(gi_array_push(scene->memory, &store->meshes, mesh));
    return &store->meshes.data[store->meshes.count - 1];
}

static GiMesh *last_mesh(GiScene *scene) {
    return &scene->meshes.meshes.data[scene->meshes.meshes.count - 1];
}

void mesh_position(GiScene *scene, GiVec p) {
    GiMeshStore *store = &scene->meshes;
    CHECK(gi_array_reserve(scene->memory, &store->positions, 1));
    float *position = store->positions.data[store->positions.count++];
    position[0] = (float)p.x, position[1] = (float)p.y, position[2] = (float)p.z;
    last_mesh(scene)->position_count++;
}

void mesh_triangle(GiScene *scene, uint32_t a, uint32_t b, uint32_t c) {
    GiMeshStore *store = &scene->meshes;
    GiMesh *mesh = last_mesh(scene);
    CHECK(gi_array_reserve(scene->memory, &store->corners, 1));
    uint32_t *row = store->corners.data[store->corners.count++];
    row[0] = mesh->first_position + a;
    row[1] = mesh->first_position + b;
    row[2] = mesh->first_position + c;
    mesh->triangle_count++;
}

GiShapeRef mesh_surface(GiScene *scene) {
    GiMeshSurface surface = {(uint32_t)scene->meshes.meshes.count - 1, {0, scene->shape_count++}};
    CHECK(gi_array_push(scene->memory, &scene->mesh_surfaces, surface));
    return gi_shape_ref(GI_SHAPE_MESH, (uint32_t)scene->mesh_surfaces.count - 1);
}

static void shuffle(GiScene *scene, Random *random) {
    const GiMesh *mesh = last_mesh(scene);
    GiCorners *rows = scene->meshes.corners.data + mesh->first_triangle;
    for (uint32_t i = mesh->triangle_count; i > 1; i--) {
        uint32_t k = (uint32_t)random_below(random, (int)i);
        for (int j = 0; j < 3; j++) {
            uint32_t swap = rows[i - 1][j];
            rows[i - 1][j] = rows[k][j];
            rows[k][j] = swap;
        }
    }
}

GiShapeRef mesh_sphere(GiScene *scene, GiVec center, double size, int rings, double bumps,
    bool smooth, bool shuffled, Random *random) {
    const double pi = 3.14159265358979324;
    GiMesh *mesh = mesh_begin(scene);
    mesh->smooth = smooth;
    int around = 2 * rings;
    for (int y = 0; y <= rings; y++) {
        for (int x = 0; x < around; x++) {
            double polar = pi * y / rings, angle = pi * x / rings;
            GiVec n = gi_vec(sin(polar) * cos(angle), cos(polar), sin(polar) * sin(angle));
            double radius = size * (1 + bumps * random_real(random, -1, 1));
            if (y == 0 || y == rings) {
                if (x > 0) continue; /* one pole each */
                radius = size;
            }
            mesh_position(scene, gi_along(center, n, radius));
            if (!smooth) continue;
            CHECK(gi_array_reserve(scene->memory, &scene->meshes.normals, 1));
            float *normal = scene->meshes.normals.data[scene->meshes.normals.count++];
            normal[0] = (float)n.x, normal[1] = (float)n.y, normal[2] = (float)n.z;
        }
    }
    uint32_t last = (uint32_t)((rings - 1) * around + 1);
    for (int y = 0; y < rings; y++) {
        for (int x = 0; x < around; x++) {
            uint32_t next = (uint32_t)((x + 1) % around), at = (uint32_t)x;
            uint32_t up = (uint32_t)((y - 1) * around + 1), down = up + (uint32_t)around;
            uint32_t a = y == 0 ? 0 : up + at, b = y == 0 ? 0 : up + next;
            uint32_t c = y == rings - 1 ? last : down + at, d = y == rings - 1 ? last : down + next;
            if (y > 0) mesh_triangle(scene, a, b, c);
            if (y < rings - 1) mesh_triangle(scene, b, d, c);
        }
    }
    if (shuffled) shuffle(scene, random);
    return mesh_surface(scene);
}

GiShapeRef mesh_soup(GiScene *scene, GiVec at, double size, int count, Random *random) {
    mesh_begin(scene);
    for (int i = 0; i < count; i++) {
        GiVec a = gi_add(at, random_vec(random, -size, size)), b, c;
        double reach = size * pow(10, random_real(random, -3, 0));
        b = gi_add(a, random_vec(random, -reach, reach));
        c = gi_add(a, random_vec(random, -reach, reach));
        switch (random_below(random, 8)) {
        case 0: c = gi_along(a, gi_sub(b, a), 1e-6); break;                         /* a needle */
        case 1: c = gi_add(gi_scale(gi_add(a, b), 0.5), gi_vec(0, 0, 1e-6)); break; /* a sliver */
        case 2: b = c = a; break;                                                   /* a point */
        case 3: b = gi_vec(b.x, a.y, a.z), c = gi_vec(a.x, c.y, a.z); break;        /* on an axis */
        case 4: c = gi_along(a, gi_sub(b, a), 2); break; /* a line, nearly */
        default: break;
        }
        uint32_t first = last_mesh(scene)->position_count;
        mesh_position(scene, a);
        mesh_position(scene, b);
        mesh_position(scene, c);
        mesh_triangle(scene, first, first + 1, first + 2);
        if (i % 10 == 0) mesh_triangle(scene, first + 1, first, first + 2);
    }
    return mesh_surface(scene);
}
