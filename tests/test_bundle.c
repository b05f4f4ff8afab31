/* SPDX-License-Identifier: MIT
 * Bundles decide in single precision what is certain. Here nothing is: one shape, large or tiny,
 * near or far, and rays that graze its outline or end about where it begins, by parts of it from a
 * tenth to a billionth. Whoever takes too much for certain disagrees with the formula. */
#include "brute.h"
#include "random.h"
#include "test.h"

#include <math.h>
#include <string.h>

static GiVec unit(Random *random) {
    GiVec v;
    do {
        v = random_vec(random, -1, 1);
    } while (gi_length(v) < 0.1);
    return gi_normalize(v);
}

static double tiny(Random *random) {
    double part = pow(10, -random_real(random, 1, 9));
    return random_below(random, 2) ? part : -part;
}

/* A point about the surface, and mostly near the outline that is seen from the apex. */
static GiVec near_outline(GiShapeRef ref, GiVec center, GiVec half, GiVec apex, Random *random) {
    GiVec d = unit(random);
    if (gi_shape_kind(ref) == GI_SHAPE_SPHERE) {
        GiVec toward = gi_sub(apex, center);
        double distance = gi_length(toward), sine = half.x / distance;
        toward = gi_scale(toward, 1 / distance);
        GiVec across = gi_normalize(gi_sub(d, gi_scale(toward, gi_dot(d, toward))));
        double height = sine < 1 ? sine : 0;
        GiVec n = gi_add(gi_scale(toward, height), gi_scale(across, sqrt(1 - height * height)));
        if (random_below(random, 4) == 0) n = d;
        return gi_along(center, n, half.x * (1 + tiny(random)));
    }
    /* On an edge of a box, or a face. */
    double place[3] = {d.x, d.y, d.z};
    int flat = 1 + random_below(random, 2), axis = random_below(random, 3);
    for (int i = 0; i < flat; i++, axis = (axis + 1) % 3) {
        place[axis] = (place[axis] < 0 ? -1 : 1) * (1 + tiny(random));
    }
    return gi_add(center, gi_vec(half.x * place[0], half.y * place[1], half.z * place[2]));
}

static void fill(
    const Fixture *fixture, GiVec center, GiVec half, bool any, GiBundle *bundle, Random *random) {
    GiShapeRef ref = fixture->things.data[0].ref;
    double distance = pow(10, random_real(random, -1, 3)), size = gi_length(half);
    bundle->apex = gi_along(center, unit(random), size * (1 + distance));
    bundle->side = gi_vec(0, 0, 0);
    bundle->count = GI_BUNDLE_SIZE;
    bundle->start = 0;
    bundle->end = random_below(random, 4) ? 1 : 1 + tiny(random) / 2;
    if (bundle->end > 1) bundle->end = 1;
    bundle->own = false;
    for (int i = 0; i < bundle->count; i++) {
        GiVec p = near_outline(ref, center, half, bundle->apex, random), o = bundle->apex;
        /* Ending before it, in it, or behind it. */
        double part = random_below(random, 2) ? 1 + tiny(random) : random_real(random, 0.5, 2);
        GiVec d = gi_sub(p, o);
        if (any) {
            o = gi_along(o, d, part);
            d = gi_sub(bundle->apex, o);
        }
        bundle->ox[i] = o.x, bundle->oy[i] = o.y, bundle->oz[i] = o.z;
        bundle->dx[i] = d.x, bundle->dy[i] = d.y, bundle->dz[i] = d.z;
        bundle->t_min[i] = random_below(random, 2) ? 0 : fabs(tiny(random));
        bundle->t[i] = INFINITY;
        bundle->skip[i] = bundle->skip_instance[i] = GI_SHAPE_NONE;
    }
}

static int differing(const Fixture *fixture, const GiKernel *kernel, bool any, GiBundle *bundle) {
    static GiTraceRay rays[GI_BUNDLE_SIZE];
    int wrong = 0;
    for (int i = 0; i < bundle->count; i++) rays[i] = ray_of_bundle(bundle, any, i);
    (any ? kernel->bundle_any : kernel->bundle_closest)(&fixture->world.trace, bundle);
    for (int i = 0; i < bundle->count; i++) {
        GiTraceHit hit;
        bool meets = brute_force(fixture, &rays[i], &hit);
        bool same = (bundle->shape[i] != GI_SHAPE_NONE) == meets;
        if (meets && !any) same &= memcmp(&bundle->t[i], &hit.t, sizeof hit.t) == 0;
        wrong += !same;
    }
    return wrong;
}

static void grazing(bool sphere) {
    static GiBundle bundle;
    Random random = {sphere ? 11 : 12};
    for (int round = 0; round < 60; round++) {
        Fixture fixture;
        GiShapeRef ref;
        /* The scene is as large as a second shape, of which the first is a part down to 1e-5. */
        GiVec center = random_vec(&random, -1, 1), far = gi_vec(3, 3, 3);
        double size = pow(10, random_real(&random, -5, 0));
        GiVec half = {size, size, size};
        if (!sphere) half = gi_vec(size, size * random_real(&random, 0.01, 1), size);
        fixture_begin(&fixture, round % 2 ? GLINT_DIALECT_2018B : GLINT_DIALECT_2012);
        if (sphere) {
            CHECK(gi_scene_add_sphere(&fixture.scene, center, size, 0, &ref));
        } else {
            CHECK(gi_scene_add_box(
                &fixture.scene, gi_sub(center, half), gi_add(center, half), 0, &ref));
        }
        CHECK(gi_scene_place(&fixture.scene, GI_SHAPE_NONE, ref));
        CHECK(gi_scene_add_sphere(&fixture.scene, far, 1e-3, 0, &ref));
        CHECK(gi_scene_place(&fixture.scene, GI_SHAPE_NONE, ref));
        fixture_commit(&fixture, gi_kernel_at(0));
        for (int any = 0; any < 2; any++) {
            fill(&fixture, center, half, any != 0, &bundle, &random);
            const GiKernel *kernel;
            for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
                CHECK_INT(differing(&fixture, kernel, any != 0, &bundle), 0);
            }
        }
        fixture_end(&fixture);
    }
}

static void spheres_are_grazed(void) { grazing(true); }

static void boxes_are_grazed(void) { grazing(false); }

const GiTest tests_bundle[] = {TEST(spheres_are_grazed), TEST(boxes_are_grazed), TEST_END};
