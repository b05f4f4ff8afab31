/* SPDX-License-Identifier: MIT
 * What every shape promises: its bounds are tight and nothing slips through its surface. Single
 * shapes are hit by single rays where the answer is known. */
#include "shapes.h"
#include "test.h"

static const GiVec zero = {0, 0, 0};

/* ---------------------------------------------------------------- bounds */

static void grow(GiBox *box, GiVec p) {
    box->low = gi_vec(fmin(box->low.x, p.x), fmin(box->low.y, p.y), fmin(box->low.z, p.z));
    box->high = gi_vec(fmax(box->high.x, p.x), fmax(box->high.y, p.y), fmax(box->high.z, p.z));
}

/* The extreme points of a shape lie on a circle: a rim, or for spheres every meridian. */
static GiBox box_of_circles(const Fixture *f, GiShapeRef ref) {
    GiBox box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    uint32_t i = gi_shape_index(ref);
    for (int k = 0; k < 4096; k++) {
        double angle = k * (6.283185307179586 / 4096), s = sin(angle), c = cos(angle);
        if (gi_shape_kind(ref) == GI_SHAPE_SPHERE) {
            const GiSphere *sphere = &f->spheres[i];
            grow(&box, gi_along(sphere->center, gi_vec(c, s, 0), sphere->radius));
            grow(&box, gi_along(sphere->center, gi_vec(0, c, s), sphere->radius));
        } else if (gi_shape_kind(ref) == GI_SHAPE_CONE) {
            const GiCone *cone = &f->cones[i];
            for (int side = -1; side <= 1; side += 2) {
                double z = side * cone->half_height, radius = cone->radius + cone->slope * z;
                grow(&box, gi_add(cone->center, gi_vec(c * radius, s * radius, z)));
            }
        } else {
            const GiDisc *disc = &f->discs[i];
            GiVec other = fabs(disc->normal.x) < 0.5 ? gi_vec(1, 0, 0) : gi_vec(0, 1, 0);
            GiVec u = gi_normalize(gi_cross(disc->normal, other)), v = gi_cross(disc->normal, u);
            GiVec p = gi_add(gi_scale(u, c * disc->radius), gi_scale(v, s * disc->radius));
            grow(&box, gi_add(disc->center, p));
        }
    }
    return box;
}

static void check_box(const GiBox *bounds, const GiBox *expected, double inside, double outside) {
    const double low[2][3] = {{bounds->low.x, bounds->low.y, bounds->low.z},
        {expected->low.x, expected->low.y, expected->low.z}};
    const double high[2][3] = {{bounds->high.x, bounds->high.y, bounds->high.z},
        {expected->high.x, expected->high.y, expected->high.z}};
    for (int i = 0; i < 3; i++) {
        CHECK(low[0][i] <= low[1][i] + inside && low[0][i] >= low[1][i] - outside);
        CHECK(high[0][i] >= high[1][i] - inside && high[0][i] <= high[1][i] + outside);
    }
}

static void bounds_are_tight(void) {
    static Fixture f;
    fixture_init(&f, 21, zero, 1, false);
    for (uint32_t i = 0; i < SHAPES; i++) {
        const GiShapeRef refs[] = {gi_shape_ref(GI_SHAPE_SPHERE, i), gi_shape_ref(GI_SHAPE_CONE, i),
            gi_shape_ref(GI_SHAPE_CONE, SHAPES + i), gi_shape_ref(GI_SHAPE_DISC, i)};
        for (int k = 0; k < 4; k++) {
            GiBox bounds = gi_shape_bounds(&f.shapes, refs[k], GI_SHAPE_NONE);
            GiBox expected = box_of_circles(&f, refs[k]);
            double size = gi_length(gi_sub(bounds.high, bounds.low));
            check_box(&bounds, &expected, 1e-13, 2e-6 * size);
        }
        GiBox bounds = gi_shape_bounds(&f.shapes, gi_shape_ref(GI_SHAPE_BOX, i), GI_SHAPE_NONE);
        check_box(&bounds, &f.boxes[i], 0, 0);
        bounds = gi_shape_bounds(&f.shapes, gi_shape_ref(GI_SHAPE_PLANE, i), GI_SHAPE_NONE);
        CHECK(bounds.low.x == -INFINITY && bounds.high.z == INFINITY);
    }
    /* A sphere under a transform is an ellipsoid with bounds of its own. */
    Random random = {22};
    for (uint32_t i = 0; i < PLACEMENTS; i += 5) {
        const GiPlacement *placement = &f.placements[i];
        const GiSphere *sphere = &f.spheres[gi_shape_index(placement->shape)];
        GiBox expected = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
        for (int k = 0; k < 20000; k++) {
            GiVec n = gi_normalize(direction_of(&random));
            grow(&expected, gi_affine_point(&f.transforms[placement->transform].to_world,
                                gi_along(sphere->center, n, sphere->radius)));
        }
        GiBox bounds = gi_shape_bounds(&f.shapes, gi_shape_ref(GI_SHAPE_PLACED, i), GI_SHAPE_NONE);
        double size = gi_length(gi_sub(bounds.high, bounds.low));
        check_box(&bounds, &expected, 1e-13, 2e-3 * size);
    }
}

/* ---------------------------------------------------------------- nothing slips through */

static GiVec inside_point(const Fixture *f, GiShapeRef ref, Random *random) {
    GiShapeRef own = gi_shape_unplaced(&f->shapes, ref);
    uint32_t i = gi_shape_index(own);
    double r = random_real(random, 0, 0.98), angle = random_real(random, 0, 6.28);
    GiVec p;
    if (gi_shape_kind(own) == GI_SHAPE_SPHERE) {
        p = gi_along(
            f->spheres[i].center, gi_normalize(direction_of(random)), r * f->spheres[i].radius);
    } else if (gi_shape_kind(own) == GI_SHAPE_BOX) {
        GiVec half = gi_scale(gi_sub(f->boxes[i].high, f->boxes[i].low), 0.5);
        p = gi_add(
            gi_add(f->boxes[i].low, half), gi_multiply(half, random_vec(random, -0.98, 0.98)));
    } else {
        const GiCone *cone = &f->cones[i];
        double z = cone->half_height * random_real(random, -0.98, 0.98);
        double radius = r * fabs(cone->radius + cone->slope * z);
        p = gi_add(cone->center, gi_vec(radius * cos(angle), radius * sin(angle), z));
    }
    if (own.bits == ref.bits) return p;
    const GiPlacement *placement = &f->placements[gi_shape_index(ref)];
    return gi_affine_point(&f->transforms[placement->transform].to_world, p);
}

static void check_sealed(GiVec at, double size, int rays) {
    static Fixture f;
    fixture_init(&f, 31, at, size, false);
    Random random = {32};
    Tally tally = {0};
    for (int i = 0; i < rays; i++) {
        GiShapeRef ref = shape_at(i);
        if (!is_solid(gi_shape_kind(gi_shape_unplaced(&f.shapes, ref)))) continue;
        GiVec o = inside_point(&f, ref, &random), d = direction_of(&random);
        if (i % 5 == 0) d.x = 0;
        if (i % 7 == 0) d.z = 0;
        if (i % 11 == 0) d.y = 0;
        if (gi_vec_is_zero(d)) continue;
        gi_hit_Ray ray = hit_ray(o, d);
        double t;
        if (!gi_hit_shape(&f.shapes, ref, &ray, 0, INFINITY, &t)) {
            complain(&tally, &f, ref, o, d, "leaks", 0, 0);
            continue;
        }
        tally.hits++;
        GiSurfacePoint p = gi_shape_point(&f.shapes, ref, GI_SHAPE_NONE, o, d, t, true);
        if (!(gi_dot(p.normal, d) > -1e-6)) {
            complain(&tally, &f, ref, o, d, "leaves against the normal", gi_dot(p.normal, d), t);
        }
    }
    CHECK(tally.hits > rays / 2);
    if (tally.wrong > 0) test_fail(__FILE__, __LINE__, "%d are wrong", tally.wrong);
}

static void solids_are_sealed(void) { check_sealed(zero, 1, 1400000); }
static void solids_are_sealed_far_away(void) { check_sealed(gi_vec(1e6, -2e6, 3e6), 1, 200000); }

/* A point of an edge: where two faces of a box meet, or cap and wall. */
static GiVec edge_point(const Fixture *f, GiShapeRef ref, Random *random) {
    uint32_t i = gi_shape_index(ref);
    if (gi_shape_kind(ref) == GI_SHAPE_CONE) {
        const GiCone *cone = &f->cones[i];
        double z = cone->half_height * (random_below(random, 2) ? 1 : -1);
        double radius = cone->radius + cone->slope * z, angle = random_real(random, 0, 6.28);
        double c = cos(angle), s = sin(angle);
        if (random_below(random, 4) == 0) c = random_below(random, 2) ? 1 : -1, s = 0;
        return gi_add(cone->center, gi_vec(radius * c, radius * s, z));
    }
    GiVec low = f->boxes[i].low, high = f->boxes[i].high;
    double u = random_below(random, 3) ? random_real(random, 0, 1) : 1; /* 1: a corner */
    int axis = random_below(random, 3);
    bool a = random_below(random, 2), b = random_below(random, 2);
    return gi_vec(axis == 0 ? low.x + u * (high.x - low.x)
                  : a       ? low.x
                            : high.x,
        axis == 1   ? low.y + u * (high.y - low.y)
        : axis == 0 ? (a ? low.y : high.y)
                    : (b ? low.y : high.y),
        axis == 2 ? low.z + u * (high.z - low.z)
        : b       ? low.z
                  : high.z);
}

static void edges_are_closed(void) {
    static Fixture f;
    Random random = {41};
    Tally tally = {0};
    for (int round = 0; round < 3; round++) {
        fixture_init(
            &f, 42 + (uint64_t)round, round == 2 ? gi_vec(1e6, -2e6, 3e6) : zero, 1, false);
        for (int i = 0; i < 60000; i++) {
            GiShapeRef ref = i % 3 == 0
                                 ? gi_shape_ref(GI_SHAPE_BOX, (uint32_t)i / 3 % SHAPES)
                                 : gi_shape_ref(GI_SHAPE_CONE, (uint32_t)i / 3 % (2 * SHAPES));
            GiVec edge = edge_point(&f, ref, &random), inside = inside_point(&f, ref, &random);
            /* From outside through the edge to a point inside, and on the way back. */
            GiVec o = gi_along(edge, gi_sub(edge, inside), random_real(&random, 0.1, 3));
            GiVec d = gi_sub(inside, o);
            gi_hit_Ray ray = hit_ray(o, d);
            double t;
            if (!gi_hit_shape(&f.shapes, ref, &ray, 0, 1, &t)) {
                complain(&tally, &f, ref, o, d, "slips in through an edge", 0, 0);
            }
            d = gi_sub(edge, inside);
            ray = hit_ray(inside, d);
            if (!gi_hit_shape(&f.shapes, ref, &ray, 0, INFINITY, &t)) {
                complain(&tally, &f, ref, inside, d, "slips out through an edge", 0, 0);
            } else {
                GiSurfacePoint p =
                    gi_shape_point(&f.shapes, ref, GI_SHAPE_NONE, inside, d, t, true);
                if (!(gi_dot(p.normal, d) > 0)) {
                    complain(&tally, &f, ref, inside, d, "normal at an edge", p.normal.z, t);
                }
            }
        }
    }
    if (tally.wrong > 0) test_fail(__FILE__, __LINE__, "%d are wrong", tally.wrong);
}

/* ---------------------------------------------------------------- single shapes, single rays */

static bool hit_alone(const GiShapes *shapes, GiShapeKind kind, GiVec o, GiVec d, double *t) {
    gi_hit_Ray ray = hit_ray(o, d);
    return gi_hit_shape(shapes, gi_shape_ref(kind, 0), &ray, 0, INFINITY, t);
}

static GiVec normal_alone(
    const GiShapes *shapes, GiShapeKind kind, GiVec o, GiVec d, bool geometric) {
    double t;
    if (!hit_alone(shapes, kind, o, d, &t)) return gi_vec(NAN, NAN, NAN);
    return gi_shape_point(shapes, gi_shape_ref(kind, 0), GI_SHAPE_NONE, o, d, t, geometric).normal;
}

static void check_vec(int line, GiVec a, double x, double y, double z) {
    if (!(fabs(a.x - x) < 1e-14 && fabs(a.y - y) < 1e-14 && fabs(a.z - z) < 1e-14)) {
        test_fail(__FILE__, line, "(%g %g %g), not (%g %g %g)", a.x, a.y, a.z, x, y, z);
    }
}
#define CHECK_VEC(a, x, y, z) check_vec(__LINE__, a, x, y, z)

static void tangents(void) {
    GiSphere sphere = {{0, 0, 0}, 1};
    GiCone cylinder = {{0, 0, 0}, 1, 0, 1};
    GiShapes shapes = {.spheres = &sphere, .cones = &cylinder};
    const double near = 1 - 1e-12, far = 1 + 1e-12;
    double t = NAN;
    CHECK(hit_alone(&shapes, GI_SHAPE_SPHERE, gi_vec(-5, near, 0), gi_vec(1, 0, 0), &t));
    CHECK_NEAR(t, 5, 2e-6);
    CHECK(!hit_alone(&shapes, GI_SHAPE_SPHERE, gi_vec(-5, far, 0), gi_vec(1, 0, 0), &t));
    if (hit_alone(&shapes, GI_SHAPE_SPHERE, gi_vec(-5, 1, 0), gi_vec(1, 0, 0), &t)) {
        CHECK_NEAR(t, 5, 1e-9);
    }
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(-5, near, 0.5), gi_vec(1, 0, 0), &t));
    CHECK_NEAR(t, 5, 2e-6);
    CHECK(!hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(-5, far, 0.5), gi_vec(1, 0, 0), &t));
    /* Along the wall, just inside and just outside; along the caps. */
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(near, 0, -9), gi_vec(0, 0, 1), &t));
    CHECK_NEAR(t, 8, 1e-14);
    CHECK(!hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(far, 0, -9), gi_vec(0, 0, 1), &t));
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(-5, 0, near), gi_vec(1, 0, 0), &t));
    CHECK_NEAR(t, 4, 1e-14);
    CHECK(!hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(-5, 0, far), gi_vec(1, 0, 0), &t));
    /* The axis itself. */
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(0, 0, -9), gi_vec(0, 0, 2), &t));
    CHECK_NEAR(t, 4, 0);
    CHECK_VEC(
        normal_alone(&shapes, GI_SHAPE_CONE, gi_vec(0, 0, -9), gi_vec(0, 0, 2), true), 0, 0, -1);
}

/* A ray in the plane that two boxes share belongs to exactly one of them. */
static void shared_faces(void) {
    const GiBox boxes[] = {{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}, {{0, 1, 0}, {1, 2, 1}},
        {{0, 0, 1}, {1, 1, 2}}};
    GiShapes shapes = {.boxes = boxes};
    const GiVec origins[] = {{1, 0.5, -3}, {1, -2, 0.5}, {0.5, 1, -3}, {-3, 1, 0.5}, {0.5, -3, 1}};
    const GiVec directions[] = {{0, 0, 1}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    for (int i = 0; i < 5; i++) {
        int hits = 0;
        int pair = i < 2 ? 1 : i < 4 ? 2 : 3;
        for (int k = 0; k < 2; k++) {
            gi_hit_Ray ray = hit_ray(origins[i], directions[i]);
            double t;
            uint32_t index = k == 0 ? 0 : (uint32_t)pair;
            hits += gi_hit_shape(&shapes, gi_shape_ref(GI_SHAPE_BOX, index), &ray, 0, INFINITY, &t);
        }
        CHECK_INT(hits, 1);
    }
}

static void double_cones(void) {
    /* Radius 1 at z = 0, apex at z = 1, from -2 to 2: the upper nappe has radius 1 at z = 2. */
    GiCone cone = {{0, 0, 0}, 1, -1, 2};
    GiShapes shapes = {.cones = &cone};
    double t, h = sqrt(0.5);
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(5, 0, 0), gi_vec(-1, 0, 0), &t));
    CHECK_NEAR(t, 4, 1e-15);
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(5, 0, 1.5), gi_vec(-1, 0, 0), &t));
    CHECK_NEAR(t, 4.5, 1e-15);
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(5, 0, -1.5), gi_vec(-1, 0, 0), &t));
    CHECK_NEAR(t, 2.5, 1e-15);
    /* Between the nappes, beside the apex; from one nappe to the other outside of both. */
    CHECK(!hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(5, 0.1, 1.05), gi_vec(-1, 0, 0), &t));
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(0.9, 0, 0), gi_vec(0, 0, 1), &t));
    CHECK_NEAR(t, 0.1, 1e-15);
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(0.9, 0, 0.5), gi_vec(0, 0, 1), &t));
    CHECK_NEAR(t, 1.4, 1e-15);
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(0.5, 0, 1.9), gi_vec(0, 0, -1), &t));
    CHECK_NEAR(t, 0.4, 1e-15);
    /* Through the apex from the axis the solid is whole. */
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(0, 0, 5), gi_vec(0, 0, -1), &t));
    CHECK_NEAR(t, 3, 1e-15);
    /* The caps of both ends. */
    CHECK_VEC(
        normal_alone(&shapes, GI_SHAPE_CONE, gi_vec(0.5, 0.3, 5), gi_vec(0, 0, -1), true), 0, 0, 1);
    CHECK_VEC(
        normal_alone(&shapes, GI_SHAPE_CONE, gi_vec(2, 2, -5), gi_vec(0, 0, 1), true), 0, 0, -1);
    /* First nappe: both rules agree. Second: the year's rule keeps the sign of R / H. */
    for (int geometric = 0; geometric < 2; geometric++) {
        GiVec low =
            normal_alone(&shapes, GI_SHAPE_CONE, gi_vec(5, 0, 0), gi_vec(-1, 0, 0), geometric);
        CHECK_VEC(low, h, 0, h);
        GiVec up =
            normal_alone(&shapes, GI_SHAPE_CONE, gi_vec(0, 5, 1.5), gi_vec(0, -1, 0), geometric);
        CHECK_VEC(up, 0, h, geometric ? -h : h);
    }
    /* Apex below the centre: R / H is negative. */
    cone.slope = 1;
    GiVec wall = normal_alone(&shapes, GI_SHAPE_CONE, gi_vec(5, 0, 0), gi_vec(-1, 0, 0), true);
    CHECK_VEC(wall, h, 0, -h);
    wall = normal_alone(&shapes, GI_SHAPE_CONE, gi_vec(5, 0, -1.5), gi_vec(-1, 0, 0), false);
    CHECK_VEC(wall, h, 0, -h);
    wall = normal_alone(&shapes, GI_SHAPE_CONE, gi_vec(5, 0, -1.5), gi_vec(-1, 0, 0), true);
    CHECK_VEC(wall, h, 0, h);
}

/* Section 5.7 of the scene format, sentence by sentence. */
static void interior_rule(void) {
    GiSphere sphere = {{0, 0, 0}, 1};
    GiBox box = {{-1, -1, -1}, {1, 1, 1}};
    GiCone cone = {{0, 0, 0}, 1, 0, 1}; /* a cylinder */
    GiShapes shapes = {.spheres = &sphere, .boxes = &box, .cones = &cone, .entering_only = true};
    double t;
    /* "Box: only the entering hit counts. A ray that starts inside does not meet that box." */
    CHECK(hit_alone(&shapes, GI_SHAPE_BOX, gi_vec(0.2, 0.3, 5), gi_vec(0, 0, -1), &t) && t == 4);
    CHECK(!hit_alone(&shapes, GI_SHAPE_BOX, gi_vec(0.2, 0.3, 0), gi_vec(0, 0, -1), &t));
    CHECK(!hit_alone(&shapes, GI_SHAPE_BOX, gi_vec(0.2, 0.3, 0), gi_vec(1, 2, 3), &t));
    gi_hit_Ray ray = hit_ray(gi_vec(0, 0, 5), gi_vec(0, 0, -1));
    CHECK(!gi_hit_shape(&shapes, gi_shape_ref(GI_SHAPE_BOX, 0), &ray, 4.5, 100, &t));
    /* "Of the two caps only the one the ray reaches first counts." */
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(0.2, 0.3, 5), gi_vec(0, 0, -1), &t) && t == 4);
    CHECK(!hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(0.2, 0.3, -5), gi_vec(0, 0, -1), &t));
    /* "A ray inside a cylinder meets its wall but not its caps." */
    CHECK(!hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(0.2, 0.3, 0), gi_vec(0, 0, -1), &t));
    CHECK(!hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(0, 0, 0), gi_vec(0.1, 0, 1), &t));
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(0, 0, 0), gi_vec(1, 0, 0.1), &t));
    CHECK_NEAR(t, 1, 1e-15);
    /* "Sphere: all hits count"; "Cone: all hits count." */
    CHECK(hit_alone(&shapes, GI_SHAPE_SPHERE, gi_vec(0, 0, 0), gi_vec(0, 2, 0), &t) && t == 0.5);
    cone.slope = -0.5;
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(0.1, 0, 0), gi_vec(0, 0, -1), &t));
    CHECK_NEAR(t, 1, 1e-15);
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(0, 0, 0), gi_vec(1, 0, 0), &t));
    /* Without the rule all of these are met. */
    shapes.entering_only = false;
    cone.slope = 0;
    CHECK(hit_alone(&shapes, GI_SHAPE_BOX, gi_vec(0.2, 0.3, 0), gi_vec(0, 0, -1), &t) && t == 1);
    CHECK(hit_alone(&shapes, GI_SHAPE_CONE, gi_vec(0.2, 0.3, 0), gi_vec(0, 0, -1), &t) && t == 1);
}

static void flat_shapes(void) {
    GiDisc disc = {{1, 2, 3}, {0, 0, 1}, 2};
    GiPlane plane = {{0, 0, 3}, {0, 0, 1}};
    GiShapes shapes = {.discs = &disc, .planes = &plane};
    double t;
    CHECK(hit_alone(&shapes, GI_SHAPE_DISC, gi_vec(1, 3.999, 9), gi_vec(0, 0, -3), &t) && t == 2);
    CHECK(!hit_alone(&shapes, GI_SHAPE_DISC, gi_vec(1, 4.001, 9), gi_vec(0, 0, -3), &t));
    CHECK(!hit_alone(&shapes, GI_SHAPE_DISC, gi_vec(1, 2, 9), gi_vec(0, 0, 3), &t));
    /* Within the plane: no meeting, whatever the height. */
    for (int height = 2; height <= 4; height++) {
        CHECK(!hit_alone(&shapes, GI_SHAPE_DISC, gi_vec(-9, 2, height), gi_vec(1, 0, 0), &t));
        CHECK(!hit_alone(&shapes, GI_SHAPE_PLANE, gi_vec(-9, 2, height), gi_vec(1, 0, 0), &t));
    }
    /* From both sides, with the given normal. */
    CHECK_VEC(
        normal_alone(&shapes, GI_SHAPE_DISC, gi_vec(1, 2, 9), gi_vec(0, 0, -1), true), 0, 0, 1);
    CHECK_VEC(
        normal_alone(&shapes, GI_SHAPE_DISC, gi_vec(1, 2, 0), gi_vec(0, 0, 1), true), 0, 0, 1);
    CHECK_VEC(
        normal_alone(&shapes, GI_SHAPE_PLANE, gi_vec(1e9, 2, 0), gi_vec(0, 0, 1), true), 0, 0, 1);
}

const GiTest tests_shape[] = {TEST(bounds_are_tight), TEST(solids_are_sealed),
    TEST(solids_are_sealed_far_away), TEST(edges_are_closed), TEST(tangents), TEST(shared_faces),
    TEST(double_cones), TEST(interior_rule), TEST(flat_shapes), TEST_END};
