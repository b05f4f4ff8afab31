/* SPDX-License-Identifier: MIT
 * What happens to many rays and points between their walks through the tree: places in the picture
 * to rays, hits on shapes to points, points to shadow rays, light to pixels. The same operations
 * in the same order as the functions for one, so that the bits are the same. Part of kernel.c. */
#pragma once

/* The numbers from i on; the first of them in the place of those after the end. */
static inline U stream_load(const uint32_t *from, int i, int end) {
    if (i + GI_DOUBLES <= end) return u_load(from + i);
    uint32_t last[GI_DOUBLES];
    for (int k = 0; k < GI_DOUBLES; k++) last[k] = from[i + k < end ? i + k : i];
    return u_load(last);
}

static inline U stream_load_short(const uint16_t *from, int i, int end) {
    if (i + GI_DOUBLES <= end) return u_widen(from + i);
    uint32_t last[GI_DOUBLES];
    for (int k = 0; k < GI_DOUBLES; k++) last[k] = from[i + k < end ? i + k : i];
    return u_load(last);
}

/* ---------------------------------------------------------------- rays */

static void GI_KERNEL(view)(const GiView *view, const double *a, const double *b, GiBundle *to) {
    const GiVec *across = &view->across, *up = &view->up, *center = &view->center;
    for (int i = 0; i < to->count; i += GI_DOUBLES) {
        R s = r_load(a + i) - R_OF(0.5), t = r_load(b + i) - R_OF(0.5);
        Wide p = {R_OF(across->x) * s + R_OF(up->x) * t, R_OF(across->y) * s + R_OF(up->y) * t,
            R_OF(across->z) * s + R_OF(up->z) * t};
        Wide d = {R_OF(center->x), R_OF(center->y), R_OF(center->z)};
        if (view->parallel) {
            Wide o = wide_add((Wide){R_OF(view->eye.x), R_OF(view->eye.y), R_OF(view->eye.z)}, p);
            r_store(to->ox + i, o.x), r_store(to->oy + i, o.y), r_store(to->oz + i, o.z);
        } else {
            d = wide_normalize(wide_add(d, p));
        }
        r_store(to->dx + i, d.x), r_store(to->dy + i, d.y), r_store(to->dz + i, d.z);
    }
}

/* ---------------------------------------------------------------- groups */

/* A key is looked for up to where it comes last: as far as that is known, from a table in which
 * other keys may have written too, but only later places. */
static int GI_KERNEL(group)(const uint32_t *keys, int count, uint32_t *places, int *ends) {
    enum { SLOTS = 1024 };
    uint16_t last[SLOTS];
    uint16_t open[GI_PACKET_COUNT]; /* bits of the places that are in no group yet */
    int packets = (count + 15) / 16, found = 0, groups = 0;
    for (int i = 0; i < count; i++) last[keys[i] % SLOTS] = (uint16_t)i;
    for (int i = 0; i < packets; i++) {
        int left = count - 16 * i;
        open[i] = (uint16_t)(left < 16 ? (1u << left) - 1 : 0xffff);
    }
    for (int first = 0; first < packets; first++) {
        while (open[first] != 0) {
            uint32_t key = keys[16 * first + lowest_bit(open[first])];
            int end = last[key % SLOTS] / 16;
            for (int i = first; i <= end; i++) {
                unsigned bits = open[i] & sixteen_equal(key, keys + 16 * i);
                open[i] = (uint16_t)(open[i] ^ bits);
                found += sixteen_append(places + found, bits, (uint32_t)(16 * i));
            }
            ends[groups++] = found;
        }
    }
    return groups;
}

/* ---------------------------------------------------------------- points */

/* Rays with the shapes they met, by index, and where: in the end moved onto the surface. */
typedef struct Hits {
    Wide o, d, p, n;
    R t, size; /* size: of the numbers beside the point's own */
    R error;
    R clear; /* both as in GiPoints */
    U shape, pixel;
} Hits;

/* What makes a shape clear of its own shadow rays. All are convex, and a ray meets one where it
 * comes in or goes out, so it misses when it has left before it begins. A ray from a point of the
 * surface leaves at t = 0, but for rounding, if it goes outward at all; so much is left to show
 * that rounding is less than the distance E from which on it looks, E = 2^11 e S with e = 2^-53 and
 * S = size + |p|, the numbers of shape and point. The point itself is off the surface by up to 16 e
 * S; when the cosine of ray and normal is c, that is 16 e S / c along the ray. */
static inline R hits_error(const Hits *hits) {
    return (hits->size + wide_largest(hits->p)) * R_OF(GI_SURFACE_ERROR);
}

/* So that nothing changes within what the point is off: 2^10 E below a radius. */
static inline M hits_tame(const Hits *hits, R radius) {
    return R_LESS_EQUAL(hits->error * R_OF(1024), radius);
}

#define STREAM_GATHER(member) r_gather(&(member), hits->shape, stride)

/* As sphere_point of shape.c. */
static inline void hits_spheres(Hits *hits, const GiSphere *first) {
    enum { stride = sizeof *first / sizeof(double) };
    Wide c;
    R radius;
    if (u_is_one(hits->shape)) {
        const GiSphere *sphere = first + u_first(hits->shape);
        c = (Wide){R_OF(sphere->center.x), R_OF(sphere->center.y), R_OF(sphere->center.z)};
        radius = R_OF(sphere->radius);
    } else {
        c = (Wide){STREAM_GATHER(first->center.x), STREAM_GATHER(first->center.y),
            STREAM_GATHER(first->center.z)};
        radius = STREAM_GATHER(first->radius);
    }
    hits->n = wide_normalize((Wide){hits->p.x - c.x, hits->p.y - c.y, hits->p.z - c.z});
    hits->p = wide_along(c, hits->n, radius);
    hits->size = radius;
    hits->error = hits_error(hits);
    /* Where the ray comes nearest to the centre errs by 10 e r, and the square of half the chord,
     * (r c)^2, by 50 e r^2; half the chord thus by 25 e r / c. */
    hits->clear = R_SELECT(hits_tame(hits, radius), R_OF(0x1p-5), R_OF(INFINITY));
}

/* One axis of a box: its two planes, and where the ray crosses them. */
typedef struct Slab {
    R low, high, inverse, enter, leave;
} Slab;

static inline Slab slab_of(R low, R high, R o, R d) {
    Slab slab = {.low = low, .high = high, .inverse = gi_wide_inverse(d)};
    gi_wide_slab(low, high, o, slab.inverse, &slab.enter, &slab.leave);
    return slab;
}

/* Where the point is on a face of this axis: to its plane, with its normal. */
static inline void slab_face(const Slab *slab, M on, M entering, R *p, R *n) {
    R zero = R_OF(0);
    M high = R_SELECT_M(entering, R_LESS(slab->inverse, zero), R_LESS(zero, slab->inverse));
    *p = R_SELECT(on, R_SELECT(high, slab->high, slab->low), *p);
    *n = R_SELECT(on, R_SELECT(high, R_OF(1), R_OF(-1)), zero);
}

/* As box_point. */
static inline void hits_boxes(Hits *hits, const GiBox *first) {
    enum { stride = sizeof *first / sizeof(double) };
    Slab x =
        slab_of(STREAM_GATHER(first->low.x), STREAM_GATHER(first->high.x), hits->o.x, hits->d.x);
    Slab y =
        slab_of(STREAM_GATHER(first->low.y), STREAM_GATHER(first->high.y), hits->o.y, hits->d.y);
    Slab z =
        slab_of(STREAM_GATHER(first->low.z), STREAM_GATHER(first->high.z), hits->o.z, hits->d.z);
    M entering = R_EQUAL(R_MAX(x.enter, R_MAX(y.enter, z.enter)), hits->t);
    M on_x = R_EQUAL(R_SELECT(entering, x.enter, x.leave), hits->t);
    M on_y = R_EQUAL(R_SELECT(entering, y.enter, y.leave), hits->t) & M_NOT(on_x);
    slab_face(&x, on_x, entering, &hits->p.x, &hits->n.x);
    slab_face(&y, on_y, entering, &hits->p.y, &hits->n.y);
    slab_face(&z, M_NOT(on_x) & M_NOT(on_y), entering, &hits->p.z, &hits->n.z);
    hits->size = R_OF(0);
    hits->error = hits_error(hits);
    /* The point has a coordinate of the face it is on, so the ray leaves at zero, exactly. */
    hits->clear = R_OF(0);
}

/* The cosines of points on cones that are not too flat, and of one nappe. On a cap the ray leaves
 * where it leaves the slab, which errs by 16 e S / c.
 *
 * On the wall, q of wall_of is zero, and what it grows by along the ray is at least 2 rho c, rho
 * being the wall's radius there. With a slope of at most one all lengths are less than 3 s, s the
 * distance from the centre, and a, b, c err by less than 13 e, 41 e s and 86 e s^2, which the root
 * in two steps does not add to; so q errs by less than 256 e s^2 and the root by 128 e s^2 / (rho
 * c). Of a line steeper than the wall what is beyond the second root belongs to the other nappe;
 * that root is no nearer to the slab than the line to the apex, rho c. */
static inline R cone_clear(
    const Hits *hits, const gi_wide_ConeLanes *cone, R half, M on_cap, R radius, R square) {
    R slope = R_ABS(cone->slope), size = half + cone->radius;
    M tame = R_LESS_EQUAL(slope, R_OF(1)) &
             R_LESS_EQUAL(slope * half, cone->radius * R_OF(1 + 0x1p-40)) &
             R_LESS(R_OF(0), cone->radius);
    R wall = R_OF(0x1p-6) + R_OF(0x1p-45) * square / (radius * hits->error);
    M on_wall = R_LESS_EQUAL(size, radius * R_OF(1024)) & hits_tame(hits, radius);
    M known = tame & (on_cap | on_wall);
    return R_SELECT(known, R_SELECT(on_cap, R_OF(0x1p-6), wall), R_OF(INFINITY));
}

/* As cone_point. */
static inline void hits_cones(Hits *hits, const GiCone *first, bool second_nappe_geometric) {
    enum { stride = sizeof *first / sizeof(double) };
    const gi_wide_ConeLanes cone = {STREAM_GATHER(first->center.x), STREAM_GATHER(first->center.y),
        STREAM_GATHER(first->center.z), STREAM_GATHER(first->radius), STREAM_GATHER(first->slope)};
    R half = STREAM_GATHER(first->half_height), zero = R_OF(0), one = R_OF(1);
    const Wide *o = &hits->o, *d = &hits->d;
    const gi_wide_Ray ray = gi_wide_ray(o->x, o->y, o->z, d->x, d->y, d->z);
    gi_wide_Wall wall = gi_wide_wall_of(&cone, &ray);
    R enter, leave;
    gi_wide_slab(-half, half, wall.oz, ray.iz, &enter, &leave);
    M entering = R_EQUAL(enter + wall.shift, hits->t);
    M on_cap = entering | R_EQUAL(leave + wall.shift, hits->t);
    M falling = R_LESS(ray.iz, zero);
    M top = (entering & falling) | (M_NOT(entering) & M_NOT(falling));
    R x = hits->p.x - cone.x, y = hits->p.y - cone.y, z = hits->p.z - cone.z;
    R distance = R_SQRT(x * x + y * y);
    R radius = cone.radius + cone.slope * z, tilt = -cone.slope;
    if (second_nappe_geometric) tilt = R_SELECT(R_LESS(radius, zero), -tilt, tilt);
    M on_axis = R_EQUAL(distance, zero) & M_NOT(on_cap), on_wall = M_NOT(on_cap) & M_NOT(on_axis);
    R part = R_ABS(radius) / distance;
    Wide n = wide_normalize((Wide){x / distance, y / distance, tilt});
    R along = R_SELECT(R_SELECT_M(on_cap, top, R_LESS(zero, tilt)), one, -one);
    hits->n = (Wide){
        R_SELECT(on_wall, n.x, zero), R_SELECT(on_wall, n.y, zero), R_SELECT(on_wall, n.z, along)};
    hits->p.x = R_SELECT(on_wall, cone.x + x * part, hits->p.x);
    hits->p.y = R_SELECT(on_wall, cone.y + y * part, hits->p.y);
    hits->p.z = R_SELECT(on_cap, cone.z + R_SELECT(top, half, -half), hits->p.z);
    hits->size = half + cone.radius;
    hits->error = hits_error(hits);
    hits->clear = cone_clear(hits, &cone, half, on_cap, radius, distance * distance + z * z);
}

#undef STREAM_GATHER

/* Rows of floats, one for each lane, or one for all. */
static inline void hits_rows(const float *const rows[GI_DOUBLES], int count, R columns[3]) {
    if (count > 1) {
        r_rows(rows, columns);
    } else {
        for (int i = 0; i < 3; i++) columns[i] = R_OF((double)rows[0][i]);
    }
}

/* As triangle_point, but the normal is not yet of unit length. Often all hits are on one triangle,
 * and mostly on the mesh of those before. */
static inline void hits_triangles(Hits *hits, const GiShapes *shapes, const GiMesh **last) {
    const float *corners[3][GI_DOUBLES], *normals[3][GI_DOUBLES];
    uint32_t triangles[GI_DOUBLES];
    unsigned smooth = 0;
    const int count = u_is_one(hits->shape) ? 1 : GI_DOUBLES;
    u_store(triangles, hits->shape);
    for (int k = 0; k < count; k++) {
        uint32_t triangle = triangles[k], row[3];
        const uint32_t *own = shapes->triangles.corners[triangle];
        const GiMesh *mesh = *last;
        if (triangle - mesh->first_triangle >= mesh->triangle_count) {
            *last = mesh = &shapes->meshes[gi_shape_mesh(shapes, triangle)];
        }
        bool has_normals = gi_triangle_normals(shapes, triangle, mesh, row);
        smooth |= (unsigned)has_normals << k;
        for (int i = 0; i < 3; i++) {
            corners[i][k] = shapes->triangles.positions[own[i]];
            normals[i][k] = has_normals ? shapes->triangles.normals[row[i]] : corners[i][k];
        }
    }
    R zero = R_OF(0), corner[3][3], part[3];
    for (int i = 0; i < 3; i++) hits_rows(corners[i], count, corner[i]);
    const gi_wide_Ray ray = {.ox = hits->o.x,
        .oy = hits->o.y,
        .oz = hits->o.z,
        .dx = hits->d.x,
        .dy = hits->d.y,
        .dz = hits->d.z};
    gi_wide_Weights weights = gi_wide_weights_at(corner, &ray);
    R scale = R_OF(1) / (weights.u + weights.v + weights.w);
    part[0] = weights.u * scale, part[1] = weights.v * scale, part[2] = weights.w * scale;
    hits->p = (Wide){zero, zero, zero};
    hits->size = zero;
    for (int i = 0; i < 3; i++) {
        Wide c = {corner[i][0], corner[i][1], corner[i][2]};
        hits->p = wide_along(hits->p, c, part[i]);
        hits->size = R_MAX(hits->size, wide_largest(c));
    }
    Wide a = {
        corner[1][0] - corner[0][0], corner[1][1] - corner[0][1], corner[1][2] - corner[0][2]};
    Wide b = {
        corner[2][0] - corner[0][0], corner[2][1] - corner[0][1], corner[2][2] - corner[0][2]};
    hits->n = (Wide){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    if (smooth != 0) {
        Wide blend = {zero, zero, zero};
        for (int i = 0; i < 3; i++) {
            R normal[3];
            hits_rows(normals[i], count, normal);
            blend = wide_along(blend, (Wide){normal[0], normal[1], normal[2]}, part[i]);
        }
        M flat = R_EQUAL(blend.x, zero) & R_EQUAL(blend.y, zero) & R_EQUAL(blend.z, zero);
        M blended = (count > 1 ? m_from_bits(smooth) : M_OF(true)) & M_NOT(flat);
        hits->n = (Wide){R_SELECT(blended, blend.x, hits->n.x),
            R_SELECT(blended, blend.y, hits->n.y), R_SELECT(blended, blend.z, hits->n.z)};
    }
    hits->error = hits_error(hits);
    hits->clear = R_OF(INFINITY);
}

static inline void hits_store(const Hits *hits, GiPoints *to, int at) {
    Wide p = hits->p, n = hits->n, d = hits->d;
    R zero = R_OF(0);
    r_store(to->error + at, hits->error);
    r_store_floats(to->clear + at, hits->clear);
    r_store(to->px + at, p.x), r_store(to->py + at, p.y), r_store(to->pz + at, p.z);
    r_store(to->nx + at, n.x), r_store(to->ny + at, n.y), r_store(to->nz + at, n.z);
    r_store(to->vx + at, -d.x), r_store(to->vy + at, -d.y), r_store(to->vz + at, -d.z);
    r_store(to->red + at, zero), r_store(to->green + at, zero), r_store(to->blue + at, zero);
}

/* The rays of the bundle that `ray` names, which often stand side by side. */
static inline void hits_load(Hits *hits, const GiBundle *bundle, U ray) {
    if (u_is_run(ray)) {
        size_t k = u_first(ray);
        hits->d = (Wide){r_load(bundle->dx + k), r_load(bundle->dy + k), r_load(bundle->dz + k)};
        hits->t = r_load(bundle->t + k);
        hits->shape = u_load(bundle->shape + k);
        hits->pixel = u_load(bundle->pixel + k);
    } else {
        hits->d = (Wide){r_gather(bundle->dx, ray, 1), r_gather(bundle->dy, ray, 1),
            r_gather(bundle->dz, ray, 1)};
        hits->t = r_gather(bundle->t, ray, 1);
        hits->shape = u_gather(bundle->shape, ray);
        hits->pixel = u_gather(bundle->pixel, ray);
    }
    if (bundle->own) {
        hits->o = (Wide){r_gather(bundle->ox, ray, 1), r_gather(bundle->oy, ray, 1),
            r_gather(bundle->oz, ray, 1)};
    } else {
        const GiVec *apex = &bundle->apex;
        hits->o = (Wide){R_OF(apex->x), R_OF(apex->y), R_OF(apex->z)};
    }
}

/* Makes the normals of points unit. A loop of its own: with nothing else in it the processor has
 * several vectors under way, each of which waits for a root and a quotient. */
static void points_normalize(GiPoints *points, int begin, int end) {
    for (int i = begin; i < end; i += GI_DOUBLES) {
        Wide n = wide_normalize(
            (Wide){r_load(points->nx + i), r_load(points->ny + i), r_load(points->nz + i)});
        r_store(points->nx + i, n.x), r_store(points->ny + i, n.y), r_store(points->nz + i, n.z);
    }
}

static void GI_KERNEL(points)(const GiShapes *shapes, const GiBundle *bundle, const uint32_t *rays,
    int count, GiOwn own, bool second_nappe_geometric, GiPoints *to) {
    GiShapeKind kind = gi_shape_kind((GiShapeRef){bundle->shape[rays[0]]});
    const U index_bits = u_of(GI_SHAPE_INDEX_LIMIT - 1), none = u_of(GI_SHAPE_NONE);
    const U skip_instance = own == GI_OWN_LEFT ? u_of(GI_LEFT) : none;
    const GiMesh *mesh = shapes->meshes;
    for (int i = 0; i < count; i += GI_DOUBLES) {
        Hits hits; /* no initializer, which would clear the rest of it each time */
        hits_load(&hits, bundle, stream_load(rays, i, count));
        U shape = hits.shape;
        hits.shape = shape & index_bits;
        hits.p = wide_along(hits.o, hits.d, hits.t);
        switch (kind) {
        case GI_SHAPE_SPHERE: hits_spheres(&hits, shapes->spheres); break;
        case GI_SHAPE_BOX: hits_boxes(&hits, shapes->boxes); break;
        case GI_SHAPE_TRIANGLE: hits_triangles(&hits, shapes, &mesh); break;
        default: hits_cones(&hits, shapes->cones, second_nappe_geometric); break;
        }
        int at = to->count + i;
        hits_store(&hits, to, at);
        u_store(to->pixel + at, hits.pixel);
        u_store(to->skip + at, own != GI_OWN_MET ? shape : none);
        u_store(to->own + at, shape);
        u_store(to->skip_instance + at, skip_instance);
    }
    if (kind == GI_SHAPE_TRIANGLE) points_normalize(to, to->count, to->count + count);
    to->count += count;
}

/* ---------------------------------------------------------------- light */

static void GI_KERNEL(shadows)(
    const GiPoints *points, const GiLit *lit, const uint16_t *order, GiBundle *to) {
    for (int i = 0; i < to->count; i += GI_DOUBLES) {
        U point = u_gather(lit->point, stream_load_short(order, i, to->count));
        Wide p;
        R t_min;
        u_store(to->pixel + i, point);
        if (u_is_run(point)) {
            size_t k = u_first(point);
            u_store(to->skip + i, u_load(lit->skip + k));
            u_store(to->skip_instance + i, u_load(points->skip_instance + k));
            p = (Wide){r_load(points->px + k), r_load(points->py + k), r_load(points->pz + k)};
            t_min = r_load(lit->t_min + k);
        } else {
            u_store(to->skip + i, u_gather(lit->skip, point));
            u_store(to->skip_instance + i, u_gather(points->skip_instance, point));
            p = (Wide){r_gather(points->px, point, 1), r_gather(points->py, point, 1),
                r_gather(points->pz, point, 1)};
            t_min = r_gather(lit->t_min, point, 1);
        }
        r_store(to->ox + i, p.x), r_store(to->oy + i, p.y), r_store(to->oz + i, p.z);
        r_store(to->t_min + i, t_min);
    }
}

static inline void stream_add(double *to, const double *from, M where) {
    R sum = r_load(to);
    r_store(to, R_SELECT(where, sum + r_load(from), sum));
}

static void GI_KERNEL(add)(const GiLit *lit, GiPoints *points) {
    for (int i = 0; i < points->count; i += GI_DOUBLES) {
        M arrives = m_from_bytes(lit->arrives + i);
        stream_add(points->red + i, lit->red + i, arrives);
        stream_add(points->green + i, lit->green + i, arrives);
        stream_add(points->blue + i, lit->blue + i, arrives);
    }
}

/* ---------------------------------------------------------------- colours */

/* A quotient to the last bit: a power of two is divided by with a product, which takes a quarter of
 * the time. The sum with zero makes one zero of two. */
static inline R stream_color(R sum, int samples, double exposure) {
    bool power = (samples & (samples - 1)) == 0;
    R mean = power ? (R)(sum * R_OF(1.0 / samples)) : (R)(sum / R_OF((double)samples));
    return mean * R_OF(exposure) + R_OF(0);
}

static void GI_KERNEL(colors)(
    const GiVec *sums, int count, int samples, double exposure, float *to) {
    const double *from = &sums->x;
    int all = 3 * count, i = 0;
    for (; i + GI_DOUBLES <= all; i += GI_DOUBLES) {
        r_store_floats(to + i, stream_color(r_load(from + i), samples, exposure));
    }
    if (i == all) return;
    double last[GI_DOUBLES] = {0};
    float colors[GI_DOUBLES];
    for (int k = 0; i + k < all; k++) last[k] = from[i + k];
    r_store_floats(colors, stream_color(r_load(last), samples, exposure));
    for (int k = 0; i + k < all; k++) to[i + k] = colors[k];
}
