/* SPDX-License-Identifier: MIT
 * Triangles in bundles: what is certain in single precision is taken without the exact test. Here
 * are pairs of triangles with an edge in common, large or tiny, near or far, layers of them that
 * all but touch, and rays that graze edges or end about where they begin, by parts from a tenth to
 * a billionth; a mesh that is fine beside its rays; rays that begin on a triangle itself; and rays
 * in the planes of triangles. Whoever takes too much for certain disagrees with the formula. */
#include "brute.h"
#include "meshes.h"
#include "random.h"
#include "test.h"

#include <math.h>

enum { LAYERS = 4 };

/* Two triangles with a common edge, in layers: a little moved, turned, or the very same. */
static void add_layers(GiScene *scene, GiVec center, double size, Random *random) {
    GiVec corner[4];
    mesh_begin(scene);
    double narrow = random_below(random, 3) == 0 ? pow(10, -random_real(random, 0, 5)) : 1;
    GiVec across = random_unit(random), up = gi_scale(random_unit(random), narrow);
    for (int k = 0; k < 4; k++) {
        double x = k == 1 || k == 2 ? 1 : -1, y = k >= 2 ? 1 : -1;
        GiVec place = gi_add(gi_scale(across, x), gi_scale(up, y));
        corner[k] = gi_along(center, gi_add(place, random_vec(random, -0.2, 0.2)), size);
    }
    GiVec away = gi_scale(random_unit(random), size);
    for (uint32_t layer = 0; layer < LAYERS; layer++) {
        double step = random_below(random, 4) == 0 ? 0 : random_tiny(random);
        double turn = random_below(random, 2) ? random_tiny(random) : 0;
        for (int k = 0; k < 4; k++) {
            mesh_position(scene, gi_along(corner[k], away, step + turn * k));
        }
        mesh_triangle(scene, 4 * layer, 4 * layer + 1, 4 * layer + 2);
        mesh_triangle(scene, 4 * layer, 4 * layer + 2, 4 * layer + 3);
    }
    GiShapeRef ref = mesh_surface(scene);
    CHECK(gi_scene_place(scene, GI_SHAPE_NONE, ref));
}

static GiVec corner_of(const Fixture *fixture, uint32_t triangle, int k) {
    const GiTriangles *triangles = &fixture->world.shapes.triangles;
    const float *p = triangles->positions[triangles->corners[triangle][k]];
    return gi_vec((double)p[0], (double)p[1], (double)p[2]);
}

/* A point inside of a triangle, near an edge or near a corner. */
static GiVec point_on(const Fixture *fixture, uint32_t triangle, Random *random) {
    double part[3] = {random_real(random, 0, 1), random_real(random, 0, 1), 0};
    if (random_below(random, 3) == 0) part[0] = random_tiny(random);
    if (random_below(random, 3) == 0) part[1] = random_tiny(random);
    if (part[0] + part[1] > 1) part[0] = 1 - part[0], part[1] = 1 - part[1];
    part[2] = 1 - part[0] - part[1];
    int first = random_below(random, 3);
    GiVec p = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        p = gi_along(p, corner_of(fixture, triangle, (first + k) % 3), part[k]);
    }
    return p;
}

/* The rays of a bundle, as many as it says, at triangles of a mesh of so many; more than half of
 * them at the first eight, which may be a leaf. */
static void aim(const Fixture *fixture, GiVec center, double size, int triangles, bool any,
    GiBundle *bundle, Random *random) {
    double distance = pow(10, random_real(random, -0.5, 3));
    bundle->apex = gi_along(center, random_unit(random), size * distance);
    bundle->side = gi_vec(0, 0, 0);
    bundle->start = random_below(random, 2) ? 0 : random_real(random, 0, 1.5);
    bundle->end = random_below(random, 4) ? 1 : 1 - fabs(random_tiny(random));
    bundle->own = false;
    for (int i = 0; i < bundle->count; i++) {
        uint32_t triangle = (uint32_t)random_below(random, random_below(random, 2) ? 8 : triangles);
        GiVec p = point_on(fixture, triangle, random), o = bundle->apex;
        double part =
            random_below(random, 2) ? 1 + random_tiny(random) : random_real(random, 0.5, 2);
        GiVec d = gi_sub(p, o);
        if (any) {
            o = gi_along(o, d, part);
            d = gi_sub(bundle->apex, o);
        }
        bundle_put_ray(bundle, i, o, d, random_below(random, 2) ? 0 : fabs(random_tiny(random)));
    }
}

static void begin(Fixture *fixture, GiVec center, double size, Random *random) {
    GiShapeRef far;
    fixture_begin(fixture, GLINT_DIALECT_2018B);
    add_layers(&fixture->scene, center, size, random);
    /* The scene is as large as a second shape, and has one that is tested in another way. */
    CHECK(gi_scene_add_sphere(&fixture->scene, gi_vec(3, 3, 3), 1e-3, 0, &far));
    CHECK(gi_scene_place(&fixture->scene, GI_SHAPE_NONE, far));
    if (random_below(random, 2)) {
        CHECK(gi_scene_add_sphere(&fixture->scene, center, size * 0.7, 0, &far));
        CHECK(gi_scene_place(&fixture->scene, GI_SHAPE_NONE, far));
    }
    fixture_commit(fixture, gi_kernel_at(0));
}

static void triangles_are_grazed(void) {
    static GiBundle bundle;
    Random random = {21};
    for (int round = 0; round < 300; round++) {
        Fixture fixture;
        GiVec center = random_vec(&random, -1, 1);
        double size = pow(10, random_real(&random, -4, 0.5));
        begin(&fixture, center, size, &random);
        for (int any = 0; any < 2; any++) {
            bundle.count = GI_BUNDLE_SIZE;
            aim(&fixture, center, size, 2 * LAYERS, any != 0, &bundle, &random);
            bundle.without_t = random_below(&random, 4) == 0;
            const GiKernel *kernel;
            for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
                CHECK_INT(bundle_differs(&fixture, kernel, any != 0, &bundle), 0);
            }
        }
        fixture_end(&fixture);
    }
}

/* A mesh whose leaves are small beside a packet's rectangle, so that few rays pass by most of them,
 * or none: these are looked at ray by ray. From one packet to as many as are too many for that. */
static void fine_meshes_are_grazed(void) {
    enum { RINGS = 20, TRIANGLES = 4 * RINGS * (RINGS - 1) };
    static GiBundle bundle;
    Random random = {24};
    for (int round = 0; round < 60; round++) {
        Fixture fixture;
        GiVec center = random_vec(&random, -1, 1);
        double size = pow(10, random_real(&random, -3, 0.5));
        GiShapeRef ref;
        fixture_begin(&fixture, GLINT_DIALECT_2018B);
        ref = mesh_sphere(&fixture.scene, center, size, RINGS, 0.1, false, true, &random);
        CHECK(gi_scene_place(&fixture.scene, GI_SHAPE_NONE, ref));
        CHECK(gi_scene_add_sphere(&fixture.scene, gi_vec(3, 3, 3), 1e-3, 0, &ref));
        CHECK(gi_scene_place(&fixture.scene, GI_SHAPE_NONE, ref));
        fixture_commit(&fixture, gi_kernel_at(0));
        for (int any = 0; any < 2; any++) {
            bundle.count = 8 + random_below(&random, round % 4 == 0 ? 200 : 60);
            aim(&fixture, center, size, TRIANGLES, any != 0, &bundle, &random);
            bundle.without_t = random_below(&random, 4) == 0;
            const GiKernel *kernel;
            for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
                CHECK_INT(bundle_differs(&fixture, kernel, any != 0, &bundle), 0);
            }
        }
        fixture_end(&fixture);
    }
}

/* ---------------------------------------------------------------- rays from triangles */

/* What camera rays meet becomes points, and from these shadow rays leave for a light. That their
 * own triangles are left out must not show. */
static int differing_shadows(
    const Fixture *fixture, const GiKernel *kernel, GiBundle *bundle, GiVec light) {
    static GiPoints points;
    static GiBundle shadows;
    uint32_t rays[GI_BUNDLE_ROOM];
    int count = 0, wrong = 0;
    for (int i = 0; i < bundle->count; i++) bundle->t[i] = INFINITY;
    kernel->bundle_closest(&fixture->world.trace, bundle);
    for (int i = 0; i < bundle->count; i++) {
        if (bundle->shape[i] == GI_SHAPE_NONE) continue;
        if (gi_shape_kind((GiShapeRef){bundle->shape[i]}) == GI_SHAPE_TRIANGLE) {
            rays[count++] = (uint32_t)i;
        }
    }
    points.count = 0;
    if (count == 0) return 0;
    kernel->points(&fixture->world.shapes, bundle, rays, count, GI_OWN_LEFT, false, &points);
    shadows.count = count;
    shadows.apex = light;
    shadows.side = gi_vec(0, 0, 0);
    shadows.end = 1;
    shadows.own = false;
    for (int i = 0; i < count; i++) {
        GiVec p = gi_vec(points.px[i], points.py[i], points.pz[i]), d = gi_sub(light, p);
        shadows.ox[i] = p.x, shadows.oy[i] = p.y, shadows.oz[i] = p.z;
        shadows.dx[i] = d.x, shadows.dy[i] = d.y, shadows.dz[i] = d.z;
        shadows.t_min[i] = points.error[i] / gi_length(d);
        shadows.skip[i] = points.skip[i];
        shadows.skip_instance[i] = points.skip_instance[i];
    }
    kernel->bundle_any(&fixture->world.trace, &shadows);
    for (int i = 0; i < count; i++) {
        GiTraceRay ray = {{shadows.ox[i], shadows.oy[i], shadows.oz[i]},
            {shadows.dx[i], shadows.dy[i], shadows.dz[i]}, shadows.t_min[i], 1, GI_SHAPE_NONE,
            GI_SHAPE_NONE};
        GiTraceHit hit;
        wrong += brute_force(fixture, &ray, &hit) != (shadows.shape[i] != GI_SHAPE_NONE);
    }
    return wrong;
}

static void triangles_are_left(void) {
    static GiBundle bundle;
    Random random = {22};
    for (int round = 0; round < 300; round++) {
        Fixture fixture;
        GiVec center = random_vec(&random, -1, 1);
        double size = pow(10, random_real(&random, -4, 0.5));
        begin(&fixture, center, size, &random);
        bundle.count = GI_BUNDLE_SIZE;
        aim(&fixture, center, size, 2 * LAYERS, false, &bundle, &random);
        bundle.without_t = random_below(&random, 2) != 0;
        /* A light anywhere, or so low over the triangles that it all but lies in their planes. */
        GiVec light =
            gi_along(center, random_unit(&random), size * pow(10, random_real(&random, -1, 3)));
        if (random_below(&random, 2)) {
            GiVec a = corner_of(&fixture, 0, 0), b = corner_of(&fixture, 0, 1);
            light = gi_along(gi_along(a, gi_sub(b, a), random_real(&random, 1.1, 9)),
                random_unit(&random), size * random_tiny(&random));
        }
        const GiKernel *kernel;
        for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
            CHECK_INT(differing_shadows(&fixture, kernel, &bundle, light), 0);
        }
        fixture_end(&fixture);
    }
}

/* ---------------------------------------------------------------- rays in planes of triangles */

static GiVec grid_point(Random *random) {
    return gi_vec(
        random_below(random, 5) - 2, random_below(random, 5) - 2, random_below(random, 5) - 2);
}

/* Corners, apex and what rays aim at are whole numbers, so that many rays run in the planes of
 * triangles, and the apex is a corner, or lies across from one in its own depth plane; often it is
 * zero, where no rounding is to be allowed for. */
static void aim_on_grid(GiBundle *bundle, Random *random) {
    bundle->apex = random_below(random, 2) ? gi_vec(0, 0, 0) : grid_point(random);
    bundle->side = gi_vec(0, 0, 0);
    bundle->start = 0;
    bundle->end = 1;
    bundle->own = bundle->without_t = false;
    GiVec axis = random_unit(random);
    for (bundle->count = 0; bundle->count < 64;) {
        GiVec d = grid_point(random);
        if (random_below(random, 3) == 0) d = random_vec(random, -2, 2);
        if (gi_dot(d, axis) < 0.7 * gi_length(d) || gi_length(d) < 0.1) continue;
        int i = bundle->count++;
        d = gi_scale(d, random_real(random, 0.3, 3)); /* weights are nothing but rounding then */
        GiVec o = gi_along(bundle->apex, d, 2);
        bundle_put_ray(bundle, i, o, d, 0);
    }
}

static void triangles_are_met_in_their_planes(void) {
    static GiBundle bundle;
    Random random = {23};
    for (int round = 0; round < 2000; round++) {
        Fixture fixture;
        fixture_begin(&fixture, GLINT_DIALECT_GLINT);
        mesh_begin(&fixture.scene);
        uint32_t count = 1 + (uint32_t)random_below(&random, 40);
        for (uint32_t i = 0; i < 3 * count; i++) mesh_position(&fixture.scene, grid_point(&random));
        for (uint32_t i = 0; i < count; i++) {
            mesh_triangle(&fixture.scene, 3 * i, 3 * i + 1, 3 * i + 2);
        }
        GiShapeRef ref = mesh_surface(&fixture.scene);
        CHECK(gi_scene_place(&fixture.scene, GI_SHAPE_NONE, ref));
        fixture_commit(&fixture, gi_kernel_at(0));
        for (int any = 0; any < 2; any++) {
            aim_on_grid(&bundle, &random);
            const GiKernel *kernel;
            for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
                CHECK_INT(bundle_differs(&fixture, kernel, any != 0, &bundle), 0);
            }
        }
        fixture_end(&fixture);
    }
}

const GiTest tests_facets[] = {TEST(triangles_are_grazed), TEST(fine_meshes_are_grazed),
    TEST(triangles_are_left), TEST(triangles_are_met_in_their_planes), TEST_END};
