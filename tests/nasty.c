/* SPDX-License-Identifier: MIT */
#include "nasty.h"

Thing nasty_thing(const Fixture *fixture, Random *random) {
    return fixture->things.data[random_below(random, (int)fixture->things.count)];
}

/* ---------------------------------------------------------------- places */

/* An end, the middle, or anywhere between. */
static double place_between(Random *random, double low, double high) {
    switch (random_below(random, 4)) {
    case 0: return low;
    case 1: return high;
    case 2: return (low + high) / 2;
    default: return random_real(random, low, high);
    }
}

/* Of the unit circle; a quarter of the time exactly on an axis. */
static void place_on_circle(Random *random, double *x, double *y) {
    static const double quarters[][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    int k = random_below(random, 8);
    double angle = random_real(random, 0, 6.283185307179586);
    *x = k < 4 ? quarters[k][0] : cos(angle);
    *y = k < 4 ? quarters[k][1] : sin(angle);
}

static GiVec place_on_sphere(const GiSphere *sphere, Random *random) {
    static const GiVec poles[] = {
        {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0, 0, 0}};
    int k = random_below(random, 14);
    GiVec n = k < 7 ? poles[k] : gi_normalize(random_vec(random, -1, 1));
    return gi_along(sphere->center, n, sphere->radius);
}

static GiVec place_on_cone(const GiCone *cone, Random *random) {
    double z = place_between(random, -cone->half_height, cone->half_height), x, y;
    double apex = gi_cone_apex(cone);
    if (fabs(apex) <= cone->half_height && random_below(random, 4) == 0) z = apex;
    double radius = fabs(cone->radius + cone->slope * z);
    if (random_below(random, 4) == 0) radius *= random_real(random, 0, 1);
    place_on_circle(random, &x, &y);
    return gi_add(cone->center, gi_vec(radius * x, radius * y, z));
}

/* Also of a plane, of which `radius` is looked at. */
static GiVec place_on_disc(GiVec center, GiVec normal, double radius, Random *random) {
    GiVec across = gi_cross(normal, fabs(normal.x) < 0.6 ? gi_vec(1, 0, 0) : gi_vec(0, 1, 0));
    GiVec up = gi_cross(normal, across = gi_normalize(across));
    double x, y;
    place_on_circle(random, &x, &y);
    radius = place_between(random, 0, radius);
    return gi_along(gi_along(center, across, radius * x), up, radius * y);
}

/* Edges are common to two triangles: what lies on one is interpolated in single precision, as the
 * corners are, or in double. */
static GiVec place_on_triangle(const GiTriangles *triangles, uint32_t index, Random *random) {
    const float *corners[3];
    GiVec p[3];
    gi_triangle_corners(triangles, index, corners);
    int first = random_below(random, 3);
    for (int i = 0; i < 3; i++) {
        const float *corner = corners[(first + i) % 3];
        p[i] = gi_vec(corner[0], corner[1], corner[2]);
    }
    double u = random_real(random, 0, 1), v = random_real(random, 0, 1 - u);
    switch (random_below(random, 5)) {
    case 0: return p[0];
    case 1: return gi_scale(gi_add(p[0], p[1]), 0.5);
    case 2: return gi_along(p[0], gi_sub(p[1], p[0]), u);
    case 3: {
        GiVec q = gi_along(p[0], gi_sub(p[1], p[0]), u);
        return gi_vec((float)q.x, (float)q.y, (float)q.z);
    }
    default: return gi_along(gi_along(p[0], gi_sub(p[1], p[0]), u), gi_sub(p[2], p[0]), v);
    }
}

static GiVec place_on(const Fixture *fixture, GiShapeRef ref, Random *random) {
    const GiShapes *shapes = &fixture->world.shapes;
    uint32_t i = gi_shape_index(ref);
    switch (gi_shape_kind(ref)) {
    case GI_SHAPE_SPHERE: return place_on_sphere(&shapes->spheres[i], random);
    case GI_SHAPE_BOX: {
        const GiBox *box = &shapes->boxes[i];
        double x = place_between(random, box->low.x, box->high.x);
        double y = place_between(random, box->low.y, box->high.y);
        return gi_vec(x, y, place_between(random, box->low.z, box->high.z));
    }
    case GI_SHAPE_CONE: return place_on_cone(&shapes->cones[i], random);
    case GI_SHAPE_DISC: {
        const GiDisc *disc = &shapes->discs[i];
        return place_on_disc(disc->center, disc->normal, disc->radius, random);
    }
    case GI_SHAPE_RECTANGLE: {
        const GiRectangle *rectangle = &shapes->rectangles[i];
        double s = place_between(random, -1, 1), r = place_between(random, -1, 1);
        return gi_along(gi_along(rectangle->center, rectangle->across, s), rectangle->up, r);
    }
    case GI_SHAPE_TRIANGLE: return place_on_triangle(&shapes->triangles, i, random);
    default: {
        const GiPlane *plane = &shapes->planes[i];
        return place_on_disc(plane->point, plane->normal, 1, random);
    }
    }
}

GiVec nasty_point(const Fixture *fixture, Thing thing, Random *random) {
    const GiShapes *shapes = &fixture->world.shapes;
    GiVec point = place_on(fixture, gi_shape_unplaced(shapes, thing.ref), random);
    if (gi_shape_kind(thing.ref) == GI_SHAPE_PLACED) {
        uint32_t transform = shapes->placements[gi_shape_index(thing.ref)].transform;
        point = gi_affine_point(&shapes->transforms[transform].to_world, point);
    }
    if (thing.instance != GI_SHAPE_NONE) {
        uint32_t transform = shapes->instances[thing.instance].transform;
        point = gi_affine_point(&shapes->transforms[transform].to_world, point);
    }
    return point;
}

/* ---------------------------------------------------------------- rays */

GiVec nasty_direction(Random *random) {
    GiVec d = random_vec(random, -1, 1);
    double zero = random_below(random, 2) ? 0.0 : -0.0, sign = random_below(random, 2) ? 1 : -1;
    switch (random_below(random, 10)) {
    case 0: return gi_vec(zero, -zero, sign);
    case 1: return gi_vec(zero, sign, zero);
    case 2: return gi_vec(sign, zero, -zero);
    case 3: return gi_vec(d.x, zero, d.z);
    case 4: return gi_vec(zero, d.y, d.z);
    case 5: return gi_vec(d.x, d.y, zero);
    case 6: return gi_vec(1e-20 * d.x, sign, 1e-9 * d.z);
    case 7: return gi_vec(sign, sign, zero); /* diagonals of squares and cubes */
    case 8: return gi_vec(sign, -sign, 1);
    default: return d;
    }
}

GiTraceRay nasty_ray(const Fixture *fixture, GiVec at, double size, Random *random) {
    GiTraceRay ray = {.t_max = INFINITY, .skip = GI_SHAPE_NONE, .skip_instance = GI_SHAPE_NONE};
    GiVec any = gi_add(at, random_vec(random, -2 * size, 2 * size));
    GiVec p = any, q = at, d = nasty_direction(random);
    if (fixture->things.count > 0) {
        Thing thing = nasty_thing(fixture, random), other = thing;
        if (random_below(random, 2)) other = nasty_thing(fixture, random);
        p = nasty_point(fixture, thing, random);
        q = nasty_point(fixture, other, random);
    }
    switch (random_below(random, 12)) {
    case 0: /* from the very surface */
        ray.origin = p;
        ray.direction = d;
        break;
    case 1: /* along an edge, in a face, through the inside, or from one shape to another */
        ray.origin = p;
        ray.direction = gi_sub(q, p);
        break;
    case 2: /* the same from outside, from a distance that rounds nothing, and one that does */
        ray.direction = gi_sub(q, p);
        ray.origin = gi_along(p, ray.direction, random_below(random, 2) ? -2 : -1.7);
        break;
    case 3: /* a segment that ends there */
        ray.origin = random_below(random, 2) ? p : any;
        ray.direction = gi_sub(q, ray.origin);
        ray.t_max = 1;
        ray.t_min = 1e-9;
        break;
    case 4:
    case 5: /* through the place in a direction with zeros */
        ray.origin = gi_along(p, d, -size * random_real(random, 0.5, 3));
        ray.direction = d;
        break;
    case 6: /* tangent: at right angles to the line from the middle of the shape, or about so */
        ray.direction = gi_cross(gi_sub(p, q), random_below(random, 2) ? gi_vec(0, 0, 1) : d);
        ray.origin = gi_along(p, ray.direction, -random_below(random, 3));
        break;
    case 7: /* from far away */
        ray.direction = gi_normalize(random_vec(random, -1, 1));
        ray.origin = gi_along(p, ray.direction, -size * pow(10, random_real(random, 1, 4)));
        if (random_below(random, 2)) ray.direction = gi_sub(p, ray.origin);
        break;
    case 8: /* from the inside of most solids */
        ray.origin = gi_scale(gi_add(p, q), 0.5);
        ray.direction = random_below(random, 2) ? gi_sub(p, ray.origin) : d;
        break;
    case 9: /* from a grid */
        ray.origin = gi_vec(floor(any.x), floor(any.y), floor(any.z));
        ray.direction = d;
        break;
    default: ray.origin = any; ray.direction = gi_sub(p, any);
    }
    /* Lengths far from one: t is as far, and the interval with it. */
    if (random_below(random, 6) == 0) {
        static const double lengths[] = {1e-60, 1e-20, 1e-6, 1e6, 1e20, 1e60};
        double length = lengths[random_below(random, 6)];
        ray.direction = gi_scale(ray.direction, length);
        ray.t_min /= length;
        ray.t_max /= length;
    }
    /* Two places may be one, and what a step of 1e-60 leaves of a short edge has no square. */
    double square = gi_dot(ray.direction, ray.direction);
    if (!(square > 1e-250 && square < 1e250)) ray.direction = gi_vec(0, -0.0, 1);
    return ray;
}

void nasty_limits(const Fixture *fixture, bool skips, Random *random, GiTraceRay *ray) {
    GiTraceHit hit;
    if (!brute_force(fixture, ray, &hit)) return;
    switch (random_below(random, skips ? 7 : 6)) {
    case 0: ray->t_max = hit.t; break; /* the interval is open */
    case 1: ray->t_max = nextafter(hit.t, INFINITY); break;
    case 2: ray->t_max = nextafter(hit.t, -INFINITY); break;
    case 3: ray->t_min = hit.t; break;
    case 4: ray->t_min = nextafter(hit.t, -INFINITY); break;
    case 5: ray->t_min = nextafter(hit.t, INFINITY); break;
    default: ray->skip = hit.shape.bits, ray->skip_instance = hit.instance;
    }
}
