/* SPDX-License-Identifier: MIT
 * Where a ray meets each shape. The formulas are written once over R, a number or a vector of
 * numbers, and this file is included once for each: by hit.h with plain doubles, by the kernels
 * with one ray in each lane. The operations and their order are the same, so are the bits.
 *
 * The includer defines
 *     R                 the type of numbers, with + - * / and unary -
 *     M                 the type of truth values, with & and |
 *     GI_HIT(name)      the names to give
 *     R_OF(x)           a double in every lane
 *     R_SQRT            of a number
 *     R_MIN R_MAX       a < b ? a : b and a > b ? a : b, the second when one is not a number
 *     R_LESS R_LESS_EQUAL R_EQUAL    comparisons, false when one is not a number
 *     R_SELECT(m,a,b)   m ? a : b
 *     M_OF(x) M_NOT(m)  a bool in every lane; negation
 *
 * Every function returns whether the open interval (t_min, t_max) holds a meeting and leaves the
 * smallest one in *t; *t is undefined otherwise. The direction may have any length but zero, t
 * counts in that length. All solids are the intersection of what they are bounded by: the part of
 * the ray's line inside is one interval, so no ray slips through an edge between two faces. */

/* A ray with what the tests want to have ready. */
typedef struct GI_HIT(Ray) {
    R ox, oy, oz, dx, dy, dz;
    R ix, iy, iz;     /* 1 / d; of a component that is zero, a huge number of the sign of plus */
    R inverse_square; /* 1 / d.d */
} GI_HIT(Ray);

static inline R GI_HIT(inverse)(R d) {
    /* A ray parallel to a slab gets a step so large that it is inside from minus to plus
     * "infinity" or nowhere; one that runs in the plane of a face is inside of exactly one of the
     * two slabs that share the face. */
    return R_SELECT(R_EQUAL(d, R_OF(0)), R_OF(1e300), R_OF(1) / d);
}

static inline GI_HIT(Ray) GI_HIT(ray)(R ox, R oy, R oz, R dx, R dy, R dz) {
    return (GI_HIT(Ray)){ox, oy, oz, dx, dy, dz, GI_HIT(inverse)(dx), GI_HIT(inverse)(dy),
        GI_HIT(inverse)(dz), R_OF(1) / (dx * dx + dy * dy + dz * dz)};
}

/* The same ray in the space of a placed shape. */
static inline GI_HIT(Ray) GI_HIT(to_object)(const GI_HIT(Ray) * ray, const GiAffine *a) {
#define ROW(i, x, y, z) (R_OF(a->m[i][0]) * x + R_OF(a->m[i][1]) * y + R_OF(a->m[i][2]) * z)
    return GI_HIT(ray)(ROW(0, ray->ox, ray->oy, ray->oz) + R_OF(a->m[0][3]),
        ROW(1, ray->ox, ray->oy, ray->oz) + R_OF(a->m[1][3]),
        ROW(2, ray->ox, ray->oy, ray->oz) + R_OF(a->m[2][3]), ROW(0, ray->dx, ray->dy, ray->dz),
        ROW(1, ray->dx, ray->dy, ray->dz), ROW(2, ray->dx, ray->dy, ray->dz));
#undef ROW
}

/* Of the interval [enter, leave] inside a convex solid, the end that the ray meets: where it comes
 * in, or where it goes out when it starts inside and `exits` allows. */
static inline M GI_HIT(pick)(R enter, R leave, M exits, R t_min, R t_max, R *t) {
    M from_outside = R_LESS(t_min, enter);
    *t = R_SELECT(from_outside, enter, leave);
    return R_LESS_EQUAL(enter, leave) & (from_outside | exits) & R_LESS(t_min, *t) &
           R_LESS(*t, t_max);
}

/* By the point of closest approach, at t = nearest: b^2 - 4ac would lose a small sphere far away to
 * rounding. What is left of the square of the radius there; negative: the line passes by. */
static inline R GI_HIT(sphere_rest)(const GiSphere *s, const GI_HIT(Ray) * ray, R *nearest) {
    R x = R_OF(s->center.x) - ray->ox, y = R_OF(s->center.y) - ray->oy,
      z = R_OF(s->center.z) - ray->oz;
    *nearest = (x * ray->dx + y * ray->dy + z * ray->dz) * ray->inverse_square;
    x = x - *nearest * ray->dx;
    y = y - *nearest * ray->dy;
    z = z - *nearest * ray->dz;
    R radius = R_OF(s->radius);
    return radius * radius - (x * x + y * y + z * z);
}

static inline M GI_HIT(sphere)(const GiSphere *s, const GI_HIT(Ray) * ray, R t_min, R t_max, R *t) {
    R nearest, rest = GI_HIT(sphere_rest)(s, ray, &nearest);
    R half = R_SQRT(R_MAX(rest, R_OF(0)) * ray->inverse_square);
    M any = R_LESS_EQUAL(R_OF(0), rest);
    return any & GI_HIT(pick)(nearest - half, nearest + half, any, t_min, t_max, t);
}

static inline void GI_HIT(slab)(R low, R high, R o, R inverse, R *enter, R *leave) {
    R a = (low - o) * inverse, b = (high - o) * inverse;
    *enter = R_MIN(a, b);
    *leave = R_MAX(a, b);
}

static inline M GI_HIT(box)(
    const GiBox *box, const GI_HIT(Ray) * ray, bool entering_only, R t_min, R t_max, R *t) {
    R x0, x1, y0, y1, z0, z1;
    GI_HIT(slab)(R_OF(box->low.x), R_OF(box->high.x), ray->ox, ray->ix, &x0, &x1);
    GI_HIT(slab)(R_OF(box->low.y), R_OF(box->high.y), ray->oy, ray->iy, &y0, &y1);
    GI_HIT(slab)(R_OF(box->low.z), R_OF(box->high.z), ray->oz, ray->iz, &z0, &z1);
    R enter = R_MAX(x0, R_MAX(y0, z0)), leave = R_MIN(x1, R_MIN(y1, z1));
    return GI_HIT(pick)(enter, leave, M_OF(!entering_only), t_min, t_max, t);
}

/* The ray against the infinite double cone: the ray's origin is first moved to its point of closest
 * approach to the centre, which keeps the numbers as small as the shape is. */
typedef struct GI_HIT(Wall) {
    R shift;     /* t of the moved origin */
    R oz;        /* its height above the centre plane */
    R near, far; /* roots, ascending, counted from the moved origin */
    M outside;   /* the line is inside where t <= near or far <= t, not between the two */
    M none;      /* nothing of the line is inside */
} GI_HIT(Wall);

/* What of a cone matters to that. */
typedef struct GI_HIT(ConeLanes) {
    R x, y, z, radius, slope;
} GI_HIT(ConeLanes);

static inline GI_HIT(Wall)
    GI_HIT(wall_of)(const GI_HIT(ConeLanes) * cone, const GI_HIT(Ray) * ray) {
    GI_HIT(Wall) wall;
    R x = ray->ox - cone->x, y = ray->oy - cone->y, z = ray->oz - cone->z;
    wall.shift = -(x * ray->dx + y * ray->dy + z * ray->dz) * ray->inverse_square;
    x = x + wall.shift * ray->dx;
    y = y + wall.shift * ray->dy;
    z = z + wall.shift * ray->dz;
    wall.oz = z;
    /* q(t) = (x + t dx)^2 + (y + t dy)^2 - (rho + t drho)^2 = a t^2 + 2 b t + c, negative inside */
    R rho = cone->radius + cone->slope * z, drho = cone->slope * ray->dz;
    R a = ray->dx * ray->dx + ray->dy * ray->dy - drho * drho;
    R b = x * ray->dx + y * ray->dy - rho * drho;
    R c = x * x + y * y - rho * rho;
    R discriminant = b * b - a * c;
    wall.outside = R_LESS(a, R_OF(0));
    wall.none = R_LESS(discriminant, R_OF(0)) & R_LESS_EQUAL(R_OF(0), a);
    R root = R_SQRT(R_MAX(discriminant, R_OF(0)));
    R sum = -(b + R_SELECT(R_LESS(b, R_OF(0)), -root, root));
    /* a = 0 makes one root infinite, as it should be (a + 0 is never minus zero). a = b = 0 is a
     * ray along a cylinder's axis or a cone's side: inside all the way or not at all. */
    R t0 = sum / (a + R_OF(0)), t1 = c / sum;
    M along = R_EQUAL(sum, R_OF(0));
    M along_inside = R_LESS_EQUAL(c, R_OF(0)) & R_EQUAL(a, R_OF(0));
    t0 = R_SELECT(along, R_SELECT(along_inside, R_OF(-1e300), R_OF(0)), t0);
    t1 = R_SELECT(along, R_SELECT(along_inside, R_OF(1e300), R_OF(0)), t1);
    wall.none = wall.none | (along & R_EQUAL(a, R_OF(0)) & R_LESS(R_OF(0), c));
    wall.near = R_MIN(t0, t1);
    wall.far = R_MAX(t0, t1);
    return wall;
}

static inline GI_HIT(Wall) GI_HIT(wall)(const GiCone *cone, const GI_HIT(Ray) * ray) {
    const GI_HIT(ConeLanes) lanes = {R_OF(cone->center.x), R_OF(cone->center.y),
        R_OF(cone->center.z), R_OF(cone->radius), R_OF(cone->slope)};
    return GI_HIT(wall_of)(&lanes, ray);
}

/* The part of one nappe between the heights low and high. */
static inline M GI_HIT(frustum)(const GI_HIT(Wall) * wall, const GI_HIT(Ray) * ray, double low,
    double high, bool cap_exits, R t_min, R t_max, R *t) {
    R slab_enter, slab_leave;
    GI_HIT(slab)(R_OF(low), R_OF(high), wall->oz, ray->iz, &slab_enter, &slab_leave);
    /* Steeper than the cone, a line is inside before `near` in one nappe and after `far` in the
     * other; the slab lies in one nappe and tells which. */
    M first = wall->outside & R_LESS_EQUAL(slab_enter, wall->near);
    M second = wall->outside & R_LESS(wall->near, slab_enter);
    R wall_enter = R_SELECT(first, R_OF(-1e300), R_SELECT(second, wall->far, wall->near));
    R wall_leave = R_SELECT(first, wall->near, R_SELECT(second, R_OF(1e300), wall->far));
    R enter = R_MAX(slab_enter, wall_enter), leave = R_MIN(slab_leave, wall_leave);
    M exits = M_OF(cap_exits) | R_LESS(wall_leave, slab_leave);
    return M_NOT(wall->none) &
           GI_HIT(pick)(enter + wall->shift, leave + wall->shift, exits, t_min, t_max, t);
}

static inline M GI_HIT(cone)(
    const GiCone *cone, const GI_HIT(Ray) * ray, bool entering_only, R t_min, R t_max, R *t) {
    GI_HIT(Wall) wall = GI_HIT(wall)(cone, ray);
    bool cap_exits = !(entering_only && cone->slope == 0);
    double half = cone->half_height, apex = gi_cone_apex(cone);
    if (!(fabs(apex) < half)) {
        return GI_HIT(frustum)(&wall, ray, -half, half, cap_exits, t_min, t_max, t);
    }
    R other;
    M below = GI_HIT(frustum)(&wall, ray, -half, apex, cap_exits, t_min, t_max, t);
    M above = GI_HIT(frustum)(&wall, ray, apex, half, cap_exits, t_min, t_max, &other);
    M nearer = above & (M_NOT(below) | R_LESS(other, *t));
    *t = R_SELECT(nearer, other, *t);
    return below | above;
}

static inline M GI_HIT(flat)(
    const GiVec *point, const GiVec *normal, const GI_HIT(Ray) * ray, R t_min, R t_max, R *t) {
    R nx = R_OF(normal->x), ny = R_OF(normal->y), nz = R_OF(normal->z);
    R height = (R_OF(point->x) - ray->ox) * nx + (R_OF(point->y) - ray->oy) * ny +
               (R_OF(point->z) - ray->oz) * nz;
    /* A ray within the plane divides by zero; what comes out is no number between the limits. */
    *t = height / (ray->dx * nx + ray->dy * ny + ray->dz * nz);
    return R_LESS(t_min, *t) & R_LESS(*t, t_max);
}

static inline M GI_HIT(disc)(const GiDisc *disc, const GI_HIT(Ray) * ray, R t_min, R t_max, R *t) {
    M hit = GI_HIT(flat)(&disc->center, &disc->normal, ray, t_min, t_max, t);
    R x = ray->ox - R_OF(disc->center.x) + *t * ray->dx,
      y = ray->oy - R_OF(disc->center.y) + *t * ray->dy,
      z = ray->oz - R_OF(disc->center.z) + *t * ray->dz;
    R radius = R_OF(disc->radius);
    return hit & R_LESS_EQUAL(x * x + y * y + z * z, radius * radius);
}

static inline M GI_HIT(rectangle)(
    const GiRectangle *rectangle, const GI_HIT(Ray) * ray, R t_min, R t_max, R *t) {
    const GiVec *center = &rectangle->center, *across = &rectangle->across, *up = &rectangle->up;
    M hit = GI_HIT(flat)(center, &rectangle->normal, ray, t_min, t_max, t);
    R x = ray->ox - R_OF(center->x) + *t * ray->dx, y = ray->oy - R_OF(center->y) + *t * ray->dy,
      z = ray->oz - R_OF(center->z) + *t * ray->dz;
    R s = x * R_OF(across->x) + y * R_OF(across->y) + z * R_OF(across->z);
    R r = x * R_OF(up->x) + y * R_OF(up->y) + z * R_OF(up->z);
    R s_limit = R_OF(gi_dot(*across, *across)), r_limit = R_OF(gi_dot(*up, *up));
    return hit & R_LESS_EQUAL(-s_limit, s) & R_LESS_EQUAL(s, s_limit) & R_LESS_EQUAL(-r_limit, r) &
           R_LESS_EQUAL(r, r_limit);
}

/* A corner of a triangle as the ray sees it: its place in a plane across the ray, which pierces
 * that plane in the point zero, and its depth. */
typedef struct GI_HIT(Corner) {
    R x, y, depth;
} GI_HIT(Corner);

/* Two components of the cross product of direction and corner: those that the direction's largest
 * component is a factor of (x_major, y_major, or neither). */
static inline GI_HIT(Corner)
    GI_HIT(corner)(const R p[3], const GI_HIT(Ray) * ray, M x_major, M y_major) {
    R x = p[0] - ray->ox, y = p[1] - ray->oy, z = p[2] - ray->oz;
    R cx = ray->dy * z - ray->dz * y, cy = ray->dz * x - ray->dx * z,
      cz = ray->dx * y - ray->dy * x;
    return (GI_HIT(Corner)){R_SELECT(x_major, cy, R_SELECT(y_major, cz, cx)),
        R_SELECT(x_major, cz, R_SELECT(y_major, cx, cy)), x * ray->dx + y * ray->dy + z * ray->dz};
}

/* How much of each corner there is in the point where the ray meets the triangle's plane: twice the
 * areas of the three triangles that this point and the edges make, up to a common factor. */
typedef struct GI_HIT(Weights) {
    R u, v, w;
    R depth;  /* the weighted sum of the corners' depths */
    M around; /* the ray is within the rectangle of the corners' places */
} GI_HIT(Weights);

/* Why no ray slips between triangles that share an edge or a corner: in the plane across the ray a
 * corner has the same place in every triangle it is of, since its place depends on nothing else
 * (Woop, Benthin, Wald 2013). Rounding moves corners but opens no gap between triangles. And the
 * sign of a weight is never wrong: of two products that differ, the larger is not rounded to less
 * than the smaller. When it is rounded to as much, the weight is zero, and zero counts as inside
 * for both triangles at the edge.
 *
 * The depth is a mean of the corners' depths, so a meeting never lies outside of the triangle's own
 * range of depths, however small the angle. And of a triangle seen edge-on, whose weights are
 * nothing but rounding for rays in its plane, only those rays meet it that pass between its
 * corners: a point inside of a triangle is inside of the rectangle round its corners too, and
 * comparisons do not round. */
static inline GI_HIT(Weights) GI_HIT(weights_at)(R corners[3][3], const GI_HIT(Ray) * ray) {
    R dx = R_MAX(ray->dx, -ray->dx), dy = R_MAX(ray->dy, -ray->dy), dz = R_MAX(ray->dz, -ray->dz);
    M x_major = R_LESS_EQUAL(dy, dx) & R_LESS_EQUAL(dz, dx), y_major = R_LESS_EQUAL(dz, dy);
    GI_HIT(Corner) a = GI_HIT(corner)(corners[0], ray, x_major, y_major);
    GI_HIT(Corner) b = GI_HIT(corner)(corners[1], ray, x_major, y_major);
    GI_HIT(Corner) c = GI_HIT(corner)(corners[2], ray, x_major, y_major);
    R u = b.x * c.y - b.y * c.x, v = c.x * a.y - c.y * a.x, w = a.x * b.y - a.y * b.x,
      zero = R_OF(0);
    R x0 = R_MIN(a.x, R_MIN(b.x, c.x)), x1 = R_MAX(a.x, R_MAX(b.x, c.x));
    R y0 = R_MIN(a.y, R_MIN(b.y, c.y)), y1 = R_MAX(a.y, R_MAX(b.y, c.y));
    M around = R_LESS_EQUAL(x0, zero) & R_LESS_EQUAL(zero, x1) & R_LESS_EQUAL(y0, zero) &
               R_LESS_EQUAL(zero, y1);
    return (GI_HIT(Weights)){u, v, w, u * a.depth + v * b.depth + w * c.depth, around};
}

static inline void GI_HIT(corners)(
    const GiTriangles *triangles, uint32_t triangle, R corners[3][3]) {
    const float *points[3];
    gi_triangle_corners(triangles, triangle, points);
    for (int i = 0; i < 3; i++) {
        for (int axis = 0; axis < 3; axis++) corners[i][axis] = R_OF((double)points[i][axis]);
    }
}

static inline GI_HIT(Weights)
    GI_HIT(weights)(const GiTriangles *triangles, uint32_t triangle, const GI_HIT(Ray) * ray) {
    R corners[3][3];
    GI_HIT(corners)(triangles, triangle, corners);
    return GI_HIT(weights_at)(corners, ray);
}

static inline M GI_HIT(triangle_at)(
    R corners[3][3], const GI_HIT(Ray) * ray, R t_min, R t_max, R *t) {
    GI_HIT(Weights) at = GI_HIT(weights_at)(corners, ray);
    R zero = R_OF(0);
    R least = R_MIN(at.u, R_MIN(at.v, at.w)), most = R_MAX(at.u, R_MAX(at.v, at.w));
    /* A triangle seen edge-on has no weights at all, and its t is no number; its neighbours have
     * the edge. */
    *t = at.depth / (at.u + at.v + at.w) * ray->inverse_square;
    return (R_LESS_EQUAL(zero, least) | R_LESS_EQUAL(most, zero)) & at.around & R_LESS(t_min, *t) &
           R_LESS(*t, t_max);
}

static inline M GI_HIT(triangle)(const GiTriangles *triangles, uint32_t triangle,
    const GI_HIT(Ray) * ray, R t_min, R t_max, R *t) {
    R corners[3][3];
    GI_HIT(corners)(triangles, triangle, corners);
    return GI_HIT(triangle_at)(corners, ray, t_min, t_max, t);
}

static inline M GI_HIT(unplaced)(
    const GiShapes *shapes, GiShapeRef ref, const GI_HIT(Ray) * ray, R t_min, R t_max, R *t) {
    uint32_t i = gi_shape_index(ref);
    switch (gi_shape_kind(ref)) {
    case GI_SHAPE_SPHERE: return GI_HIT(sphere)(&shapes->spheres[i], ray, t_min, t_max, t);
    case GI_SHAPE_BOX:
        return GI_HIT(box)(&shapes->boxes[i], ray, shapes->entering_only, t_min, t_max, t);
    case GI_SHAPE_CONE:
        return GI_HIT(cone)(&shapes->cones[i], ray, shapes->entering_only, t_min, t_max, t);
    case GI_SHAPE_DISC: return GI_HIT(disc)(&shapes->discs[i], ray, t_min, t_max, t);
    case GI_SHAPE_RECTANGLE: return GI_HIT(rectangle)(&shapes->rectangles[i], ray, t_min, t_max, t);
    case GI_SHAPE_TRIANGLE: return GI_HIT(triangle)(&shapes->triangles, i, ray, t_min, t_max, t);
    default: {
        const GiPlane *plane = &shapes->planes[i];
        return GI_HIT(flat)(&plane->point, &plane->normal, ray, t_min, t_max, t);
    }
    }
}

/* Any shape but an instance, which is a tree. */
static inline M GI_HIT(shape)(
    const GiShapes *shapes, GiShapeRef ref, const GI_HIT(Ray) * ray, R t_min, R t_max, R *t) {
    if (gi_shape_kind(ref) != GI_SHAPE_PLACED) {
        return GI_HIT(unplaced)(shapes, ref, ray, t_min, t_max, t);
    }
    const GiPlacement *placement = &shapes->placements[gi_shape_index(ref)];
    GI_HIT(Ray) inner = GI_HIT(to_object)(ray, &shapes->transforms[placement->transform].to_object);
    return GI_HIT(unplaced)(shapes, placement->shape, &inner, t_min, t_max, t);
}
