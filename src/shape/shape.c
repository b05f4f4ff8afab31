/* SPDX-License-Identifier: MIT */
#include "shape/shape.h"

#include "shape/hit.h"

/* ---------------------------------------------------------------- bounds */

static GiBox cone_bounds(const GiCone *cone) {
    double half = cone->half_height;
    double reach =
        fmax(fabs(cone->radius + cone->slope * half), fabs(cone->radius - cone->slope * half));
    return (GiBox){
        gi_vec(cone->center.x - reach, cone->center.y - reach, cone->center.z - half),
        gi_vec(cone->center.x + reach, cone->center.y + reach, cone->center.z + half),
    };
}

static GiBox disc_bounds(const GiDisc *disc) {
    GiVec n = disc->normal;
    /* The circle reaches radius * sqrt(1 - n_i^2) along axis i. */
    GiVec reach = gi_scale(gi_vec(sqrt(n.y * n.y + n.z * n.z), sqrt(n.x * n.x + n.z * n.z),
                               sqrt(n.x * n.x + n.y * n.y)),
        disc->radius * (1 + 1e-15));
    return (GiBox){gi_sub(disc->center, reach), gi_add(disc->center, reach)};
}

static GiBox unplaced_bounds(const GiShapes *shapes, GiShapeRef ref) {
    uint32_t i = gi_shape_index(ref);
    switch (gi_shape_kind(ref)) {
    case GI_SHAPE_SPHERE: {
        const GiSphere *s = &shapes->spheres[i];
        GiVec reach = gi_vec(s->radius, s->radius, s->radius);
        return (GiBox){gi_sub(s->center, reach), gi_add(s->center, reach)};
    }
    case GI_SHAPE_BOX: return shapes->boxes[i];
    case GI_SHAPE_CONE: return cone_bounds(&shapes->cones[i]);
    case GI_SHAPE_DISC: return disc_bounds(&shapes->discs[i]);
    default: return (GiBox){{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
    }
}

/* The box round a transformed box: of every row, each term takes its smaller or larger end. */
static GiBox transform_box(const GiAffine *a, const GiBox *box) {
    double low[3], high[3];
    const double from[3] = {box->low.x, box->low.y, box->low.z};
    const double to[3] = {box->high.x, box->high.y, box->high.z};
    for (int row = 0; row < 3; row++) {
        low[row] = high[row] = a->m[row][3];
        for (int i = 0; i < 3; i++) {
            double p = a->m[row][i] * from[i], q = a->m[row][i] * to[i];
            low[row] += fmin(p, q);
            high[row] += fmax(p, q);
        }
    }
    return (GiBox){gi_vec_from(low), gi_vec_from(high)};
}

/* A sphere's image reaches radius * |row| along each axis, which is tighter than its box's. */
static GiBox transform_sphere(const GiAffine *a, const GiSphere *sphere) {
    GiVec center = gi_affine_point(a, sphere->center);
    GiVec reach = gi_vec(gi_length(gi_vec_from(a->m[0])), gi_length(gi_vec_from(a->m[1])),
        gi_length(gi_vec_from(a->m[2])));
    reach = gi_scale(reach, sphere->radius);
    return (GiBox){gi_sub(center, reach), gi_add(center, reach)};
}

GiBox gi_shape_bounds(const GiShapes *shapes, GiShapeRef ref, uint32_t instance) {
    (void)instance;
    if (gi_shape_kind(ref) != GI_SHAPE_PLACED) return unplaced_bounds(shapes, ref);
    const GiPlacement *placement = &shapes->placements[gi_shape_index(ref)];
    const GiAffine *to_world = &shapes->transforms[placement->transform].to_world;
    if (gi_shape_kind(placement->shape) == GI_SHAPE_PLANE) {
        return unplaced_bounds(shapes, placement->shape);
    }
    if (gi_shape_kind(placement->shape) == GI_SHAPE_SPHERE) {
        return transform_sphere(to_world, &shapes->spheres[gi_shape_index(placement->shape)]);
    }
    GiBox box = unplaced_bounds(shapes, placement->shape);
    return transform_box(to_world, &box);
}

/* ---------------------------------------------------------------- point and normal */

/* The normal to shade with is that of the surface. */
static GiSurfacePoint facing(GiVec point, GiVec normal, double error) {
    return (GiSurfacePoint){point, normal, normal, error};
}

/* The face is the one whose plane the ray crosses at t: the same operations as in the test give
 * the same t to the bit. */
static GiSurfacePoint box_point(const GiBox *box, const gi_hit_Ray *ray, GiVec p, double t) {
    double x0, x1, y0, y1, z0, z1;
    gi_hit_slab(box->low.x, box->high.x, ray->ox, ray->ix, &x0, &x1);
    gi_hit_slab(box->low.y, box->high.y, ray->oy, ray->iy, &y0, &y1);
    gi_hit_slab(box->low.z, box->high.z, ray->oz, ray->iz, &z0, &z1);
    /* Entering, the normal is against the direction; leaving, along it. */
    double side = gi_hit_maximum(x0, gi_hit_maximum(y0, z0)) == t ? -1 : 1;
    GiVec toward = gi_vec(side * ray->ix, side * ray->iy, side * ray->iz);
    if (side < 0 ? x0 == t : x1 == t) {
        bool high = toward.x > 0;
        p.x = high ? box->high.x : box->low.x;
        return facing(p, gi_vec(high ? 1 : -1, 0, 0), 0);
    }
    if (side < 0 ? y0 == t : y1 == t) {
        bool high = toward.y > 0;
        p.y = high ? box->high.y : box->low.y;
        return facing(p, gi_vec(0, high ? 1 : -1, 0), 0);
    }
    bool high = toward.z > 0;
    p.z = high ? box->high.z : box->low.z;
    return facing(p, gi_vec(0, 0, high ? 1 : -1), 0);
}

static GiSurfacePoint cone_point(
    const GiCone *cone, const gi_hit_Ray *ray, GiVec p, double t, bool second_nappe_geometric) {
    gi_hit_Wall wall = gi_hit_wall(cone, ray);
    double half = cone->half_height, size = half + cone->radius, enter, leave;
    gi_hit_slab(-half, half, wall.oz, ray->iz, &enter, &leave);
    if (enter + wall.shift == t || leave + wall.shift == t) {
        bool top = (enter + wall.shift == t) == (ray->iz < 0);
        p.z = cone->center.z + (top ? half : -half);
        return facing(p, gi_vec(0, 0, top ? 1 : -1), size);
    }
    double x = p.x - cone->center.x, y = p.y - cone->center.y, z = p.z - cone->center.z;
    double distance = sqrt(x * x + y * y);
    double radius = cone->radius + cone->slope * z; /* negative beyond the apex */
    double tilt = -cone->slope;                     /* R / H */
    if (second_nappe_geometric && radius < 0) tilt = -tilt;
    /* At the apex itself any direction of the wall's normal cone is as good; take the axis. */
    if (distance == 0) return facing(p, gi_vec(0, 0, tilt > 0 ? 1 : -1), size);
    p.x = cone->center.x + x * (fabs(radius) / distance);
    p.y = cone->center.y + y * (fabs(radius) / distance);
    GiSurfacePoint at = facing(p, gi_normalize(gi_vec(x / distance, y / distance, tilt)), size);
    if (radius < 0 && !second_nappe_geometric) at.geometric.z = -at.geometric.z;
    return at;
}

static GiSurfacePoint flat_point(GiVec point, GiVec normal, GiVec p) {
    return facing(gi_along(p, normal, gi_dot(gi_sub(point, p), normal)), normal,
        gi_largest(gi_sub(p, point)));
}

/* error: the size of the numbers beside the point's own. */
static GiSurfacePoint unplaced_point(const GiShapes *shapes, GiShapeRef ref, GiVec origin,
    GiVec direction, double t, bool second_nappe_geometric) {
    uint32_t i = gi_shape_index(ref);
    GiVec p = gi_along(origin, direction, t);
    if (gi_shape_kind(ref) == GI_SHAPE_SPHERE) return gi_sphere_point(&shapes->spheres[i], p);
    gi_hit_Ray ray =
        gi_hit_ray(origin.x, origin.y, origin.z, direction.x, direction.y, direction.z);
    switch (gi_shape_kind(ref)) {
    case GI_SHAPE_BOX: return box_point(&shapes->boxes[i], &ray, p, t);
    case GI_SHAPE_CONE: return cone_point(&shapes->cones[i], &ray, p, t, second_nappe_geometric);
    case GI_SHAPE_DISC: return flat_point(shapes->discs[i].center, shapes->discs[i].normal, p);
    default: return flat_point(shapes->planes[i].point, shapes->planes[i].normal, p);
    }
}

/* The largest sum of a row's entries: how much a map stretches at most, by components. */
static double norm(const GiAffine *a) {
    double most = 0;
    for (int row = 0; row < 3; row++) {
        most = fmax(most, fabs(a->m[row][0]) + fabs(a->m[row][1]) + fabs(a->m[row][2]));
    }
    return most;
}

static double offset_of(const GiAffine *a) {
    return fmax(fabs(a->m[0][3]), fmax(fabs(a->m[1][3]), fabs(a->m[2][3])));
}

GiSurfacePoint gi_shape_point_any(const GiShapes *shapes, GiShapeRef ref, uint32_t instance,
    GiVec origin, GiVec direction, double t, bool second_nappe_geometric) {
    (void)instance;
    GiSurfacePoint at;
    if (gi_shape_kind(ref) != GI_SHAPE_PLACED) {
        at = unplaced_point(shapes, ref, origin, direction, t, second_nappe_geometric);
        at.error = (at.error + gi_largest(at.point)) * GI_SURFACE_ERROR;
        return at;
    }
    const GiPlacement *placement = &shapes->placements[gi_shape_index(ref)];
    const GiTransform *transform = &shapes->transforms[placement->transform];
    /* The same operations as gi_hit_to_object, so that t fits to the bit. */
    origin = gi_affine_point(&transform->to_object, origin);
    direction = gi_affine_vector(&transform->to_object, direction);
    at = unplaced_point(shapes, placement->shape, origin, direction, t, second_nappe_geometric);
    /* Errors in object space are stretched by the transform, those of the way there shrunk and
     * stretched again: the product of the two norms bounds both. */
    double error = (at.error + gi_largest(at.point)) * norm(&transform->to_world);
    at.point = gi_affine_point(&transform->to_world, at.point);
    double there = (gi_largest(at.point) + offset_of(&transform->to_world)) *
                   norm(&transform->to_object) * norm(&transform->to_world);
    at.error = (error + there) * GI_SURFACE_ERROR;
    at.normal = gi_normalize(gi_affine_transposed_vector(&transform->to_object, at.normal));
    at.geometric = gi_normalize(gi_affine_transposed_vector(&transform->to_object, at.geometric));
    return at;
}

void gi_shape_texcoord(
    const GiShapes *shapes, GiShapeRef ref, uint32_t instance, GiVec point, double uv[2]) {
    (void)shapes;
    (void)ref;
    (void)instance;
    (void)point;
    uv[0] = uv[1] = 0;
}
