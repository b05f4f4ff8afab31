/* SPDX-License-Identifier: MIT
 * Bundles decide in single precision what is certain. Here nothing is: one shape, large or tiny,
 * near or far, and rays that graze its outline or end about where it begins, by parts of it from a
 * tenth to a billionth. Whoever takes too much for certain disagrees with the formula. What is
 * small beside the bundle is looked at in other ways: there some rays run far from the shape. */
#include "brute.h"
#include "random.h"
#include "test.h"

#include <math.h>

/* On an edge, a cap, or the wall where its outline is seen from the apex: there the normal (cos f,
 * sin f, -slope) is across the line of sight. */
static GiVec near_cone(const GiCone *cone, GiVec apex, Random *random) {
    GiVec eye = gi_sub(apex, cone->center);
    double half = cone->half_height, z = random_real(random, -half, half);
    double angle = random_real(random, 0, 6.3);
    int part = random_below(random, 8);
    if (part < 3) z = (part == 0 ? -half : half) * (1 + random_tiny(random));
    double radius = cone->radius + cone->slope * z;
    if (part > 2) {
        double across = sqrt(eye.x * eye.x + eye.y * eye.y);
        double cosine = (cone->slope * (eye.z - z) + radius) / across;
        if (fabs(cosine) <= 1) {
            angle = atan2(eye.y, eye.x) + (part % 2 ? 1 : -1) * acos(cosine);
        }
    }
    radius *= 1 + random_tiny(random);
    if (part == 0) radius *= random_real(random, 0, 1);
    return gi_add(cone->center, gi_vec(radius * cos(angle), radius * sin(angle), z));
}

/* A point about the surface, and mostly near the outline that is seen from the apex. */
static GiVec near_outline(
    const Fixture *fixture, GiShapeRef ref, GiVec center, GiVec half, GiVec apex, Random *random) {
    GiVec d = random_unit(random);
    if (gi_shape_kind(ref) == GI_SHAPE_CONE) {
        return near_cone(&fixture->world.shapes.cones[gi_shape_index(ref)], apex, random);
    }
    if (gi_shape_kind(ref) == GI_SHAPE_SPHERE) {
        GiVec toward = gi_sub(apex, center);
        double distance = gi_length(toward), sine = half.x / distance;
        toward = gi_scale(toward, 1 / distance);
        GiVec across = gi_normalize(gi_sub(d, gi_scale(toward, gi_dot(d, toward))));
        double height = sine < 1 ? sine : 0;
        GiVec n = gi_add(gi_scale(toward, height), gi_scale(across, sqrt(1 - height * height)));
        if (random_below(random, 4) == 0) n = d;
        return gi_along(center, n, half.x * (1 + random_tiny(random)));
    }
    /* On an edge of a box, or a face. */
    double place[3] = {d.x, d.y, d.z};
    int flat = 1 + random_below(random, 2), axis = random_below(random, 3);
    for (int i = 0; i < flat; i++, axis = (axis + 1) % 3) {
        place[axis] = (place[axis] < 0 ? -1 : 1) * (1 + random_tiny(random));
    }
    return gi_add(center, gi_vec(half.x * place[0], half.y * place[1], half.z * place[2]));
}

static void fill(const Fixture *fixture, GiVec center, GiVec half, bool small, bool any,
    GiBundle *bundle, Random *random) {
    GiShapeRef ref = fixture->things.data[0].ref;
    double distance = pow(10, random_real(random, -1, 3)), size = gi_length(half);
    GiVec from = random_unit(random);
    if (random_below(random, 2)) from.z *= 4; /* down into cones, as steep as their walls */
    bundle->apex = gi_along(center, gi_normalize(from), size * (1 + distance));
    bundle->side = gi_vec(0, 0, 0);
    bundle->count = GI_BUNDLE_SIZE;
    bundle->start = 0;
    bundle->end = random_below(random, 4) ? 1 : 1 + random_tiny(random) / 2;
    if (bundle->end > 1) bundle->end = 1;
    /* Where the shape may lie beyond. */
    if (random_below(random, 8) == 0) bundle->end = random_real(random, 0.05, 1);
    bundle->own = false;
    for (int i = 0; i < bundle->count; i++) {
        GiVec p = near_outline(fixture, ref, center, half, bundle->apex, random), o = bundle->apex;
        if (small && i % 64 == 0) p = gi_along(p, random_unit(random), 4 * size);
        /* Ending before it, in it, or behind it. */
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

/* Cylinders, truncated cones, cones with their apex at an end, and with two nappes. */
static bool add_cone(Fixture *fixture, GiVec center, GiVec half, Random *random, GiShapeRef *ref) {
    double tip = half.z * random_real(random, -1, 1), height = 2 * half.z;
    int sort = random_below(random, 4);
    if (sort == 0) {
        return gi_scene_add_cylinder(&fixture->scene, center, half.x, height, 0, ref);
    }
    if (sort == 1) tip = random_below(random, 2) ? half.z : -half.z;
    if (sort == 2) tip = half.z * random_real(random, 1, 20);
    return gi_scene_add_cone(&fixture->scene, center, half.x, height, center.z + tip, 0, ref);
}

static void grazing(GiShapeKind kind, bool small) {
    static GiBundle bundle;
    Random random = {11 + (uint64_t)kind};
    for (int round = 0; round < 60; round++) {
        Fixture fixture;
        GiShapeRef ref;
        /* The scene is as large as a second shape, of which the first is a part down to 1e-5. */
        GiVec center = random_vec(&random, -1, 1), far = gi_vec(3, 3, 3);
        double size = pow(10, random_real(&random, -5, 0));
        GiVec half = {size, size, size};
        if (kind == GI_SHAPE_BOX) half.y = size * random_real(&random, 0.01, 1);
        if (kind == GI_SHAPE_CONE) half.z = size * pow(10, random_real(&random, -1, 1));
        fixture_begin(&fixture, round % 2 ? GLINT_DIALECT_2018B : GLINT_DIALECT_2012);
        if (kind == GI_SHAPE_SPHERE) {
            CHECK(gi_scene_add_sphere(&fixture.scene, center, size, 0, &ref));
        } else if (kind == GI_SHAPE_BOX) {
            CHECK(gi_scene_add_box(
                &fixture.scene, gi_sub(center, half), gi_add(center, half), 0, &ref));
        } else {
            CHECK(add_cone(&fixture, center, half, &random, &ref));
        }
        CHECK(gi_scene_place(&fixture.scene, GI_SHAPE_NONE, ref));
        if (small) { /* a leaf of several kinds */
            GiVec part = gi_scale(half, 1e-3);
            CHECK(gi_scene_add_box(
                &fixture.scene, gi_sub(center, part), gi_add(center, part), 0, &ref));
            CHECK(gi_scene_place(&fixture.scene, GI_SHAPE_NONE, ref));
        }
        CHECK(gi_scene_add_sphere(&fixture.scene, far, 1e-3, 0, &ref));
        CHECK(gi_scene_place(&fixture.scene, GI_SHAPE_NONE, ref));
        fixture_commit(&fixture, gi_kernel_at(0));
        for (int any = 0; any < 2; any++) {
            fill(&fixture, center, half, small, any != 0, &bundle, &random);
            const GiKernel *kernel;
            for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
                CHECK_INT(bundle_differs(&fixture, kernel, any != 0, &bundle), 0);
            }
        }
        fixture_end(&fixture);
    }
}

static void spheres_are_grazed(void) { grazing(GI_SHAPE_SPHERE, false); }

static void boxes_are_grazed(void) { grazing(GI_SHAPE_BOX, false); }

static void small_spheres_are_grazed(void) { grazing(GI_SHAPE_SPHERE, true); }

static void small_boxes_are_grazed(void) { grazing(GI_SHAPE_BOX, true); }

static void cones_are_grazed(void) { grazing(GI_SHAPE_CONE, true); }

const GiTest tests_bundle[] = {TEST(spheres_are_grazed), TEST(boxes_are_grazed),
    TEST(small_spheres_are_grazed), TEST(small_boxes_are_grazed), TEST(cones_are_grazed), TEST_END};
