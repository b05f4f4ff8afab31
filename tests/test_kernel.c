/* SPDX-License-Identifier: MIT
 * Every kernel against brute force over shape/hit.h: the same shape and the same bits of t, on
 * random and on nasty rays, in scenes of all kinds and scales. */
#include "brute.h"
#include "meshes.h"
#include "random.h"
#include "shape/hit.h"
#include "test.h"

#include <stdio.h>
#include <string.h>

/* ---------------------------------------------------------------- scenes */

/* A scene of `count` shapes in a cube of the given size at `at`; sizes spread over `range`. */
static void add_shapes(GiScene *scene, Random *random, int count, GiVec at, double size,
    double range, uint32_t group) {
    for (int i = 0; i < count; i++) {
        GiVec center = gi_add(at, random_vec(random, -size, size));
        double radius = size * 0.2 * gi_hit_maximum(pow(random_real(random, 0, 1), 8), 1 / range);
        double height = radius * random_real(random, 0.2, 4);
        GiShapeRef ref;
        bool done;
        switch (random_below(random, 8)) {
        case 0:
        case 1: done = gi_scene_add_sphere(scene, center, radius, 0, &ref); break;
        case 2: {
            GiVec b = gi_add(center, random_vec(random, -2 * radius, 2 * radius));
            done = gi_scene_add_box(scene, center, b, 0, &ref);
            break;
        }
        case 3: done = gi_scene_add_cylinder(scene, center, radius, height, 0, &ref); break;
        case 4:
        case 5: {
            double tip = center.z + height * random_real(random, -1.5, 1.5);
            if (tip == center.z) tip += height;
            done = gi_scene_add_cone(scene, center, radius, height, tip, 0, &ref);
            break;
        }
        case 6: {
            GiVec normal = random_vec(random, -1, 1);
            if (random_below(random, 2)) normal = gi_vec(0, 0, 1);
            done = gi_scene_add_disc(scene, center, normal, radius, 0, &ref);
            break;
        }
        default: /* exactly on another place in the grid: shared faces and coincident shapes */
            center = gi_vec(floor(center.x), floor(center.y), floor(center.z));
            done = gi_scene_add_box(scene, center, gi_add(center, gi_vec(1, 1, 1)), 0, &ref);
        }
        CHECK(done && gi_scene_place(scene, group, ref));
    }
}

/* ---------------------------------------------------------------- rays */

static GiTraceRay random_ray(const Fixture *fixture, Random *random, GiVec at, double size) {
    GiTraceRay ray = {
        .t_min = 0, .t_max = INFINITY, .skip = GI_SHAPE_NONE, .skip_instance = GI_SHAPE_NONE};
    ray.origin = gi_add(at, random_vec(random, -2 * size, 2 * size));
    ray.direction = random_vec(random, -1, 1);
    switch (random_below(random, 10)) {
    case 0: /* along an axis, from a grid point */
        ray.origin = gi_vec(floor(ray.origin.x), floor(ray.origin.y), floor(ray.origin.z));
        ray.direction = gi_vec(0, 0, random_below(random, 2) ? 1 : -1);
        break;
    case 1: /* in a coordinate plane */ ray.direction.y = 0; break;
    case 2: /* almost along an axis */ ray.direction = gi_vec(1e-20, 1, -1e-9); break;
    case 3: { /* starts on a surface, or inside of it */
        GiTraceHit hit;
        if (brute_force(fixture, &ray, &hit)) {
            ray.origin = gi_along(ray.origin, ray.direction, hit.t);
            ray.direction = random_vec(random, -1, 1);
        }
        break;
    }
    case 4: /* from far away */
        ray.origin = gi_add(at, gi_scale(ray.direction, -1e4 * size));
        ray.direction = gi_sub(gi_add(at, random_vec(random, -size, size)), ray.origin);
        break;
    case 5: /* a segment of odd length */
        ray.direction = gi_scale(ray.direction, size * 3);
        ray.t_max = 1;
        ray.t_min = 1e-6;
        break;
    default: /* toward the scene */
        ray.direction = gi_sub(gi_add(at, random_vec(random, -size, size)), ray.origin);
    }
    if (gi_vec_is_zero(ray.direction)) ray.direction.x = 1;
    return ray;
}

static int wrong; /* of the current comparison, to keep the report short */

static void compare_single(
    const Fixture *fixture, const GiKernel *kernel, const GiTraceRay *ray, const char *what) {
    GiTraceHit expected, found = {0};
    bool hits = brute_force(fixture, ray, &expected);
    bool found_any = kernel->closest(&fixture->world.trace, ray, &found);
    if (found_any != hits || (hits && (memcmp(&found.t, &expected.t, sizeof found.t) != 0 ||
                                          found.shape.bits != expected.shape.bits ||
                                          found.instance != expected.instance))) {
        if (wrong++ < 3) {
            test_fail(__FILE__, __LINE__,
                "%s, %s: ray (%g %g %g) + t (%g %g %g): shape %x at %.17g, not %x at %.17g", what,
                kernel->name, ray->origin.x, ray->origin.y, ray->origin.z, ray->direction.x,
                ray->direction.y, ray->direction.z, found_any ? found.shape.bits : 0,
                found_any ? found.t : 0, hits ? expected.shape.bits : 0, hits ? expected.t : 0);
        }
    }
    if (kernel->any(&fixture->world.trace, ray) != hits && wrong++ < 3) {
        test_fail(__FILE__, __LINE__, "%s, %s: any differs from closest", what, kernel->name);
    }
}

/* The same rays, and some that leave out what they would meet, many at a time. */
static void compare_many(const Fixture *fixture, const GiKernel *kernel, Random *random, GiVec at,
    double size, int count, const char *what) {
    static GiTraceRay rays[1500];
    static GiTraceHit hits[1500];
    static bool blocked[1500];
    CHECK(count <= 1500);
    for (int i = 0; i < count; i++) {
        GiTraceHit hit;
        rays[i] = random_ray(fixture, random, at, size);
        if (random_below(random, 3) == 0 && brute_force(fixture, &rays[i], &hit)) {
            switch (random_below(random, 3)) {
            case 0: rays[i].skip = hit.shape.bits, rays[i].skip_instance = hit.instance; break;
            case 1: rays[i].t_max = hit.t; break; /* the interval is open */
            default: rays[i].t_min = hit.t;
            }
        }
    }
    kernel->many_closest(&fixture->world.trace, rays, count, hits);
    kernel->many_any(&fixture->world.trace, rays, count, blocked);
    for (int i = 0; i < count; i++) {
        GiTraceHit expected;
        bool meets = brute_force(fixture, &rays[i], &expected);
        bool same = hits[i].shape.bits == expected.shape.bits && blocked[i] == meets;
        if (meets) {
            same &= memcmp(&hits[i].t, &expected.t, sizeof expected.t) == 0 &&
                    hits[i].instance == expected.instance;
        }
        if (!same && wrong++ < 3) {
            test_fail(__FILE__, __LINE__,
                "%s, %s, many: ray %d of %d: shape %x at %.17g, not %x at %.17g; blocked: %d", what,
                kernel->name, i, count, hits[i].shape.bits, hits[i].t, expected.shape.bits,
                expected.t, blocked[i]);
        }
    }
}

/* Rays from one point, or toward it when `any`, through a bundle and one by one. */
static void compare_bundle(const Fixture *fixture, const GiKernel *kernel, Random *random, GiVec at,
    double size, bool any, const char *what) {
    static GiBundle bundle;
    bundle.count = 1 + random_below(random, GI_BUNDLE_SIZE);
    bundle.apex = gi_add(at, random_vec(random, -2 * size, 2 * size));
    if (random_below(random, 4) == 0) bundle.apex = gi_add(at, gi_vec(0, 0, 50 * size));
    bundle.side = gi_vec(0, 0, 0);
    bundle.start = 0;
    bundle.end = 1;
    bundle.own = false;
    GiVec middle = gi_add(at, random_vec(random, -size, size));
    double spread = size * pow(10, random_real(random, -4, 0.3));
    for (int i = 0; i < bundle.count; i++) {
        GiVec target = gi_add(middle, random_vec(random, -spread, spread));
        GiVec d = gi_sub(target, bundle.apex), o = bundle.apex;
        if (any) {
            o = target;
            d = gi_sub(bundle.apex, target);
        }
        bundle.ox[i] = o.x, bundle.oy[i] = o.y, bundle.oz[i] = o.z;
        bundle.dx[i] = d.x, bundle.dy[i] = d.y, bundle.dz[i] = d.z;
        bundle.t_min[i] = 1e-9;
        bundle.t[i] = INFINITY;
        Thing skip = {{GI_SHAPE_NONE}, GI_SHAPE_NONE};
        if (any && i % 7 == 0) {
            skip = fixture->things.data[(size_t)i * 37 % fixture->things.count];
        }
        bundle.skip[i] = skip.ref.bits;
        bundle.skip_instance[i] = skip.instance;
    }
    static GiTraceRay rays[GI_BUNDLE_SIZE];
    for (int i = 0; i < bundle.count; i++) rays[i] = ray_of_bundle(&bundle, any, i);
    if (any) {
        kernel->bundle_any(&fixture->world.trace, &bundle);
    } else {
        kernel->bundle_closest(&fixture->world.trace, &bundle);
    }
    for (int i = 0; i < bundle.count; i++) {
        GiTraceHit expected;
        bool hits = brute_force(fixture, &rays[i], &expected);
        bool found = bundle.shape[i] != GI_SHAPE_NONE;
        bool same = found == hits;
        if (same && hits && !any) {
            same = memcmp(&bundle.t[i], &expected.t, sizeof expected.t) == 0 &&
                   bundle.shape[i] == expected.shape.bits &&
                   bundle.instance[i] == expected.instance;
        }
        if (!same && wrong++ < 3) {
            test_fail(__FILE__, __LINE__, "%s, %s, bundle %s: ray %d of %d: shape %x, not %x", what,
                kernel->name, any ? "any" : "closest", i, bundle.count, bundle.shape[i],
                expected.shape.bits);
        }
    }
}

static void compare_all(const Fixture *fixture, GiVec at, double size, int rays, const char *what) {
    wrong = 0;
    const GiKernel *kernel;
    for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
        Random random = {99};
        for (int i = 0; i < rays; i++) {
            GiTraceRay ray = random_ray(fixture, &random, at, size);
            compare_single(fixture, kernel, &ray, what);
        }
        compare_many(fixture, kernel, &random, at, size, rays, what);
        for (int i = 1; i < 80; i += 13) {
            compare_many(fixture, kernel, &random, at, size, i, what);
        }
        for (int i = 0; i < rays / 64; i++) {
            compare_bundle(fixture, kernel, &random, at, size, false, what);
            compare_bundle(fixture, kernel, &random, at, size, true, what);
        }
    }
}

static void run_scene(int count, GiVec at, double size, double range, GlintDialect dialect,
    int rays, const char *what) {
    Fixture fixture;
    fixture_begin(&fixture, dialect);
    Random random = {(uint64_t)count + 17};
    add_shapes(&fixture.scene, &random, count, at, size, range, GI_SHAPE_NONE);
    fixture_commit(&fixture, gi_kernel_at(0));
    compare_all(&fixture, at, size, rays, what);
    fixture_end(&fixture);
}

/* ---------------------------------------------------------------- tests */

static const GiVec origin = {0, 0, 0};

static void few_shapes(void) {
    for (int count = 1; count <= 20; count++) {
        run_scene(count, origin, 4, 10, GLINT_DIALECT_GLINT, 400, "few shapes");
    }
}

static void many_shapes(void) {
    run_scene(3000, origin, 10, 100, GLINT_DIALECT_GLINT, 1500, "many shapes");
}

static void interior_rule(void) {
    run_scene(200, origin, 6, 10, GLINT_DIALECT_2012, 1500, "interior rule");
}

static void large_range(void) {
    run_scene(1000, origin, 1e5, 1e6, GLINT_DIALECT_GLINT, 1500, "range of sizes 10^5 to 1");
}

static void far_away(void) {
    run_scene(500, gi_vec(1e6, -2e6, 3e6), 3, 30, GLINT_DIALECT_GLINT, 1500, "far from the origin");
}

static void extreme_scales(void) {
    run_scene(100, origin, 1e-30, 10, GLINT_DIALECT_GLINT, 500, "tiny scene");
    run_scene(100, origin, 1e30, 10, GLINT_DIALECT_GLINT, 500, "huge scene");
}

static void one_outlier(void) {
    Fixture fixture;
    fixture_begin(&fixture, GLINT_DIALECT_GLINT);
    Random random = {5};
    add_shapes(&fixture.scene, &random, 500, origin, 5, 10, GI_SHAPE_NONE);
    GiShapeRef ref;
    CHECK(gi_scene_add_sphere(&fixture.scene, gi_vec(0, -1e9, 0), 1e9 - 6, 0, &ref));
    CHECK(gi_scene_place(&fixture.scene, GI_SHAPE_NONE, ref));
    CHECK(gi_scene_add_plane(&fixture.scene, gi_vec(0, 0, -5), gi_vec(0, 0.1, 1), 0, &ref));
    CHECK(gi_scene_place(&fixture.scene, GI_SHAPE_NONE, ref));
    fixture_commit(&fixture, gi_kernel_at(0));
    compare_all(&fixture, origin, 5, 1000, "an outlier and a plane");
    fixture_end(&fixture);
}

static void groups(void) {
    Fixture fixture;
    fixture_begin(&fixture, GLINT_DIALECT_GLINT);
    GiScene *scene = &fixture.scene;
    Random random = {6};
    uint32_t parent = GI_SHAPE_NONE;
    for (int depth = 0; depth < 6; depth++) {
        GiShapeRef group;
        CHECK(gi_scene_add_group(scene, &group));
        uint32_t index = gi_shape_index(group);
        CHECK(gi_scene_add_step(scene, index, GI_STEP_TRANSLATE, random_vec(&random, -2, 2)));
        CHECK(gi_scene_add_step(scene, index, GI_STEP_ROTATE, random_vec(&random, -180, 180)));
        GiVec scale = gi_vec(random_real(&random, 0.5, 2), -1, random_real(&random, 0.1, 1.5));
        CHECK(gi_scene_add_step(scene, index, GI_STEP_SCALE, scale));
        add_shapes(scene, &random, 40, origin, 3, 10, index);
        CHECK(gi_scene_place(scene, parent, group));
        /* Shared: the same group once more, at the top. */
        CHECK(gi_scene_place(scene, GI_SHAPE_NONE, group));
        parent = index;
    }
    fixture_commit(&fixture, gi_kernel_at(0));
    compare_all(&fixture, origin, 4, 1000, "groups");
    fixture_end(&fixture);
}

static void place_moved(Fixture *fixture, Random *random, GiShapeRef ref, GiVec at, double size) {
    GiScene *scene = &fixture->scene;
    GiShapeRef group;
    CHECK(gi_scene_add_group(scene, &group));
    uint32_t index = gi_shape_index(group);
    GiVec scale = gi_vec(random_real(random, 0.5, 2), -1, random_real(random, 0.1, 1.5));
    GiVec move = gi_add(at, random_vec(random, -size, size));
    CHECK(gi_scene_add_step(scene, index, GI_STEP_TRANSLATE, move));
    CHECK(gi_scene_add_step(scene, index, GI_STEP_ROTATE, random_vec(random, -180, 180)));
    CHECK(gi_scene_add_step(scene, index, GI_STEP_SCALE, scale));
    CHECK(gi_scene_place(scene, index, ref));
    CHECK(gi_scene_place(scene, GI_SHAPE_NONE, group));
}

/* Meshes that stand as they are, among other shapes; the triangles of several in one tree. */
static void meshes(void) {
    static const GiVec places[] = {{0, 0, 0}, {1000, -2000, 3000}};
    for (int i = 0; i < 2; i++) {
        Fixture fixture;
        fixture_begin(&fixture, GLINT_DIALECT_GLINT);
        Random random = {7};
        GiScene *scene = &fixture.scene;
        GiVec at = places[i];
        const GiShapeRef refs[] = {mesh_sphere(scene, at, 3, 12, 0.1, true, true, &random),
            mesh_sphere(scene, gi_add(at, gi_vec(1, 1, 0)), 2, 7, 0, false, false, &random),
            mesh_soup(scene, at, 3, 400, &random)};
        for (int k = 0; k < 3; k++) CHECK(gi_scene_place(scene, GI_SHAPE_NONE, refs[k]));
        add_shapes(scene, &random, 100, at, 3, 10, GI_SHAPE_NONE);
        fixture_commit(&fixture, gi_kernel_at(0));
        CHECK(fixture.things.count > 1000);
        compare_all(&fixture, at, 4, 1000, "meshes");
        fixture_end(&fixture);
    }
}

static void large_and_small_triangles(void) {
    static const double sizes[] = {1e-30, 1e-5, 1e30};
    for (int i = 0; i < 3; i++) {
        Fixture fixture;
        fixture_begin(&fixture, GLINT_DIALECT_GLINT);
        Random random = {8};
        GiScene *scene = &fixture.scene;
        double size = sizes[i];
        GiShapeRef ref = mesh_sphere(scene, origin, size, 9, 0.1, false, true, &random);
        CHECK(gi_scene_place(scene, GI_SHAPE_NONE, ref));
        ref = mesh_soup(scene, origin, size, 100, &random);
        CHECK(gi_scene_place(scene, GI_SHAPE_NONE, ref));
        if (i == 1) { /* beside what is large, all of them are a point to the tree */
            CHECK(gi_scene_add_sphere(scene, gi_vec(0, -1e9, 0), 1e9 - 1, 0, &ref));
            CHECK(gi_scene_place(scene, GI_SHAPE_NONE, ref));
        }
        fixture_commit(&fixture, gi_kernel_at(0));
        compare_all(&fixture, origin, size, 500, "large and small triangles");
        fixture_end(&fixture);
    }
}

/* Meshes and groups that are used again and again, here and there, one in the other. */
static void instances(void) {
    for (int year = 0; year < 2; year++) {
        Fixture fixture;
        fixture_begin(&fixture, year == 0 ? GLINT_DIALECT_GLINT : GLINT_DIALECT_2012);
        Random random = {9};
        GiScene *scene = &fixture.scene;
        GiShapeRef mesh = mesh_sphere(scene, origin, 1, 6, 0.2, true, true, &random);
        GiShapeRef once = mesh_soup(scene, origin, 1, 50, &random);
        GiShapeRef group;
        CHECK(gi_scene_add_group(scene, &group));
        add_shapes(scene, &random, 30, origin, 1, 10, gi_shape_index(group));
        CHECK(gi_scene_place(scene, GI_SHAPE_NONE, mesh));
        for (int i = 0; i < 8; i++) {
            place_moved(&fixture, &random, mesh, origin, 3);
            place_moved(&fixture, &random, group, origin, 3);
        }
        /* Exactly the same again: ties between instances. */
        CHECK(gi_scene_place(scene, GI_SHAPE_NONE, mesh));
        CHECK(gi_scene_place(scene, GI_SHAPE_NONE, group));
        CHECK(gi_scene_place(scene, GI_SHAPE_NONE, group));
        place_moved(&fixture, &random, once, origin, 3);
        add_shapes(scene, &random, 20, origin, 3, 10, GI_SHAPE_NONE);
        fixture_commit(&fixture, gi_kernel_at(0));
        CHECK_INT(fixture.world.spread.instances.count, 21);
        CHECK_INT(fixture.world.inner_count, 3);
        compare_all(&fixture, origin, 4, 1000, "instances");
        fixture_end(&fixture);
    }
}

/* A plane in a group that is used often: an instance without bounds. */
static void unbounded_instances(void) {
    Fixture fixture;
    fixture_begin(&fixture, GLINT_DIALECT_GLINT);
    Random random = {10};
    GiScene *scene = &fixture.scene;
    GiShapeRef group, plane;
    CHECK(gi_scene_add_group(scene, &group));
    add_shapes(scene, &random, 30, origin, 1, 10, gi_shape_index(group));
    CHECK(gi_scene_add_plane(scene, gi_vec(0, 0, -2), gi_vec(0.1, 0, 1), 0, &plane));
    CHECK(gi_scene_place(scene, gi_shape_index(group), plane));
    for (int i = 0; i < 3; i++) place_moved(&fixture, &random, group, origin, 3);
    fixture_commit(&fixture, gi_kernel_at(0));
    CHECK_INT(fixture.world.inner_count, 1);
    CHECK_INT(fixture.world.store.tree.unbounded_count, 3);
    compare_all(&fixture, origin, 4, 500, "unbounded instances");
    fixture_end(&fixture);
}

/* Far from the world's origin, near to the eye, and the other way round. */
static void instances_far_away(void) {
    const GiVec at = {1e6, -2e6, 3e6};
    Fixture fixture;
    fixture_begin(&fixture, GLINT_DIALECT_GLINT);
    Random random = {11};
    GiScene *scene = &fixture.scene;
    GiShapeRef mesh = mesh_sphere(scene, origin, 1, 8, 0.2, true, true, &random);
    for (int i = 0; i < 6; i++) place_moved(&fixture, &random, mesh, at, 3);
    fixture_commit(&fixture, gi_kernel_at(0));
    compare_all(&fixture, at, 4, 1000, "instances far away");
    fixture_end(&fixture);
}

/* Rectangles in the place of what shines. */
static void rectangles(void) {
    Fixture fixture;
    fixture_begin(&fixture, GLINT_DIALECT_2018B);
    Random random = {12};
    GiScene *scene = &fixture.scene;
    for (int i = 0; i < 60; i++) {
        GiLight light = gi_light_default();
        light.type = GLINT_LIGHT_RECTANGLE;
        light.position = random_vec(&random, -3, 3);
        light.direction = i % 3 == 0 ? gi_vec(0, 0, -1) : random_vec(&random, -1, 1);
        light.up = i % 3 == 0 ? gi_vec(0, 1, 0) : random_vec(&random, -1, 1);
        light.width = random_real(&random, 0.1, 3);
        light.height = random_real(&random, 0.1, 3);
        CHECK(gi_array_push(scene->memory, &scene->lights, light));
    }
    add_shapes(scene, &random, 60, origin, 3, 10, GI_SHAPE_NONE);
    fixture_commit(&fixture, gi_kernel_at(0));
    CHECK_INT(fixture.things.count, 120);
    compare_all(&fixture, origin, 4, 1000, "rectangles");
    fixture_end(&fixture);
}

/* Groups of groups, each twice the one before: 2^24 times as many shapes, and a picture all the
 * same. */
static void doubled_groups(void) {
    Fixture fixture;
    fixture_begin(&fixture, GLINT_DIALECT_GLINT);
    Random random = {13};
    GiScene *scene = &fixture.scene;
    GiShapeRef inner;
    CHECK(gi_scene_add_group(scene, &inner));
    add_shapes(scene, &random, 20, origin, 1, 10, gi_shape_index(inner));
    for (int level = 0; level < 24; level++) {
        GiShapeRef outer;
        CHECK(gi_scene_add_group(scene, &outer));
        uint32_t index = gi_shape_index(outer);
        CHECK(gi_scene_add_step(scene, index, GI_STEP_TRANSLATE, random_vec(&random, -1, 1)));
        CHECK(gi_scene_place(scene, index, inner));
        CHECK(gi_scene_place(scene, index, inner));
        inner = outer;
    }
    CHECK(gi_scene_place(scene, GI_SHAPE_NONE, inner));
    fixture_commit(&fixture, gi_kernel_at(0));
    CHECK_INT(fixture.world.inner_count, 1);
    CHECK(fixture.world.primitive_count < 200000);
    fixture_end(&fixture);
}

/* All in one point, all alike: no split helps, and ties everywhere. */
static void coincident(void) {
    Fixture fixture;
    fixture_begin(&fixture, GLINT_DIALECT_GLINT);
    for (int i = 0; i < 300; i++) {
        GiShapeRef ref;
        CHECK(gi_scene_add_sphere(&fixture.scene, gi_vec(1, 2, 3), 1, 0, &ref));
        CHECK(gi_scene_place(&fixture.scene, GI_SHAPE_NONE, ref));
    }
    fixture_commit(&fixture, gi_kernel_at(0));
    compare_all(&fixture, gi_vec(1, 2, 3), 2, 300, "coincident");
    fixture_end(&fixture);
}

/* Sizes and distances that halve each time give the deepest tree a builder can make. */
static void deep_tree(void) {
    Fixture fixture;
    fixture_begin(&fixture, GLINT_DIALECT_GLINT);
    for (int i = 0; i < 900; i++) {
        double x = ldexp(1, -i);
        GiShapeRef ref;
        CHECK(gi_scene_add_sphere(&fixture.scene, gi_vec(x, 0, 0), x / 4, 0, &ref));
        CHECK(gi_scene_place(&fixture.scene, GI_SHAPE_NONE, ref));
    }
    fixture_commit(&fixture, gi_kernel_at(0));
    compare_all(&fixture, origin, 1, 300, "deep tree");
    fixture_end(&fixture);
}

/* More children on the way than a ray under way among others can note down: all of the shells are
 * met, level after level, before anything is hit. */
static void wide_and_deep_tree(void) {
    Fixture fixture;
    fixture_begin(&fixture, GLINT_DIALECT_GLINT);
    double size = 1;
    for (int i = 0; i < 120; i++, size *= 0.8) {
        for (int k = 0; k < 8; k++) {
            GiShapeRef ref;
            GiVec corner = gi_vec(size, (k + 1) * 1e-3 * size, (k + 1) * 1e-3 * size);
            GiVec opposite = gi_vec(-size * (1 - k * 1e-3), -corner.y, -corner.z * 0.5);
            CHECK(gi_scene_add_box(&fixture.scene, corner, opposite, 0, &ref));
            CHECK(gi_scene_place(&fixture.scene, GI_SHAPE_NONE, ref));
        }
    }
    fixture_commit(&fixture, gi_kernel_at(0));
    compare_all(&fixture, origin, 1, 300, "wide and deep tree");
    fixture_end(&fixture);
}

static void empty_scene(void) {
    Fixture fixture;
    fixture_begin(&fixture, GLINT_DIALECT_GLINT);
    fixture_commit(&fixture, gi_kernel_at(0));
    GiTraceRay ray = {.direction = {0, 0, 1}, .t_max = INFINITY, .skip = GI_SHAPE_NONE};
    GiTraceHit hit;
    CHECK(!gi_kernel_at(0)->closest(&fixture.world.trace, &ray, &hit));
    bool blocked = true;
    gi_kernel_at(0)->many_closest(&fixture.world.trace, &ray, 1, &hit);
    CHECK_INT(hit.shape.bits, GI_SHAPE_NONE);
    gi_kernel_at(0)->many_any(&fixture.world.trace, &ray, 1, &blocked);
    CHECK(!blocked);
    gi_kernel_at(0)->many_any(&fixture.world.trace, &ray, 0, &blocked);
    static GiBundle bundle;
    bundle.count = 100;
    for (int i = 0; i < 100; i++) {
        bundle.dx[i] = i * 0.001;
        bundle.dz[i] = 1;
        bundle.t[i] = INFINITY;
    }
    gi_kernel_at(0)->bundle_closest(&fixture.world.trace, &bundle);
    for (int i = 0; i < 100; i++) CHECK(bundle.shape[i] == GI_SHAPE_NONE);
    fixture_end(&fixture);
}

/* Whatever the directions, each ray has one place; and packets of rays over a square are small. */
static void regrouped(void) {
    static GiRegroup regroup;
    static float x[GI_REGROUP_LIMIT], y[GI_REGROUP_LIMIT], z[GI_REGROUP_LIMIT];
    static const int counts[] = {
        1, 15, 16, 17, 1000, 1024, 1025, 2 * GI_BUNDLE_SIZE, 5000, GI_REGROUP_LIMIT};
    const GiKernel *kernel;
    for (int isa = 0; (kernel = gi_kernel_at(isa)) != NULL; isa++) {
        for (int kind = 0; kind < 4; kind++) {
            for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
                Random random = {(uint64_t)kind + 5};
                int count = counts[k];
                for (int i = 0; i < count; i++) {
                    GiVec d = random_vec(&random, -1, 1);
                    x[i] = kind == 1 ? 0.5f : (float)d.x;
                    y[i] = kind == 1 ? 0.25f : (float)d.y;
                    z[i] = kind == 0 ? 2 : kind == 1 ? 1 : (float)d.z;
                    if (kind == 3) x[i] = NAN;
                }
                kernel->regroup(&regroup, x, y, z, count, 1e9);
                bool seen[GI_REGROUP_LIMIT] = {false};
                for (int i = 0; i < count; i++) seen[regroup.order[i]] = true;
                int seen_count = 0;
                for (int i = 0; i < count; i++) seen_count += seen[i];
                CHECK_INT(seen_count, count);
                if (kind > 0) continue;
                double area = 0;
                for (int i = 0; i + GI_PACKET_SIZE <= count; i += GI_PACKET_SIZE) {
                    float low[2] = {1, 1}, high[2] = {-1, -1};
                    for (int j = i; j < i + GI_PACKET_SIZE; j++) {
                        int ray = regroup.order[j];
                        low[0] = fminf(low[0], x[ray]), high[0] = fmaxf(high[0], x[ray]);
                        low[1] = fminf(low[1], y[ray]), high[1] = fmaxf(high[1], y[ray]);
                    }
                    area += (double)((high[0] - low[0]) * (high[1] - low[1]));
                }
                CHECK(area < 2 * 4); /* twice the square's */
            }
        }
    }
}

static void names(void) {
    CHECK(gi_kernel_find(NULL) == gi_kernel_at(0));
    CHECK(gi_kernel_find("portable") != NULL);
    CHECK(gi_kernel_find("sse9") == NULL);
}

const GiTest tests_kernel[] = {TEST(names), TEST(regrouped), TEST(empty_scene), TEST(few_shapes),
    TEST(many_shapes), TEST(interior_rule), TEST(large_range), TEST(far_away), TEST(extreme_scales),
    TEST(one_outlier), TEST(groups), TEST(meshes), TEST(large_and_small_triangles), TEST(instances),
    TEST(unbounded_instances), TEST(instances_far_away), TEST(rectangles), TEST(doubled_groups),
    TEST(coincident), TEST(deep_tree), TEST(wide_and_deep_tree), TEST_END};
