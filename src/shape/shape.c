/* SPDX-License-Identifier: MIT */
#include "shape/shape.h"

#include "math/elementary.h"
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

static GiBox rectangle_bounds(const GiRectangle *rectangle) {
    GiVec a = rectangle->across, b = rectangle->up;
    GiVec reach = gi_vec(fabs(a.x) + fabs(b.x), fabs(a.y) + fabs(b.y), fabs(a.z) + fabs(b.z));
    return (GiBox){gi_sub(rectangle->center, reach), gi_add(rectangle->center, reach)};
}

static GiVec corner_vec(const float p[3]) { return gi_vec(p[0], p[1], p[2]); }

/* Not normalized; zero when the triangle has no area. */
static GiVec triangle_normal(const float *const corners[3]) {
    GiVec a = corner_vec(corners[0]);
    return gi_cross(gi_sub(corner_vec(corners[1]), a), gi_sub(corner_vec(corners[2]), a));
}

static GiBox triangle_bounds(const GiTriangles *triangles, uint32_t triangle) {
    const float *corners[3];
    gi_triangle_corners(triangles, triangle, corners);
    if (gi_vec_is_zero(triangle_normal(corners))) {
        return (GiBox){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    }
    GiBox box = {corner_vec(corners[0]), corner_vec(corners[0])};
    for (int i = 1; i < 3; i++) {
        GiVec p = corner_vec(corners[i]);
        box.low = gi_vec(gi_hit_minimum(box.low.x, p.x), gi_hit_minimum(box.low.y, p.y),
            gi_hit_minimum(box.low.z, p.z));
        box.high = gi_vec(gi_hit_maximum(box.high.x, p.x), gi_hit_maximum(box.high.y, p.y),
            gi_hit_maximum(box.high.z, p.z));
    }
    return box;
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
    case GI_SHAPE_RECTANGLE: return rectangle_bounds(&shapes->rectangles[i]);
    case GI_SHAPE_TRIANGLE: return triangle_bounds(&shapes->triangles, i);
    default: return (GiBox){{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
    }
}

/* Not of what is empty or without bounds. */
static bool box_is_finite(const GiBox *box) {
    return isfinite(box->low.x + box->low.y + box->low.z) &&
           isfinite(box->high.x + box->high.y + box->high.z);
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

static GiBox bounds_outside(const GiShapes *shapes, GiShapeRef ref) {
    if (gi_shape_kind(ref) == GI_SHAPE_INSTANCE) {
        const GiInstance *instance = &shapes->instances[gi_shape_index(ref)];
        if (!box_is_finite(instance->bounds)) return *instance->bounds;
        return transform_box(&shapes->transforms[instance->transform].to_world, instance->bounds);
    }
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

GiBox gi_shape_bounds(const GiShapes *shapes, GiShapeRef ref, uint32_t instance) {
    GiBox box = bounds_outside(shapes, ref);
    if (instance == GI_SHAPE_NONE || !box_is_finite(&box)) return box;
    const GiInstance *in = &shapes->instances[instance];
    return transform_box(&shapes->transforms[in->transform].to_world, &box);
}

/* ---------------------------------------------------------------- point and normal */

/* The normal to shade with is that of the surface. In what follows error is the size of the numbers
 * beside the point's own. */
static GiSurfacePoint facing(GiVec point, GiVec normal, double error) {
    return (GiSurfacePoint){point, normal, normal, error};
}

static GiSurfacePoint sphere_point(const GiSphere *sphere, GiVec p) {
    GiVec normal = gi_normalize(gi_sub(p, sphere->center));
    return facing(gi_along(sphere->center, normal, sphere->radius), normal, sphere->radius);
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

/* Of the vertices, by the parts that they have in the point. False: there are none. */
static inline bool blend_normals(
    const GiShapes *shapes, uint32_t triangle, const double part[3], GiVec *blend) {
    const GiTriangles *triangles = &shapes->triangles;
    const GiMesh *mesh = &shapes->meshes[gi_shape_mesh(shapes, triangle)];
    uint32_t row[3];
    *blend = gi_vec(0, 0, 0);
    if (!gi_triangle_normals(shapes, triangle, mesh, row)) return false;
    for (int i = 0; i < 3; i++) {
        *blend = gi_along(*blend, corner_vec(triangles->normals[row[i]]), part[i]);
    }
    return !gi_vec_is_zero(*blend);
}

static GiSurfacePoint triangle_point(
    const GiShapes *shapes, uint32_t triangle, GiVec origin, GiVec direction) {
    const GiTriangles *triangles = &shapes->triangles;
    const float *corners[3];
    gi_triangle_corners(triangles, triangle, corners);
    const gi_hit_Ray ray = {.ox = origin.x,
        .oy = origin.y,
        .oz = origin.z,
        .dx = direction.x,
        .dy = direction.y,
        .dz = direction.z};
    gi_hit_Weights weights = gi_hit_weights(triangles, triangle, &ray);
    double scale = 1 / (weights.u + weights.v + weights.w);
    const double part[3] = {weights.u * scale, weights.v * scale, weights.w * scale};
    GiVec p = {0, 0, 0};
    double size = 0;
    for (int i = 0; i < 3; i++) {
        GiVec corner = corner_vec(corners[i]);
        p = gi_along(p, corner, part[i]);
        size = gi_hit_maximum(size, gi_largest(corner));
    }
    GiVec geometric = gi_normalize(triangle_normal(corners));
    GiSurfacePoint at = facing(p, geometric, size);
    GiVec blend;
    if (blend_normals(shapes, triangle, part, &blend)) at.normal = gi_normalize(blend);
    return at;
}

static GiSurfacePoint unplaced_point(const GiShapes *shapes, GiShapeRef ref, GiVec origin,
    GiVec direction, double t, bool second_nappe_geometric) {
    uint32_t i = gi_shape_index(ref);
    GiVec p = gi_along(origin, direction, t);
    if (gi_shape_kind(ref) == GI_SHAPE_SPHERE) return sphere_point(&shapes->spheres[i], p);
    if (gi_shape_kind(ref) == GI_SHAPE_TRIANGLE) {
        return triangle_point(shapes, i, origin, direction);
    }
    gi_hit_Ray ray =
        gi_hit_ray(origin.x, origin.y, origin.z, direction.x, direction.y, direction.z);
    switch (gi_shape_kind(ref)) {
    case GI_SHAPE_BOX: return box_point(&shapes->boxes[i], &ray, p, t);
    case GI_SHAPE_CONE: return cone_point(&shapes->cones[i], &ray, p, t, second_nappe_geometric);
    case GI_SHAPE_DISC: return flat_point(shapes->discs[i].center, shapes->discs[i].normal, p);
    case GI_SHAPE_RECTANGLE:
        return flat_point(shapes->rectangles[i].center, shapes->rectangles[i].normal, p);
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

/* The same operations as gi_hit_to_object, so that t fits to the bit. */
static void enter(const GiTransform *transform, GiVec *origin, GiVec *direction) {
    *origin = gi_affine_point(&transform->to_object, *origin);
    *direction = gi_affine_vector(&transform->to_object, *direction);
}

/* Out of the space of a placed shape or an instance. at->error is still the size of the numbers the
 * point is made of: those in object space are stretched by the transform, those of the way there
 * shrunk and stretched again; the product of the two norms bounds both. */
static void leave(const GiTransform *transform, GiSurfacePoint *at) {
    const GiAffine *to_world = &transform->to_world, *to_object = &transform->to_object;
    double size = at->error * norm(to_world);
    at->point = gi_affine_point(to_world, at->point);
    double there = (gi_largest(at->point) + offset_of(to_world)) * norm(to_object) * norm(to_world);
    at->error = size + there;
    at->normal = gi_normalize(gi_affine_transposed_vector(to_object, at->normal));
    at->geometric = gi_normalize(gi_affine_transposed_vector(to_object, at->geometric));
}

/* The transforms between the world and the shape's own space, outermost first. */
static int transforms_of(
    const GiShapes *shapes, GiShapeRef ref, uint32_t instance, const GiTransform *transforms[2]) {
    int count = 0;
    if (instance != GI_SHAPE_NONE) {
        transforms[count++] = &shapes->transforms[shapes->instances[instance].transform];
    }
    if (gi_shape_kind(ref) == GI_SHAPE_PLACED) {
        const GiPlacement *placement = &shapes->placements[gi_shape_index(ref)];
        transforms[count++] = &shapes->transforms[placement->transform];
    }
    return count;
}

GiSurfacePoint gi_shape_point(const GiShapes *shapes, GiShapeRef ref, uint32_t instance,
    GiVec origin, GiVec direction, double t, bool second_nappe_geometric) {
    const GiTransform *transforms[2];
    int count = transforms_of(shapes, ref, instance, transforms);
    for (int i = 0; i < count; i++) enter(transforms[i], &origin, &direction);
    GiSurfacePoint at = unplaced_point(
        shapes, gi_shape_unplaced(shapes, ref), origin, direction, t, second_nappe_geometric);
    at.error += gi_largest(at.point);
    for (int i = count; i-- > 0;) leave(transforms[i], &at);
    at.error *= GI_SURFACE_ERROR;
    return at;
}

/* How long a normal is where nobody normalises it. Origin and direction are in object space. */
static double length_of_normal(
    const GiShapes *shapes, GiShapeRef ref, GiVec origin, GiVec direction) {
    if (gi_shape_kind(ref) == GI_SHAPE_SPHERE) return shapes->spheres[gi_shape_index(ref)].radius;
    if (gi_shape_kind(ref) != GI_SHAPE_TRIANGLE) return 1;
    GiVec blend;
    const GiTriangles *triangles = &shapes->triangles;
    const gi_hit_Ray ray = {.ox = origin.x,
        .oy = origin.y,
        .oz = origin.z,
        .dx = direction.x,
        .dy = direction.y,
        .dz = direction.z};
    gi_hit_Weights weights = gi_hit_weights(triangles, gi_shape_index(ref), &ray);
    double scale = 1 / (weights.u + weights.v + weights.w);
    const double part[3] = {weights.u * scale, weights.v * scale, weights.w * scale};
    return blend_normals(shapes, gi_shape_index(ref), part, &blend) ? gi_length(blend) : 1;
}

/* The right normal is taken back into object space first. */
void gi_shape_spoil_normal(const GiShapes *shapes, GiShapeRef ref, uint32_t instance, GiVec origin,
    GiVec direction, GiSurfacePoint *at) {
    const GiTransform *transforms[2];
    int count = transforms_of(shapes, ref, instance, transforms);
    unsigned faults = shapes->normal_faults;
    GiVec n = faults & GI_NORMAL_FLAT ? at->geometric : at->normal, seen_along = direction;
    for (int i = 0; i < count; i++) {
        enter(transforms[i], &origin, &direction);
        n = gi_normalize(gi_affine_transposed_vector(&transforms[i]->to_world, n));
    }
    if (faults & GI_NORMAL_LENGTH) {
        GiShapeRef own = gi_shape_unplaced(shapes, ref);
        n = gi_scale(n, length_of_normal(shapes, own, origin, direction));
    }
    for (int i = count; i-- > 0;) {
        n = faults & GI_NORMAL_MATRIX ? gi_affine_vector(&transforms[i]->to_world, n)
                                      : gi_affine_transposed_vector(&transforms[i]->to_object, n);
        if (!(faults & GI_NORMAL_LENGTH)) n = gi_normalize(n);
    }
    if ((faults & GI_NORMAL_FACING) && gi_dot(n, seen_along) > 0) n = gi_negate(n);
    at->normal = faults & GI_NORMAL_INWARD ? gi_negate(n) : n;
}

/* ---------------------------------------------------------------- texture coordinates */

void gi_sphere_texcoord(GiVec normal, double uv[2]) {
    const double pi = 3.14159265358979324;
    double y = normal.y < -1 ? -1 : normal.y > 1 ? 1 : normal.y;
    uv[0] = (gi_atan2(normal.x, normal.z) + pi) / (2 * pi);
    uv[1] = (gi_asin(y) + pi / 2) / pi;
}

static void triangle_texcoord(
    const GiShapes *shapes, uint32_t triangle, GiVec point, double uv[2]) {
    const GiTriangles *triangles = &shapes->triangles;
    const GiMesh *mesh = &shapes->meshes[gi_shape_mesh(shapes, triangle)];
    uint32_t row[3];
    if (!mesh->textured || !gi_triangle_row(triangles, triangle, mesh, mesh->texcoord_corners,
                               mesh->first_texcoord, row)) {
        return;
    }
    const float *corners[3];
    gi_triangle_corners(triangles, triangle, corners);
    GiVec normal = triangle_normal(corners), from[3];
    for (int i = 0; i < 3; i++) from[i] = gi_sub(corner_vec(corners[i]), point);
    double part[3], sum = 0;
    for (int i = 0; i < 3; i++) {
        part[i] = gi_dot(normal, gi_cross(from[(i + 1) % 3], from[(i + 2) % 3]));
        sum += part[i];
    }
    if (!(fabs(sum) > 0)) return;
    for (int i = 0; i < 3; i++) {
        uv[0] += part[i] / sum * (double)triangles->texcoords[row[i]][0];
        uv[1] += part[i] / sum * (double)triangles->texcoords[row[i]][1];
    }
}

void gi_shape_texcoord(
    const GiShapes *shapes, GiShapeRef ref, uint32_t instance, GiVec point, double uv[2]) {
    const GiTransform *transforms[2];
    int count = transforms_of(shapes, ref, instance, transforms);
    for (int i = 0; i < count; i++) point = gi_affine_point(&transforms[i]->to_object, point);
    GiShapeRef own = gi_shape_unplaced(shapes, ref);
    uv[0] = uv[1] = 0;
    if (gi_shape_kind(own) == GI_SHAPE_SPHERE) {
        GiVec center = shapes->spheres[gi_shape_index(own)].center;
        gi_sphere_texcoord(gi_normalize(gi_sub(point, center)), uv);
    } else if (gi_shape_kind(own) == GI_SHAPE_TRIANGLE) {
        triangle_texcoord(shapes, gi_shape_index(own), point, uv);
    }
}
