/* SPDX-License-Identifier: MIT
 * Every shape against another way to say what it is: a function that is negative inside. Where the
 * reference finds a ray's line inside of the solid, computed in long double, the hit must be. */
#include "shapes.h"
#include "test.h"

typedef long double Real;
typedef struct RealVec {
    Real x, y, z;
} RealVec;

/* ---------------------------------------------------------------- the reference */

static RealVec real_vec(GiVec v) { return (RealVec){v.x, v.y, v.z}; }
static RealVec real_along(RealVec o, RealVec d, Real t) {
    return (RealVec){o.x + t * d.x, o.y + t * d.y, o.z + t * d.z};
}
static Real real_dot(RealVec a, RealVec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static Real real_length(RealVec a) { return sqrtl(real_dot(a, a)); }
static RealVec real_from(RealVec p, GiVec c) { return (RealVec){p.x - c.x, p.y - c.y, p.z - c.z}; }

/* World to object: the adjugate over the determinant, in long double. */
static RealVec to_object(const GiAffine *a, RealVec p, bool is_point) {
    Real m[3][3], b[3] = {p.x, p.y, p.z}, r[3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) m[i][j] = a->m[i][j];
        if (is_point) b[i] -= a->m[i][3];
    }
    Real det = 0;
    for (int j = 0; j < 3; j++) {
        int k = (j + 1) % 3, l = (j + 2) % 3;
        det += m[0][j] * (m[1][k] * m[2][l] - m[1][l] * m[2][k]);
        r[j] = 0;
        for (int i = 0; i < 3; i++) {
            int u = (i + 1) % 3, v = (i + 2) % 3;
            r[j] += b[i] * (m[u][k] * m[v][l] - m[u][l] * m[v][k]);
        }
    }
    return (RealVec){r[0] / det, r[1] / det, r[2] / det};
}

/* Negative inside, positive outside; for flat shapes the signed distance from the plane. */
static Real depth_of(const GiShapes *shapes, GiShapeRef ref, RealVec p) {
    uint32_t i = gi_shape_index(ref);
    switch (gi_shape_kind(ref)) {
    case GI_SHAPE_SPHERE:
        return real_length(real_from(p, shapes->spheres[i].center)) - shapes->spheres[i].radius;
    case GI_SHAPE_BOX: {
        const GiBox *box = &shapes->boxes[i];
        Real x = fmaxl(box->low.x - p.x, p.x - box->high.x);
        Real y = fmaxl(box->low.y - p.y, p.y - box->high.y);
        Real z = fmaxl(box->low.z - p.z, p.z - box->high.z);
        return fmaxl(x, fmaxl(y, z));
    }
    case GI_SHAPE_CONE: {
        const GiCone *cone = &shapes->cones[i];
        RealVec q = real_from(p, cone->center);
        Real radius = fabsl(cone->radius + (Real)cone->slope * q.z);
        return fmaxl(fabsl(q.z) - cone->half_height, sqrtl(q.x * q.x + q.y * q.y) - radius);
    }
    case GI_SHAPE_DISC:
        return real_dot(real_from(p, shapes->discs[i].center), real_vec(shapes->discs[i].normal));
    case GI_SHAPE_PLANE:
        return real_dot(real_from(p, shapes->planes[i].point), real_vec(shapes->planes[i].normal));
    default: {
        const GiPlacement *placement = &shapes->placements[i];
        return depth_of(shapes, placement->shape,
            to_object(&shapes->transforms[placement->transform].to_world, p, true));
    }
    }
}

typedef struct Crossings {
    Real t[12];
    int count;
} Crossings;

static void add_crossing(Crossings *c, Real t) {
    if (!isfinite(t)) return;
    int i = c->count++;
    for (; i > 0 && c->t[i - 1] > t; i--) c->t[i] = c->t[i - 1];
    c->t[i] = t;
}

/* Roots of a t^2 + 2 b t + c. */
static void add_roots(Crossings *crossings, Real shift, Real a, Real b, Real c) {
    Real discriminant = b * b - a * c;
    if (discriminant < 0) return;
    Real q = -b - copysignl(sqrtl(discriminant), b);
    add_crossing(crossings, shift + q / a);
    add_crossing(crossings, shift + c / q);
}

/* Every t at which the line may pass the surface of an unplaced shape. The line is counted from its
 * point nearest to the centre, where the numbers are small. */
static void find_crossings(
    const GiShapes *shapes, GiShapeRef ref, RealVec o, RealVec d, Crossings *crossings) {
    uint32_t i = gi_shape_index(ref);
    switch (gi_shape_kind(ref)) {
    case GI_SHAPE_SPHERE: {
        RealVec q = real_from(o, shapes->spheres[i].center);
        Real shift = -real_dot(q, d) / real_dot(d, d), r = shapes->spheres[i].radius;
        q = real_along(q, d, shift);
        add_roots(crossings, shift, real_dot(d, d), real_dot(q, d), real_dot(q, q) - r * r);
        return;
    }
    case GI_SHAPE_BOX: {
        const GiBox *box = &shapes->boxes[i];
        add_crossing(crossings, (box->low.x - o.x) / d.x);
        add_crossing(crossings, (box->high.x - o.x) / d.x);
        add_crossing(crossings, (box->low.y - o.y) / d.y);
        add_crossing(crossings, (box->high.y - o.y) / d.y);
        add_crossing(crossings, (box->low.z - o.z) / d.z);
        add_crossing(crossings, (box->high.z - o.z) / d.z);
        return;
    }
    case GI_SHAPE_CONE: {
        const GiCone *cone = &shapes->cones[i];
        RealVec q = real_from(o, cone->center);
        add_crossing(crossings, (cone->half_height - q.z) / d.z);
        add_crossing(crossings, (-cone->half_height - q.z) / d.z);
        Real shift = -real_dot(q, d) / real_dot(d, d), slope = cone->slope;
        q = real_along(q, d, shift);
        Real rho = cone->radius + slope * q.z;
        add_roots(crossings, shift, d.x * d.x + d.y * d.y - slope * d.z * slope * d.z,
            q.x * d.x + q.y * d.y - rho * slope * d.z, q.x * q.x + q.y * q.y - rho * rho);
        return;
    }
    default: {
        bool disc = gi_shape_kind(ref) == GI_SHAPE_DISC;
        RealVec normal = real_vec(disc ? shapes->discs[i].normal : shapes->planes[i].normal);
        Real t = -depth_of(shapes, ref, o) / real_dot(d, normal);
        if (disc) {
            Real away = real_length(real_from(real_along(o, d, t), shapes->discs[i].center));
            if (!(away <= shapes->discs[i].radius)) return;
        }
        add_crossing(crossings, t);
        return;
    }
    }
}

/* Where the ray meets the shape after t_min, or a negative number. Of the crossings those count
 * where the line changes from inside to outside or back. */
static Real expected_hit(
    const GiShapes *shapes, GiShapeRef ref, GiVec origin, GiVec direction, double t_min) {
    RealVec o = real_vec(origin), d = real_vec(direction);
    if (gi_shape_kind(ref) == GI_SHAPE_PLACED) {
        const GiPlacement *placement = &shapes->placements[gi_shape_index(ref)];
        const GiAffine *to_world = &shapes->transforms[placement->transform].to_world;
        o = to_object(to_world, o, true);
        d = to_object(to_world, d, false);
        ref = placement->shape;
    }
    Crossings crossings = {.count = 0};
    find_crossings(shapes, ref, o, d, &crossings);
    GiShapeKind kind = gi_shape_kind(ref);
    const GiCone *cone = kind == GI_SHAPE_CONE ? &shapes->cones[gi_shape_index(ref)] : NULL;
    bool was_inside = false;
    for (int i = 0; i < crossings.count; i++) {
        Real t = crossings.t[i];
        if (!is_solid(kind)) return t > t_min ? t : -1;
        Real next = i + 1 < crossings.count ? (t + crossings.t[i + 1]) / 2 : t + fabsl(t) + 1;
        bool inside = depth_of(shapes, ref, real_along(o, d, next)) < 0;
        bool changes = inside != was_inside;
        was_inside = inside;
        if (!changes || t <= t_min) continue;
        if (inside || !shapes->entering_only) return t;
        /* The interior rule: no exits from boxes, none through the caps of cylinders. */
        if (kind == GI_SHAPE_BOX) continue;
        if (kind == GI_SHAPE_CONE && cone->slope == 0) {
            Real height = fabsl(o.z + t * d.z - cone->center.z);
            if (fabsl(height - cone->half_height) < 1e-9L * cone->half_height) continue;
        }
        return t;
    }
    return -1;
}

/* ---------------------------------------------------------------- comparison */

/* The outward direction of the surface at p, by differences. False near an edge, where the two
 * sides of the difference do not agree. */
static bool slope_at(const Fixture *f, GiShapeRef ref, RealVec p, RealVec *normal) {
    Real h = 1e-6L * f->size, g[3], forward[3], at = depth_of(&f->shapes, ref, p);
    for (int i = 0; i < 3; i++) {
        RealVec a = p, b = p;
        Real *ai = i == 0 ? &a.x : i == 1 ? &a.y : &a.z, *bi = i == 0 ? &b.x : i == 1 ? &b.y : &b.z;
        *ai -= h;
        *bi += h;
        Real low = depth_of(&f->shapes, ref, a), high = depth_of(&f->shapes, ref, b);
        g[i] = (high - low) / (2 * h);
        forward[i] = (high - at) / h;
    }
    RealVec v = {g[0], g[1], g[2]};
    Real length = real_length(v);
    for (int i = 0; i < 3; i++) {
        if (fabsl(forward[i] - g[i]) > 1e-3L * length) return false;
    }
    *normal = (RealVec){v.x / length, v.y / length, v.z / length};
    return true;
}

static void check_surface(
    Tally *tally, const Fixture *f, GiShapeRef ref, GiVec o, GiVec d, double t, Real expected) {
    GiSurfacePoint at = gi_shape_point(&f->shapes, ref, GI_SHAPE_NONE, o, d, t, true);
    if (fabs(gi_length(at.normal) - 1) > 1e-15) {
        complain(tally, f, ref, o, d, "normal's length", gi_length(at.normal), 1);
    }
    RealVec point = real_along(real_vec(o), real_vec(d), expected);
    Real off = fabsl(t - expected) * fabsl(real_dot(real_vec(d), real_vec(at.normal)));
    if (!(off <= at.error)) complain(tally, f, ref, o, d, "distance from the hit", off, at.error);
    RealVec normal;
    if (!slope_at(f, ref, point, &normal)) return;
    Real agree = real_dot(normal, real_vec(at.normal));
    /* A thousandth of a radian: near an apex the normal turns fast. */
    if (!(agree > 1 - 1e-6L)) complain(tally, f, ref, o, d, "normal . slope", agree, 1);
    RealVec moved = real_vec(at.point);
    Real height =
        fabsl(real_dot((RealVec){moved.x - point.x, moved.y - point.y, moved.z - point.z}, normal));
    /* A point is moved onto the surface to the last bits: 16 of the 2048 roundings of the error. */
    double most = gi_shape_kind(ref) == GI_SHAPE_PLACED ? at.error : at.error / 128;
    if (!(height <= most)) {
        complain(tally, f, ref, o, d, "point's height over the surface", height, most);
    }
    GiBox box = gi_shape_bounds(&f->shapes, ref, GI_SHAPE_NONE);
    double e = at.error;
    if (at.point.x < box.low.x - e || at.point.y < box.low.y - e || at.point.z < box.low.z - e ||
        at.point.x > box.high.x + e || at.point.y > box.high.y + e || at.point.z > box.high.z + e) {
        complain(tally, f, ref, o, d, "point outside of the bounds", at.point.x, at.error);
    }
}

static bool compare(
    Tally *tally, const Fixture *f, GiShapeRef ref, GiVec o, GiVec d, double t_min, double *t) {
    gi_hit_Ray ray = hit_ray(o, d);
    Real expected = expected_hit(&f->shapes, ref, o, d, t_min);
    bool hit = gi_hit_shape(&f->shapes, ref, &ray, t_min, INFINITY, t);
    if (hit != (expected > 0)) {
        complain(tally, f, ref, o, d, "hit, expected", hit ? *t : -1, (double)expected);
        return false;
    }
    tally->hits += hit;
    tally->misses += !hit;
    if (hit) check_surface(tally, f, ref, o, d, *t, expected);
    return hit;
}

static GiVec ray_toward(const Fixture *f, Random *random, GiShapeRef ref, GiVec *origin) {
    GiBox box = gi_shape_bounds(&f->shapes, ref, GI_SHAPE_NONE);
    if (!isfinite(box.low.x)) {
        GiVec reach = gi_vec(f->size, f->size, f->size);
        box = (GiBox){gi_sub(f->at, reach), gi_add(f->at, reach)};
    }
    GiVec middle = gi_scale(gi_add(box.low, box.high), 0.5), half = gi_sub(box.high, middle);
    double distance = gi_length(half) * exp2(random_real(random, -4, 6));
    *origin = gi_add(middle, gi_scale(direction_of(random), distance));
    GiVec target = gi_add(middle, gi_multiply(half, random_vec(random, -1.2, 1.2)));
    GiVec d = gi_sub(target, *origin);
    switch (random_below(random, 12)) {
    case 0: d.x = 0; break;
    case 1: d.z = 0; break;
    case 2: d.x = -0.0, d.y = 0; break;
    case 3: d.y = d.z = 0; break;
    case 4: d.z *= 1e-12; break;
    case 5: d.x *= 1e-9, d.y *= 1e-9; break;
    default: break;
    }
    if (d.x == 0) origin->x = target.x;
    if (d.y == 0) origin->y = target.y;
    if (d.z == 0) origin->z = target.z;
    return gi_scale(d, exp2(random_below(random, 21) - 10));
}

static void compare_many(GiVec at, double size, bool entering_only, int rays) {
    static Fixture f;
    fixture_init(&f, 11, at, size, entering_only);
    Random random = {12};
    Tally tally = {0};
    for (int i = 0; i < rays; i++) {
        GiVec origin;
        GiShapeRef ref = shape_at(i);
        GiVec d = ray_toward(&f, &random, ref, &origin);
        if (gi_vec_is_zero(d)) continue;
        double t;
        if (!compare(&tally, &f, ref, origin, d, 0, &t)) continue;
        /* Onward from the surface, in any direction but those that graze. */
        GiSurfacePoint p = gi_shape_point(&f.shapes, ref, GI_SHAPE_NONE, origin, d, t, true);
        GiVec onward = direction_of(&random);
        if (fabs(gi_dot(onward, p.normal)) < 0.05 * gi_length(onward)) continue;
        compare(&tally, &f, ref, p.point, onward, p.error / gi_length(onward), &t);
    }
    CHECK(tally.hits > rays / 3 && tally.misses > rays / 10);
    if (tally.wrong > 0) test_fail(__FILE__, __LINE__, "%d are wrong", tally.wrong);
}

static const GiVec zero = {0, 0, 0};

static void random_rays(void) { compare_many(zero, 1, false, 240000); }
static void random_rays_interior_rule(void) { compare_many(zero, 1, true, 120000); }
static void random_rays_tiny(void) { compare_many(zero, 1e-20, false, 20000); }
static void random_rays_huge(void) { compare_many(zero, 1e20, false, 20000); }
static void random_rays_far(void) {
    compare_many(gi_vec(1e6, -2e6, 3e6), 1, false, 60000);
    compare_many(gi_vec(1e6, -2e6, 3e6), 1e3, true, 60000);
}

const GiTest tests_hit[] = {TEST(random_rays), TEST(random_rays_interior_rule),
    TEST(random_rays_tiny), TEST(random_rays_huge), TEST(random_rays_far), TEST_END};
