/* SPDX-License-Identifier: MIT
 * Every shape against another way to say what it is: a function that is negative inside. Where the
 * reference finds a ray's line inside of the solid, computed in long double, the hit must be. */
#include "test.h"

#include "random.h"
#include "shape/hit.h"

#include <stdio.h>

typedef long double Real;
typedef struct RealVec {
    Real x, y, z;
} RealVec;

/* ---------------------------------------------------------------- shapes to test with */

enum { SHAPES = 60, TRANSFORMS = 12, PLACEMENTS = 4 * SHAPES };

/* Arrays as a committed scene has them. */
typedef struct Fixture {
    GiSphere spheres[SHAPES];
    GiBox boxes[SHAPES];
    GiCone cones[2 * SHAPES]; /* the first half cylinders */
    GiDisc discs[SHAPES];
    GiPlane planes[SHAPES];
    GiPlacement placements[PLACEMENTS];
    GiTransform transforms[TRANSFORMS];
    GiShapes shapes;
    GiVec at;
    double size;
} Fixture;

static double size_of(Random *random, double size) {
    return size * exp2(random_real(random, -4, 2));
}

static GiVec direction_of(Random *random) {
    GiVec v;
    do {
        v = random_vec(random, -1, 1);
    } while (gi_dot(v, v) < 0.01 || gi_dot(v, v) > 1);
    return v;
}

static void fill_shapes(Fixture *f, Random *random) {
    for (int i = 0; i < SHAPES; i++) {
        GiVec center = gi_add(f->at, random_vec(random, -f->size, f->size));
        f->spheres[i] = (GiSphere){center, size_of(random, f->size)};
        GiVec half =
            gi_vec(size_of(random, f->size), size_of(random, f->size), size_of(random, f->size));
        f->boxes[i] = (GiBox){gi_sub(center, half), gi_add(center, half)};
        f->cones[i] = (GiCone){center, half.x, 0, half.y};
        /* Apexes below, inside and above; also near and far. */
        double tip = half.y * exp2(random_real(random, -2, 4)) * (i % 2 ? 1 : -1);
        f->cones[SHAPES + i] = (GiCone){center, half.x, -half.x / tip, half.y};
        f->discs[i] = (GiDisc){center, gi_normalize(direction_of(random)), half.x};
        f->planes[i] = (GiPlane){center, gi_normalize(direction_of(random))};
    }
    f->discs[0].normal = gi_vec(0, 0, -1);
    f->planes[0].normal = gi_vec(0, 1, 0);
}

static void fill_transforms(Fixture *f, Random *random) {
    for (int i = 0; i < TRANSFORMS; i++) {
        GiVec scale = gi_vec(exp2(random_real(random, -2, 2)), exp2(random_real(random, -2, 2)),
            exp2(random_real(random, -2, 2)));
        if (i % 3 == 1) scale.x = -scale.x;
        if (i % 4 == 1) scale = gi_vec(-scale.x, -scale.y, -scale.z);
        GiAffine a = gi_affine_scale(scale),
                 b = gi_affine_rotate_degrees(random_vec(random, -180, 180));
        GiAffine c = gi_affine_translate(random_vec(random, -3 * f->size, 3 * f->size));
        GiAffine d = gi_affine_rotate_degrees(random_vec(random, -180, 180));
        /* A turn between two unequal scales shears. */
        a = gi_affine_multiply(&b, &a);
        if (i % 2) a = gi_affine_multiply(&a, &d);
        a = gi_affine_multiply(&c, &a);
        f->transforms[i].to_world = a;
        CHECK(gi_affine_invert(&a, &f->transforms[i].to_object));
    }
    for (uint32_t i = 0; i < PLACEMENTS; i++) {
        GiShapeKind kind = (GiShapeKind)(i % 5);
        f->placements[i] = (GiPlacement){gi_shape_ref(kind, i / 5 % SHAPES), i % TRANSFORMS};
        if (kind == GI_SHAPE_CONE && i % 2) f->placements[i].shape.bits += SHAPES;
    }
}

static void fixture_init(Fixture *f, uint64_t seed, GiVec at, double size, bool entering_only) {
    Random random = {seed};
    f->at = at;
    f->size = size;
    fill_shapes(f, &random);
    fill_transforms(f, &random);
    f->shapes = (GiShapes){.spheres = f->spheres,
        .boxes = f->boxes,
        .cones = f->cones,
        .discs = f->discs,
        .planes = f->planes,
        .placements = f->placements,
        .transforms = f->transforms,
        .entering_only = entering_only};
}

/* One of the shapes, the same for the same number. */
static GiShapeRef shape_at(int i) {
    static const GiShapeKind kinds[] = {GI_SHAPE_SPHERE, GI_SHAPE_BOX, GI_SHAPE_CONE, GI_SHAPE_CONE,
        GI_SHAPE_DISC, GI_SHAPE_PLANE, GI_SHAPE_PLACED, GI_SHAPE_PLACED};
    uint32_t k = (uint32_t)i % 8, index = (uint32_t)i / 8 % SHAPES;
    if (k == 3) index += SHAPES;
    if (k >= 6) index = (uint32_t)i / 8 * 2 % PLACEMENTS + (k - 6);
    return gi_shape_ref(kinds[k], index);
}

static bool is_solid(GiShapeKind kind) { return kind < GI_SHAPE_DISC; }

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

typedef struct Tally {
    int hits, misses, wrong;
} Tally;

static gi_hit_Ray hit_ray(GiVec o, GiVec d) { return gi_hit_ray(o.x, o.y, o.z, d.x, d.y, d.z); }

static void complain(Tally *tally, const Fixture *f, GiShapeRef ref, GiVec o, GiVec d,
    const char *what, double a, double b) {
    if (tally->wrong++ >= 4) return;
    test_fail(__FILE__, __LINE__, "%s: %.17g, %.17g; shape %x%s, ray (%a %a %a) + t (%a %a %a)",
        what, a, b, ref.bits, f->shapes.entering_only ? " entering only" : "", o.x, o.y, o.z, d.x,
        d.y, d.z);
}

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
    GiSurfacePoint at = gi_shape_point(&f->shapes, ref, o, d, t, true);
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
    GiBox box = gi_shape_bounds(&f->shapes, ref);
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
    GiBox box = gi_shape_bounds(&f->shapes, ref);
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
        GiSurfacePoint p = gi_shape_point(&f.shapes, ref, origin, d, t, true);
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
            GiBox bounds = gi_shape_bounds(&f.shapes, refs[k]);
            GiBox expected = box_of_circles(&f, refs[k]);
            double size = gi_length(gi_sub(bounds.high, bounds.low));
            check_box(&bounds, &expected, 1e-13, 2e-6 * size);
        }
        GiBox bounds = gi_shape_bounds(&f.shapes, gi_shape_ref(GI_SHAPE_BOX, i));
        check_box(&bounds, &f.boxes[i], 0, 0);
        bounds = gi_shape_bounds(&f.shapes, gi_shape_ref(GI_SHAPE_PLANE, i));
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
        GiBox bounds = gi_shape_bounds(&f.shapes, gi_shape_ref(GI_SHAPE_PLACED, i));
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
        GiSurfacePoint p = gi_shape_point(&f.shapes, ref, o, d, t, true);
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
                GiSurfacePoint p = gi_shape_point(&f.shapes, ref, inside, d, t, true);
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
    return gi_shape_point(shapes, gi_shape_ref(kind, 0), o, d, t, geometric).normal;
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

const GiTest tests_shape[] = {TEST(random_rays), TEST(random_rays_interior_rule),
    TEST(random_rays_tiny), TEST(random_rays_huge), TEST(random_rays_far), TEST(bounds_are_tight),
    TEST(solids_are_sealed), TEST(solids_are_sealed_far_away), TEST(edges_are_closed),
    TEST(tangents), TEST(shared_faces), TEST(double_cones), TEST(interior_rule), TEST(flat_shapes),
    TEST_END};
