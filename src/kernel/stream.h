/* SPDX-License-Identifier: MIT
 * What happens to many rays and points between their walks through the tree: places in the picture
 * to rays, hits on spheres to points, points to shadow rays, light to pixels. The same operations
 * in the same order as the functions for one, so that the bits are the same. Part of kernel.c. */
#pragma once

/* The numbers from i on; the first of them in the place of those after the end. */
static inline void stream_load(uint32_t *to, const uint32_t *from, int i, int end) {
    if (i + GI_DOUBLES <= end) {
        u_copy(to, from + i);
        return;
    }
    for (int k = 0; k < GI_DOUBLES; k++) to[k] = from[i + k < end ? i + k : i];
}

static inline void stream_load_short(uint32_t *to, const uint16_t *from, int i, int end) {
    if (i + GI_DOUBLES <= end) {
        u_widen(to, from + i);
        return;
    }
    for (int k = 0; k < GI_DOUBLES; k++) to[k] = from[i + k < end ? i + k : i];
}

static void GI_KERNEL(view)(const GiView *view, const double *a, const double *b, GiBundle *to) {
    const GiVec *across = &view->across, *up = &view->up, *center = &view->center;
    for (int i = 0; i < to->count; i += GI_DOUBLES) {
        R s = r_load(a + i) - R_OF(0.5), t = r_load(b + i) - R_OF(0.5);
        Wide p = {R_OF(across->x) * s + R_OF(up->x) * t, R_OF(across->y) * s + R_OF(up->y) * t,
            R_OF(across->z) * s + R_OF(up->z) * t};
        Wide o = {R_OF(view->eye.x), R_OF(view->eye.y), R_OF(view->eye.z)};
        Wide d = {R_OF(center->x), R_OF(center->y), R_OF(center->z)};
        if (view->parallel) {
            o = wide_add(o, p);
        } else {
            d = wide_normalize(wide_add(d, p));
        }
        r_store(to->ox + i, o.x), r_store(to->oy + i, o.y), r_store(to->oz + i, o.z);
        r_store(to->dx + i, d.x), r_store(to->dy + i, d.y), r_store(to->dz + i, d.z);
    }
}

/* As gi_shape_point. */
static void GI_KERNEL(spheres)(const GiShapes *shapes, const GiBundle *bundle, const uint32_t *rays,
    int count, bool spared, GiPoints *to) {
    enum { SPHERE_STRIDE = sizeof(GiSphere) / sizeof(double) };
    const GiSphere *spheres = shapes->spheres;
    for (int i = 0; i < count; i += GI_DOUBLES) {
        uint32_t ray[GI_DOUBLES], shape[GI_DOUBLES], pixel[GI_DOUBLES];
        stream_load(ray, rays, i, count);
        u_gather(shape, bundle->shape, ray);
        u_gather(pixel, bundle->pixel, ray);
        int at = to->count + i;
        u_copy(to->pixel + at, pixel);
        u_fill(to->skip_instance + at, GI_SHAPE_NONE);
        r_store(to->red + at, R_OF(0));
        r_store(to->green + at, R_OF(0));
        r_store(to->blue + at, R_OF(0));
        if (spared) {
            u_copy(to->skip + at, shape);
        } else {
            u_fill(to->skip + at, GI_SHAPE_NONE);
        }
        /* The kind of spheres is 0, so the bits of a shape are its index. */
        Wide c = {r_gather(&spheres->center.x, shape, SPHERE_STRIDE),
            r_gather(&spheres->center.y, shape, SPHERE_STRIDE),
            r_gather(&spheres->center.z, shape, SPHERE_STRIDE)};
        R radius = r_gather(&spheres->radius, shape, SPHERE_STRIDE);
        R t = r_gather(bundle->t, ray, 1);
        Wide o = {r_gather(bundle->ox, ray, 1), r_gather(bundle->oy, ray, 1),
            r_gather(bundle->oz, ray, 1)};
        Wide d = {r_gather(bundle->dx, ray, 1), r_gather(bundle->dy, ray, 1),
            r_gather(bundle->dz, ray, 1)};
        Wide p = wide_along(o, d, t);
        Wide n = wide_normalize((Wide){p.x - c.x, p.y - c.y, p.z - c.z});
        p = wide_along(c, n, radius);
        R largest = R_MAX(R_ABS(p.x), R_MAX(R_ABS(p.y), R_ABS(p.z)));
        r_store(to->error + at, (radius + largest) * R_OF(GI_SURFACE_ERROR));
        r_store(to->px + at, p.x), r_store(to->py + at, p.y), r_store(to->pz + at, p.z);
        r_store(to->nx + at, n.x), r_store(to->ny + at, n.y), r_store(to->nz + at, n.z);
        r_store(to->vx + at, -d.x), r_store(to->vy + at, -d.y), r_store(to->vz + at, -d.z);
    }
    to->count += count;
}

static void GI_KERNEL(shadows)(
    const GiPoints *points, const GiLit *lit, const uint16_t *order, GiBundle *to) {
    for (int i = 0; i < to->count; i += GI_DOUBLES) {
        uint32_t index[GI_DOUBLES], point[GI_DOUBLES];
        stream_load_short(index, order, i, to->count);
        u_gather(point, lit->point, index);
        u_copy(to->pixel + i, point);
        u_gather(to->skip + i, points->skip, point);
        u_gather(to->skip_instance + i, points->skip_instance, point);
        Wide p = {r_gather(points->px, point, 1), r_gather(points->py, point, 1),
            r_gather(points->pz, point, 1)};
        r_store(to->ox + i, p.x), r_store(to->oy + i, p.y), r_store(to->oz + i, p.z);
        r_store(to->dx + i, R_OF(to->apex.x) - p.x);
        r_store(to->dy + i, R_OF(to->apex.y) - p.y);
        r_store(to->dz + i, R_OF(to->apex.z) - p.z);
        r_store(to->t_min + i, r_gather(lit->t_min, point, 1));
        r_store(to->t_max + i, R_OF(1));
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
