/* SPDX-License-Identifier: MIT
 * Triangles: closed surfaces are closed to every ray, hits agree with a second formula, and points,
 * normals and texture coordinates are what the corners say. */
#include "test.h"

#include "math/elementary.h"
#include "meshes.h"
#include "render/world.h"
#include "shape/hit.h"

#include <string.h>

typedef struct Fixture {
    GiMemory memory;
    GiScene scene;
    GiWorld world;
    GiPool *pool;
} Fixture;

static void fixture_begin(Fixture *f) {
    memset(f, 0, sizeof *f);
    gi_memory_init(&f->memory, NULL, 0);
    CHECK(gi_scene_init(&f->scene, &f->memory));
    f->scene.dialect = GLINT_DIALECT_GLINT;
    f->scene.has_camera = f->scene.has_image = true;
    f->scene.width = f->scene.height = 16;
}

static void fixture_commit(Fixture *f) {
    GlintError error;
    CHECK_INT(gi_pool_create(&f->memory, 2, &f->pool), GLINT_OK);
    const GiKernel *kernel = gi_kernel_at(0);
    CHECK_INT(gi_world_commit(&f->world, &f->scene, kernel, f->pool, NULL, &error), GLINT_OK);
}

static void fixture_end(Fixture *f) {
    gi_world_reset(&f->world, &f->memory);
    gi_pool_destroy(f->pool);
    gi_scene_reset(&f->scene);
    CHECK_INT(atomic_load(&f->memory.used), 0);
}

static GiTraceRay ray_of(GiVec origin, GiVec direction) {
    return (GiTraceRay){origin, direction, 0, INFINITY, GI_SHAPE_NONE, GI_SHAPE_NONE};
}

/* ---------------------------------------------------------------- watertight */

/* A point of the surface that is easily missed: a corner, a point of an edge, or any. */
static GiVec surface_point(const Fixture *f, Random *random) {
    const GiMeshStore *store = &f->scene.meshes;
    const uint32_t *row = store->corners.data[random_below(random, (int)store->corners.count)];
    GiVec p[3];
    for (int i = 0; i < 3; i++) {
        const float *q = store->positions.data[row[i]];
        p[i] = gi_vec(q[0], q[1], q[2]);
    }
    double u = random_real(random, 0, 1), v = random_real(random, 0, 1 - u);
    switch (random_below(random, 4)) {
    case 0: return p[0];
    case 1: return gi_along(p[0], gi_sub(p[1], p[0]), u);
    case 2: return gi_scale(gi_add(p[1], p[2]), 0.5);
    default: return gi_along(gi_along(p[0], gi_sub(p[1], p[0]), u), gi_sub(p[2], p[0]), v);
    }
}

/* Rays through a closed surface round `at`: one from inside meets it, and so does one that starts
 * outside and passes through a point of it to the inside. Rough: only of the centre is it known
 * that all of the surface is seen from there. */
static void check_closed(
    const Fixture *f, GiVec at, double size, bool rough, int rays, const char *what) {
    Random random = {3};
    int lost = 0;
    for (int i = 0; i < rays; i++) {
        GiVec target = surface_point(f, &random);
        GiVec inside = gi_add(at, random_vec(&random, -0.3 * size, 0.3 * size));
        if (i % 3 == 0 || rough) inside = at;
        GiVec d = gi_sub(target, inside);
        if (i % 5 == 0) d = gi_scale(d, 1e-3);
        if (i % 7 == 0) d = gi_vec(0, 0, d.z < 0 ? -1 : 1);
        GiTraceRay ray = ray_of(inside, d);
        GiTraceHit hit;
        const GiKernel *kernel = gi_kernel_at(i % 2 == 0 ? 0 : 1);
        if (kernel == NULL) kernel = gi_kernel_at(0);
        bool out = kernel->closest(&f->world.trace, &ray, &hit);
        GiVec o = gi_along(target, gi_sub(target, inside), random_real(&random, 0.01, 5));
        ray = ray_of(o, gi_sub(inside, o));
        ray.t_max = 1;
        bool in = kernel->closest(&f->world.trace, &ray, &hit);
        if ((out && in) || lost++ >= 3) continue;
        test_fail(__FILE__, __LINE__, "%s: lost on the way %s: from (%a %a %a), through (%a %a %a)",
            what, out ? "in" : "out", inside.x, inside.y, inside.z, target.x, target.y, target.z);
    }
    if (lost > 0) test_fail(__FILE__, __LINE__, "%s: %d of %d rays are lost", what, lost, rays);
}

static void closed_surfaces(void) {
    static const struct {
        GiVec at;
        double size, bumps;
        int rings, rays;
        bool moved;
        const char *name;
    } cases[] = {
        {{0, 0, 0}, 1, 0, 100, 500000, false, "sphere"},
        {{0, 0, 0}, 1, 0.3, 20, 200000, false, "rough sphere"},
        {{0, 0, 0}, 1, 0, 3, 200000, false, "few triangles"},
        {{1000, -2000, 3000}, 0.5, 0, 60, 200000, false, "far away"},
        {{0, 0, 0}, 1e-12, 0.1, 20, 100000, false, "tiny"},
        {{0, 0, 0}, 1e12, 0.1, 20, 100000, false, "huge"},
        {{0, 0, 0}, 1, 0.1, 30, 200000, true, "instance"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Fixture f;
        fixture_begin(&f);
        Random random = {4};
        GiShapeRef ref = mesh_sphere(&f.scene, cases[i].at, cases[i].size, cases[i].rings,
            cases[i].bumps, false, true, &random);
        CHECK(gi_scene_place(&f.scene, GI_SHAPE_NONE, ref));
        if (cases[i].moved) {
            GiShapeRef group;
            CHECK(gi_scene_add_group(&f.scene, &group));
            uint32_t index = gi_shape_index(group);
            CHECK(gi_scene_add_step(&f.scene, index, GI_STEP_TRANSLATE, gi_vec(1e4, 0, 0)));
            CHECK(gi_scene_place(&f.scene, index, ref));
            CHECK(gi_scene_place(&f.scene, GI_SHAPE_NONE, group));
        }
        fixture_commit(&f);
        check_closed(
            &f, cases[i].at, cases[i].size, cases[i].bumps > 0, cases[i].rays, cases[i].name);
        fixture_end(&f);
    }
}

/* A bundle from inside, with rays through the corners themselves. */
static void closed_to_bundles(void) {
    Fixture f;
    fixture_begin(&f);
    Random random = {5};
    GiVec at = {0.1, 0.2, 0.3};
    GiShapeRef ref = mesh_sphere(&f.scene, at, 1, 40, 0.02, false, true, &random);
    CHECK(gi_scene_place(&f.scene, GI_SHAPE_NONE, ref));
    fixture_commit(&f);
    static GiBundle bundle;
    const GiKernel *kernel;
    for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
        int lost = 0;
        for (int round = 0; round < 50; round++) {
            GiVec axis = random_vec(&random, -1, 1);
            bundle.count = 0;
            bundle.apex = gi_add(at, random_vec(&random, -0.2, 0.2));
            bundle.side = gi_vec(0, 0, 0);
            bundle.own = false;
            for (int i = 0; i < 20000 && bundle.count < GI_BUNDLE_SIZE; i++) {
                GiVec d = gi_sub(surface_point(&f, &random), bundle.apex);
                if (gi_dot(d, axis) < 0.6 * gi_length(d) * gi_length(axis)) continue;
                int n = bundle.count++;
                bundle.dx[n] = d.x, bundle.dy[n] = d.y, bundle.dz[n] = d.z;
                bundle.t[n] = INFINITY;
            }
            kernel->bundle_closest(&f.world.trace, &bundle);
            for (int i = 0; i < bundle.count; i++) lost += bundle.shape[i] == GI_SHAPE_NONE;
        }
        CHECK_INT(lost, 0);
    }
    fixture_end(&f);
}

/* ---------------------------------------------------------------- one triangle */

typedef struct One {
    float positions[4][3], normals[3][3], texcoords[3][2];
    uint32_t corners[1][3];
    GiMesh mesh;
    GiShapeInfo info;
    GiShapes shapes;
} One;

static void one_init(One *one, GiVec a, GiVec b, GiVec c) {
    memset(one, 0, sizeof *one);
    const GiVec p[3] = {a, b, c};
    for (uint32_t i = 0; i < 3; i++) {
        one->positions[i][0] = (float)p[i].x;
        one->positions[i][1] = (float)p[i].y;
        one->positions[i][2] = (float)p[i].z;
        one->corners[0][i] = i;
    }
    one->mesh.triangle_count = 1;
    one->shapes.triangles = (GiTriangles){.positions = (const float(*)[3])one->positions,
        .normals = (const float(*)[3])one->normals,
        .texcoords = (const float(*)[2])one->texcoords,
        .corners = (const uint32_t(*)[3])one->corners};
    one->shapes.meshes = &one->mesh;
    one->shapes.mesh_count = 1;
    one->shapes.mesh_info = &one->info;
}

static const GiShapeRef first_triangle = {(uint32_t)GI_SHAPE_TRIANGLE << 28};

/* Moeller and Trumbore 1997, in long double; how far inside, and t. */
static long double second_formula(const One *one, GiVec o, GiVec d, long double *t) {
    long double v[3][3], e1[3], e2[3], s[3], p[3], q[3];
    const long double from[3] = {o.x, o.y, o.z}, along[3] = {d.x, d.y, d.z};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) v[i][k] = (long double)one->positions[i][k];
    }
    for (int k = 0; k < 3; k++) {
        e1[k] = v[1][k] - v[0][k];
        e2[k] = v[2][k] - v[0][k];
        s[k] = from[k] - v[0][k];
    }
    for (int k = 0; k < 3; k++) {
        int l = (k + 1) % 3, m = (k + 2) % 3;
        p[k] = along[l] * e2[m] - along[m] * e2[l];
        q[k] = s[l] * e1[m] - s[m] * e1[l];
    }
    long double det = e1[0] * p[0] + e1[1] * p[1] + e1[2] * p[2];
    long double u = (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / det;
    long double w = (along[0] * q[0] + along[1] * q[1] + along[2] * q[2]) / det;
    *t = (e2[0] * q[0] + e2[1] * q[1] + e2[2] * q[2]) / det;
    long double inside = u < w ? u : w;
    return inside < 1 - u - w ? inside : 1 - u - w;
}

static void agrees_with_second_formula(void) {
    Random random = {6};
    int hits = 0, wrong = 0;
    for (int i = 0; i < 300000; i++) {
        One one;
        double size = pow(10, random_real(&random, -3, 3));
        GiVec at = random_vec(&random, -10, 10);
        one_init(&one, gi_add(at, random_vec(&random, -size, size)),
            gi_add(at, random_vec(&random, -size, size)),
            gi_add(at, random_vec(&random, -size, size)));
        GiVec o = random_vec(&random, -20, 20);
        GiVec d = gi_sub(gi_add(at, random_vec(&random, -0.5 * size, 0.5 * size)), o);
        gi_hit_Ray ray = gi_hit_ray(o.x, o.y, o.z, d.x, d.y, d.z);
        long double expected;
        long double inside = second_formula(&one, o, d, &expected);
        double t;
        bool hit = gi_hit_shape(&one.shapes, first_triangle, &ray, 0, INFINITY, &t);
        if (fabsl(inside) < 1e-9L || fabsl(expected) < 1e-9L) continue;
        if (hit != (inside > 0 && expected > 0)) wrong++;
        if (!hit) continue;
        hits++;
        /* What the angle costs, and not more. */
        GiVec n =
            gi_cross(gi_sub(gi_vec(one.positions[1][0], one.positions[1][1], one.positions[1][2]),
                         gi_vec(one.positions[0][0], one.positions[0][1], one.positions[0][2])),
                gi_sub(gi_vec(one.positions[2][0], one.positions[2][1], one.positions[2][2]),
                    gi_vec(one.positions[0][0], one.positions[0][1], one.positions[0][2])));
        double slant = fabs(gi_dot(n, d)) / (gi_length(n) * gi_length(d));
        double bound = 1e-13 * (1 + gi_length(o) / gi_length(d)) * (1 + size) / slant;
        if (!(fabsl((long double)t - expected) < (long double)bound)) wrong++;
        /* The point is on the triangle's plane and on the ray. */
        GiSurfacePoint p =
            gi_shape_point(&one.shapes, first_triangle, GI_SHAPE_NONE, o, d, t, true);
        GiVec corner = gi_vec(one.positions[0][0], one.positions[0][1], one.positions[0][2]);
        double height = fabs(gi_dot(gi_sub(p.point, corner), p.geometric));
        if (!(height <= p.error) || !(fabs(gi_length(p.geometric) - 1) < 1e-14)) wrong++;
        if (!(gi_length(gi_sub(p.point, gi_along(o, d, t))) < 1e-9 * (1 + size))) wrong++;
        if (!(fabs(gi_dot(p.normal, gi_normalize(n)) - 1) < 1e-12)) wrong++;
    }
    CHECK(hits > 20000);
    CHECK_INT(wrong, 0);
}

/* Triangles without area are left out of trees, and are harmless. */
static void without_area(void) {
    Random random = {7};
    for (int i = 0; i < 1000; i++) {
        One one;
        GiVec a = gi_vec(random_below(&random, 9), random_below(&random, 9), 1);
        GiVec b = gi_vec(random_below(&random, 9), random_below(&random, 9), 1);
        GiVec c = i % 2 ? a : gi_along(a, gi_sub(b, a), 2);
        one_init(&one, a, b, c);
        GiBox box = gi_shape_bounds(&one.shapes, first_triangle, GI_SHAPE_NONE);
        CHECK(box.low.x > box.high.x);
    }
    Fixture f;
    fixture_begin(&f);
    mesh_begin(&f.scene);
    for (uint32_t i = 0; i < 30; i++) {
        mesh_position(&f.scene, gi_vec(i, i, 0));
        if (i >= 2) mesh_triangle(&f.scene, i - 2, i - 1, i);
    }
    CHECK(gi_scene_place(&f.scene, GI_SHAPE_NONE, mesh_surface(&f.scene)));
    fixture_commit(&f);
    GiTraceRay ray = ray_of(gi_vec(5, 5, -5), gi_vec(0, 0, 1));
    GiTraceHit hit;
    CHECK(!gi_kernel_at(0)->closest(&f.world.trace, &ray, &hit));
    fixture_end(&f);
}

static void edge_on(void) {
    One one;
    one_init(&one, gi_vec(0, 0, 0), gi_vec(1, 0, 0), gi_vec(0, 1, 0));
    const GiVec directions[] = {{1, 0, 0}, {1, 2, 0}, {-1, 0.5, 0}};
    for (int i = 0; i < 3; i++) {
        GiVec d = directions[i];
        gi_hit_Ray ray = gi_hit_ray(0.2 - 3 * d.x, 0.2 - 3 * d.y, 0, d.x, d.y, d.z);
        double t;
        CHECK(!gi_hit_shape(&one.shapes, first_triangle, &ray, 0, INFINITY, &t));
    }
}

#define CHECK_VEC(v, a, b, c)                                                                      \
    do {                                                                                           \
        GiVec is = (v);                                                                            \
        CHECK_NEAR(is.x, a, 1e-14);                                                                \
        CHECK_NEAR(is.y, b, 1e-14);                                                                \
        CHECK_NEAR(is.z, c, 1e-14);                                                                \
    } while (0)

static GiSurfacePoint point_at(const One *one, double x, double y) {
    GiVec o = {x, y, 5}, d = {0, 0, -2};
    gi_hit_Ray ray = gi_hit_ray(o.x, o.y, o.z, d.x, d.y, d.z);
    double t = NAN;
    CHECK(gi_hit_shape(&one->shapes, first_triangle, &ray, 0, INFINITY, &t));
    CHECK_NEAR(t, 2.5, 1e-15);
    return gi_shape_point(&one->shapes, first_triangle, GI_SHAPE_NONE, o, d, t, true);
}

static void blends(void) {
    One one;
    one_init(&one, gi_vec(0, 0, 0), gi_vec(4, 0, 0), gi_vec(0, 4, 0));
    GiSurfacePoint p = point_at(&one, 1, 2);
    CHECK_VEC(p.point, 1, 2, 0);
    CHECK_VEC(p.geometric, 0, 0, 1);
    CHECK_VEC(p.normal, 0, 0, 1);
    double uv[2] = {5, 5};
    gi_shape_texcoord(&one.shapes, first_triangle, GI_SHAPE_NONE, p.point, uv);
    CHECK(uv[0] == 0 && uv[1] == 0);
    one.mesh.smooth = one.mesh.textured = true;
    one.normals[0][0] = 1, one.normals[1][1] = 1, one.normals[2][2] = 2;
    one.texcoords[0][0] = 4, one.texcoords[1][0] = 8, one.texcoords[2][1] = 12;
    p = point_at(&one, 1, 2);
    double h = 1 / sqrt(1 + 1 + 16);
    CHECK_VEC(p.normal, h, h, 4 * h);
    CHECK_VEC(p.geometric, 0, 0, 1);
    gi_shape_texcoord(&one.shapes, first_triangle, GI_SHAPE_NONE, p.point, uv);
    CHECK_NEAR(uv[0], 3, 1e-14);
    CHECK_NEAR(uv[1], 6, 1e-14);
    /* Indices of their own, and a row that has none. */
    uint32_t rows[1][3] = {{2, 2, 2}};
    one.mesh.normal_corners = one.mesh.texcoord_corners = rows;
    p = point_at(&one, 1, 2);
    CHECK_VEC(p.normal, 0, 0, 1);
    gi_shape_texcoord(&one.shapes, first_triangle, GI_SHAPE_NONE, p.point, uv);
    CHECK_NEAR(uv[0], 0, 1e-14);
    CHECK_NEAR(uv[1], 12, 1e-13);
    rows[0][0] = GI_SHAPE_NONE;
    one.normals[2][2] = -7;
    p = point_at(&one, 1, 2);
    CHECK_VEC(p.normal, 0, 0, 1);
    gi_shape_texcoord(&one.shapes, first_triangle, GI_SHAPE_NONE, p.point, uv);
    CHECK(uv[0] == 0 && uv[1] == 0);
    /* Normals that cancel each other leave the surface's own. */
    one.mesh.normal_corners = NULL;
    memset(one.normals, 0, sizeof one.normals);
    CHECK_VEC(point_at(&one, 1, 2).normal, 0, 0, 1);
}

/* Normals are blended in the mesh's own space, then carried over. */
static void blends_under_a_transform(void) {
    One one;
    one_init(&one, gi_vec(0, 0, 0), gi_vec(4, 0, 0), gi_vec(0, 4, 0));
    one.mesh.smooth = one.mesh.textured = true;
    one.normals[0][0] = 3, one.normals[1][0] = 3, one.normals[2][2] = 1;
    one.texcoords[1][0] = one.texcoords[2][1] = 1;
    GiAffine scale = gi_affine_scale(gi_vec(2, 1, 1)), move = gi_affine_translate(gi_vec(7, 0, 0));
    GiTransform transform = {.to_world = gi_affine_multiply(&move, &scale)};
    CHECK(gi_affine_invert(&transform.to_world, &transform.to_object));
    GiBox bounds = gi_shape_bounds(&one.shapes, first_triangle, GI_SHAPE_NONE);
    GiInstance instance = {.bounds = &bounds, .info = {3, 4}};
    one.shapes.instances = &instance;
    one.shapes.transforms = &transform;
    GiVec o = {9, 2, 5}, d = {0, 0, -1};
    GiSurfacePoint p = gi_shape_point(&one.shapes, first_triangle, 0, o, d, 5, true);
    CHECK_VEC(p.point, 9, 2, 0);
    CHECK_VEC(p.geometric, 0, 0, 1);
    /* Half of (3 0 0), half of (0 0 1): (3 0 1) / sqrt 10, and x is halved by the transform. */
    GiVec expected = gi_normalize(gi_vec(1.5, 0, 1));
    CHECK_VEC(p.normal, expected.x, expected.y, expected.z);
    double uv[2];
    gi_shape_texcoord(&one.shapes, first_triangle, 0, p.point, uv);
    CHECK_NEAR(uv[0], 0.25, 1e-14);
    CHECK_NEAR(uv[1], 0.5, 1e-14);
    CHECK_INT(gi_shape_info(&one.shapes, first_triangle, 0)->shader, 3);
    CHECK_INT(gi_shape_info(&one.shapes, first_triangle, GI_SHAPE_NONE)->shader, 0);
    GiBox box = gi_shape_bounds(&one.shapes, first_triangle, 0);
    CHECK(box.low.x == 7 && box.high.x == 15 && box.high.y == 4 && box.low.z == 0);
    box = gi_shape_bounds(&one.shapes, gi_shape_ref(GI_SHAPE_INSTANCE, 0), GI_SHAPE_NONE);
    CHECK(box.low.x == 7 && box.high.x == 15 && box.high.y == 4 && box.low.z == 0);
}

/* ---------------------------------------------------------------- others */

static void sphere_texcoords(void) {
    static const struct {
        GiVec normal;
        double u, v;
    } cases[] = {{{0, 1, 0}, 0.5, 1}, {{0, -1, 0}, 0.5, 0}, {{0, 0, 1}, 0.5, 0.5},
        {{1, 0, 0}, 0.75, 0.5}, {{-1, 0, 0}, 0.25, 0.5},
        {{0.6, 0.5, -0.6244997998398398}, 0.8782, 2 / 3.0}};
    GiSphere sphere = {{1, 2, 3}, 2};
    GiShapes shapes = {.spheres = &sphere};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double uv[2];
        GiVec point = gi_along(sphere.center, cases[i].normal, sphere.radius);
        gi_shape_texcoord(&shapes, gi_shape_ref(GI_SHAPE_SPHERE, 0), GI_SHAPE_NONE, point, uv);
        CHECK_NEAR(uv[0], cases[i].u, i == 5 ? 1e-4 : 1e-15);
        CHECK_NEAR(uv[1], cases[i].v, 1e-15);
    }
}

static void rectangle(void) {
    GiRectangle one = {{1, 2, 3}, {2, 0, 0}, {0, 0.5, 0}, {0, 0, 1}};
    GiShapes shapes = {.rectangles = &one};
    GiShapeRef ref = gi_shape_ref(GI_SHAPE_RECTANGLE, 0);
    GiBox box = gi_shape_bounds(&shapes, ref, GI_SHAPE_NONE);
    CHECK(box.low.x == -1 && box.high.x == 3 && box.low.y == 1.5 && box.high.y == 2.5);
    CHECK(box.low.z == 3 && box.high.z == 3);
    static const struct {
        double x, y;
        bool hit;
    } cases[] = {{1, 2, true}, {-0.99, 1.51, true}, {2.99, 2.49, true}, {3.01, 2, false},
        {1, 2.51, false}, {1, 1.49, false}, {-1.01, 2, false}, {3, 2.5, true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (int side = -1; side <= 1; side += 2) {
            gi_hit_Ray ray = gi_hit_ray(cases[i].x, cases[i].y, 3 + 4 * side, 0, 0, -2 * side);
            double t;
            bool hit = gi_hit_shape(&shapes, ref, &ray, 0, INFINITY, &t);
            CHECK_INT(hit, cases[i].hit);
            if (hit) CHECK_NEAR(t, 2, 0);
        }
    }
    GiSurfacePoint p =
        gi_shape_point(&shapes, ref, GI_SHAPE_NONE, gi_vec(0, 2, 9), gi_vec(0.5, 0, -3), 2, true);
    CHECK_VEC(p.point, 1, 2, 3);
    CHECK_VEC(p.normal, 0, 0, 1);
}

/* Of two triangles at the same place the first in the file is seen, however the tree sorts them. */
static void first_in_file(void) {
    Fixture f;
    fixture_begin(&f);
    Random random = {8};
    mesh_begin(&f.scene);
    GiVec first_corner[100]; /* of each in the file; commit moves rows and vertices */
    for (uint32_t i = 0; i < 100; i++) {
        GiVec p = gi_vec(random_below(&random, 10), random_below(&random, 10), 0);
        first_corner[i] = p;
        mesh_position(&f.scene, p);
        mesh_position(&f.scene, gi_add(p, gi_vec(1, 0, 0)));
        mesh_position(&f.scene, gi_add(p, gi_vec(0, 1, 0)));
        mesh_triangle(&f.scene, 3 * i, 3 * i + 1, 3 * i + 2);
    }
    CHECK(gi_scene_place(&f.scene, GI_SHAPE_NONE, mesh_surface(&f.scene)));
    fixture_commit(&f);
    const uint32_t *original = f.world.original;
    for (int i = 0; i < 100; i++) {
        GiTraceRay ray = ray_of(gi_vec(i / 10 + 0.3, i % 10 + 0.3, 4), gi_vec(0, 0, -1));
        GiTraceHit hit;
        if (!gi_kernel_at(0)->closest(&f.world.trace, &ray, &hit)) continue;
        uint32_t seen = gi_shape_index(hit.shape);
        const float *corner = f.scene.meshes.positions.data[f.scene.meshes.corners.data[seen][0]];
        CHECK(corner[0] == (float)(i / 10) && corner[1] == (float)(i % 10));
        CHECK_VEC(first_corner[original[seen]], (double)corner[0], (double)corner[1], 0);
        for (uint32_t k = 0; k < original[seen]; k++) {
            CHECK(first_corner[k].x != (double)corner[0] || first_corner[k].y != (double)corner[1]);
        }
    }
    fixture_end(&f);
}

/* ---------------------------------------------------------------- vertices */

enum { TRIANGLES = 200, VERTICES = 150, MORE = 50 };

/* The numbers of a triangle's corners; a normal it has none of is zero. */
typedef struct Face {
    float position[3][3], normal[3][3], texcoord[3][2];
} Face;

static Face face_of(const GiScene *scene, uint32_t triangle) {
    const GiMesh *mesh = &scene->meshes.meshes.data[0];
    Face face;
    memset(&face, 0, sizeof face);
    for (int k = 0; k < 3; k++) {
        uint32_t at = scene->meshes.corners.data[triangle][k], normal = at;
        if (mesh->normal_corners != NULL) normal = mesh->normal_corners[triangle][k];
        memcpy(face.position[k], scene->meshes.positions.data[at], sizeof face.position[k]);
        memcpy(face.texcoord[k], scene->meshes.texcoords.data[at], sizeof face.texcoord[k]);
        if (mesh->normal_corners != NULL && mesh->normal_corners[triangle][0] == GI_SHAPE_NONE) {
            continue;
        }
        memcpy(face.normal[k], scene->meshes.normals.data[normal], sizeof face.normal[k]);
    }
    return face;
}

static void add_vertices(GiScene *scene, Random *random, int normal_count) {
    GiMeshStore *store = &scene->meshes;
    GiMesh *mesh = mesh_begin(scene);
    mesh->smooth = mesh->textured = true;
    for (int i = 0; i < VERTICES; i++) {
        mesh_position(scene, random_vec(random, -1, 1));
        CHECK(gi_array_reserve(scene->memory, &store->texcoords, 1));
        float *texcoord = store->texcoords.data[store->texcoords.count++];
        texcoord[0] = (float)i, texcoord[1] = 0;
    }
    for (int i = 0; i < normal_count; i++) {
        CHECK(gi_array_reserve(scene->memory, &store->normals, 1));
        float *normal = store->normals.data[store->normals.count++];
        normal[0] = (float)(i + 1), normal[1] = normal[2] = 0;
    }
    /* The last vertices are in no triangle. */
    for (int i = 0; i < TRIANGLES; i++) {
        uint32_t row[3];
        for (int k = 0; k < 3; k++) row[k] = (uint32_t)random_below(random, VERTICES - 10);
        mesh_triangle(scene, row[0], row[1], row[2]);
    }
}

static void add_own_rows(GiScene *scene, Random *random, int normal_count) {
    GiMesh *mesh = &scene->meshes.meshes.data[0];
    mesh->normal_corners =
        gi_memory_allocate(scene->memory, TRIANGLES * sizeof *mesh->normal_corners);
    CHECK(mesh->normal_corners != NULL);
    for (int i = 0; i < TRIANGLES; i++) {
        for (int k = 0; k < 3; k++) {
            mesh->normal_corners[i][k] = (uint32_t)random_below(random, normal_count);
        }
        if (i % 7 == 0) mesh->normal_corners[i][0] = GI_SHAPE_NONE;
    }
}

/* Commit gives vertices new numbers; a triangle's corners are what they were, whether normals share
 * the rows of the positions or not, and as many as these or not. */
static void vertices_move(void) {
    for (int way = 0; way < 3; way++) {
        Fixture f;
        fixture_begin(&f);
        Random random = {11};
        int normal_count = way == 0 ? VERTICES : VERTICES + MORE;
        add_vertices(&f.scene, &random, normal_count);
        if (way == 2) add_own_rows(&f.scene, &random, normal_count);
        Face before[TRIANGLES];
        for (uint32_t i = 0; i < TRIANGLES; i++) before[i] = face_of(&f.scene, i);
        CHECK(gi_scene_place(&f.scene, GI_SHAPE_NONE, mesh_surface(&f.scene)));
        fixture_commit(&f);
        for (uint32_t i = 0; i < TRIANGLES; i++) {
            Face after = face_of(&f.scene, i);
            CHECK(memcmp(&after, &before[f.world.original[i]], sizeof after) == 0);
        }
        /* The first triangle's are the first, where they move. */
        if (way != 1) CHECK_INT(f.scene.meshes.corners.data[0][0], 0);
        fixture_end(&f);
    }
}

const GiTest tests_triangle[] = {TEST(closed_surfaces), TEST(closed_to_bundles),
    TEST(agrees_with_second_formula), TEST(without_area), TEST(edge_on), TEST(blends),
    TEST(blends_under_a_transform), TEST(sphere_texcoords), TEST(rectangle), TEST(first_in_file),
    TEST(vertices_move), TEST_END};
