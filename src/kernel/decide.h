/* SPDX-License-Identifier: MIT
 * The exact tests of a bundle: the formulas of shape/hit_template.h for some rays of a packet, and
 * what follows from what they meet. Part of kernel.c. */
#pragma once

/* The rays from i on, but for what is made of their directions. */
static inline gi_wide_Ray tile_line(const Tile *tile, int i) {
    const GiBundle *bundle = tile->bundle;
    const GiVec *apex = &bundle->apex;
    R dx, dy, dz;
    bundle_directions(bundle, tile->any, i, &dx, &dy, &dz);
    return (gi_wide_Ray){.ox = tile->any ? r_load(bundle->ox + i) : R_OF(apex->x),
        .oy = tile->any ? r_load(bundle->oy + i) : R_OF(apex->y),
        .oz = tile->any ? r_load(bundle->oz + i) : R_OF(apex->z),
        .dx = dx,
        .dy = dy,
        .dz = dz};
}

/* Where they begin and end. For closest there is no end but their best. */
static inline R tile_from(const Tile *tile, int i) {
    return tile->any ? r_load(tile->bundle->t_min + i) : R_OF(tile->bundle->start);
}
static inline R tile_to(const Tile *tile) { return R_OF(tile->any ? tile->bundle->end : INFINITY); }

/* 1 / d.d. For d.d = 1 - e with |e| < 2^-28, and camera rays have unit length, nearly, the quotient
 * to the last bit is 1 + e, rounded, and up where that lies in the middle between two numbers. */
static inline R inverse_square(const gi_wide_Ray *ray) {
    R square = ray->dx * ray->dx + ray->dy * ray->dy + ray->dz * ray->dz, one = R_OF(1);
    R e = one - square;
    M unit = R_LESS(R_ABS(e), R_OF(0x1p-28));
    if (m_bits(unit) == m_bits(M_OF(true))) return one + e * R_OF(1 + 0x1p-52);
    return one / square;
}

/* Whether it is the first time that the rays from i on are asked about. */
static inline bool first_time(uint32_t *asked, int i) {
    uint32_t bit = 1u << i / GI_DOUBLES % 32, *bits = &asked[i / GI_DOUBLES / 32];
    bool first = (*bits & bit) == 0;
    *bits |= bit;
    return first;
}

/* With as much of that as the test of a kind of shape needs: quotients are worked out when they are
 * needed first, but for those that take no time. */
static inline gi_wide_Ray tile_ray(Tile *tile, GiShapeKind kind, int i) {
    GiBundle *bundle = tile->bundle;
    gi_wide_Ray ray = tile_line(tile, i);
    if (kind != GI_SHAPE_BOX && !tile->any) {
        ray.inverse_square = inverse_square(&ray);
    } else if (kind != GI_SHAPE_BOX) {
        if (first_time(tile->square_known, i)) {
            r_store(bundle->inverse_square + i, inverse_square(&ray));
        }
        ray.inverse_square = r_load(bundle->inverse_square + i);
    }
    if (kind != GI_SHAPE_BOX && kind != GI_SHAPE_CONE) return ray;
    if (first_time(tile->inverse_known, i)) {
        r_store(bundle->ix + i, gi_wide_inverse(ray.dx));
        r_store(bundle->iy + i, gi_wide_inverse(ray.dy));
        r_store(bundle->iz + i, gi_wide_inverse(ray.dz));
    }
    ray.ix = r_load(bundle->ix + i);
    ray.iy = r_load(bundle->iy + i);
    ray.iz = r_load(bundle->iz + i);
    return ray;
}

/* Of two shapes at the very same t the first in document order stays. */
static inline void resolve_ties(Tile *tile, GiShapeRef ref, int i, unsigned bits) {
    for (; bits != 0; bits &= bits - 1) {
        uint32_t *shape = &tile->bundle->shape[i + lowest_bit(bits)];
        uint32_t *instance = &tile->bundle->instance[i + lowest_bit(bits)];
        if (*shape != GI_SHAPE_NONE &&
            gi_shape_before(tile->shapes, ref, tile->instance, (GiShapeRef){*shape}, *instance)) {
            *shape = ref.bits;
            *instance = tile->instance;
        }
    }
}

/* Whether one of the rays j .. j + GI_DOUBLES - 1 is among the bits. */
static inline bool any_of(unsigned bits, int j) {
    return (bits >> j & ((1u << GI_DOUBLES) - 1)) != 0;
}

/* How far the rays of a packet still look. */
static inline void packet_refresh_far(Tile *tile, int packet) {
    const GiBundle *bundle = tile->bundle;
    const R scale = R_OF(tile->scale * (1 + GI_WIDER));
    float *far = tile->far + packet * GI_PACKET_SIZE;
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        int i = packet * GI_PACKET_SIZE + j;
        r_store_floats(far + j, r_load(bundle->t + i) * tile_depth(tile, i) * scale);
    }
    tile->packets.far[packet] = f_highest(far, GI_PACKET_SIZE);
}

/* These rays of a packet look for nothing any more. */
static inline void packet_stop(Tile *tile, int packet, unsigned rays) {
    tile->alive[packet] &= ~rays;
    if (rays == 0 || tile->alive[packet] != 0) return;
    packet_clear(&tile->packets, packet);
    tile->emptied++;
}

/* What the rays from i on meet of a shape: what is nearer becomes their best. */
static inline void take_nearer(Tile *tile, GiShapeRef ref, int i, M hit, R t) {
    GiBundle *bundle = tile->bundle;
    R best = r_load(bundle->t + i);
    M nearer = hit & R_LESS(t, best);
    unsigned bits = m_bits(nearer), ties = m_bits(hit & R_EQUAL(t, best));
    if (bits != 0) {
        r_store(bundle->t + i, R_SELECT(nearer, t, best));
        u_store_where(bundle->shape + i, bits, ref.bits);
        u_store_where(bundle->instance + i, bits, tile->instance);
        int packet = i / GI_PACKET_SIZE;
        tile->nearer[packet / 32] |= 1u << packet % 32;
    }
    if (ties != 0) resolve_ties(tile, ref, i, ties);
}

/* Where the rays from i on meet the shape; corners: of a triangle. */
static inline M tile_meets(Tile *tile, GiShapeRef ref, R corners[3][3], int i, R *t) {
    gi_wide_Ray ray = tile_ray(tile, gi_shape_kind(ref), i);
    R t_min = tile_from(tile, i), t_max = tile_to(tile);
    if (corners != NULL) return gi_wide_triangle_at(corners, &ray, t_min, t_max, t);
    return gi_wide_shape(tile->shapes, ref, &ray, t_min, t_max, t);
}

/* One shape against those rays of a packet whose bits are set. */
static inline void test_closest(
    Tile *tile, GiShapeRef ref, R corners[3][3], int packet, unsigned rays) {
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        if (!any_of(rays, j)) continue;
        int i = packet * GI_PACKET_SIZE + j;
        R t;
        M hit = tile_meets(tile, ref, corners, i, &t);
        take_nearer(tile, ref, i, hit, t);
    }
}

/* The same of spheres. Not inline, so that it has all registers to itself. */
static NOINLINE void closest_sphere(Tile *tile, GiShapeRef ref, int packet, unsigned rays) {
    const GiSphere *sphere = &tile->shapes->spheres[gi_shape_index(ref)];
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        if (!any_of(rays, j)) continue;
        int i = packet * GI_PACKET_SIZE + j;
        gi_wide_Ray ray = tile_ray(tile, GI_SHAPE_SPHERE, i);
        R t;
        M hit = gi_wide_sphere(sphere, &ray, tile_from(tile, i), tile_to(tile), &t);
        take_nearer(tile, ref, i, hit, t);
    }
}

/* Without those rays that spare this shape. */
static inline unsigned not_sparing(const Tile *tile, GiShapeRef ref, int packet, unsigned rays) {
    const GiBundle *bundle = tile->bundle;
    unsigned skip = sixteen_equal(ref.bits, bundle->skip + packet * GI_PACKET_SIZE);
    if (skip == 0) return rays;
    return rays &
           ~(skip & sixteen_equal(tile->instance, bundle->skip_instance + packet * GI_PACKET_SIZE));
}

static inline void test_any(
    Tile *tile, GiShapeRef ref, R corners[3][3], int packet, unsigned rays) {
    unsigned stopped = 0;
    rays = not_sparing(tile, ref, packet, rays);
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        if (!any_of(rays, j)) continue;
        int i = packet * GI_PACKET_SIZE + j;
        R t;
        unsigned bits = m_bits(tile_meets(tile, ref, corners, i, &t)) & rays >> j;
        u_store_where(tile->bundle->shape + i, bits, ref.bits);
        stopped |= bits << j;
    }
    packet_stop(tile, packet, stopped);
}

static NOINLINE void any_sphere(Tile *tile, GiShapeRef ref, int packet, unsigned rays) {
    const GiSphere *sphere = &tile->shapes->spheres[gi_shape_index(ref)];
    unsigned stopped = 0;
    rays = not_sparing(tile, ref, packet, rays);
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        if (!any_of(rays, j)) continue;
        int i = packet * GI_PACKET_SIZE + j;
        gi_wide_Ray ray = tile_ray(tile, GI_SHAPE_SPHERE, i);
        R t;
        M hit = gi_wide_sphere(sphere, &ray, tile_from(tile, i), tile_to(tile), &t);
        unsigned bits = m_bits(hit) & rays >> j;
        u_store_where(tile->bundle->shape + i, bits, ref.bits);
        stopped |= bits << j;
    }
    packet_stop(tile, packet, stopped);
}

static inline void tile_test(Tile *tile, GiShapeRef ref, int packet, unsigned rays) {
    R corners[3][3];
    switch (gi_shape_kind(ref)) {
    case GI_SHAPE_SPHERE:
        if (tile->any) {
            any_sphere(tile, ref, packet, rays);
        } else {
            closest_sphere(tile, ref, packet, rays);
        }
        return;
    case GI_SHAPE_TRIANGLE:
        gi_wide_corners(&tile->shapes->triangles, gi_shape_index(ref), corners);
        if (tile->any) {
            test_any(tile, ref, corners, packet, rays);
        } else {
            test_closest(tile, ref, corners, packet, rays);
        }
        return;
    default:
        if (tile->any) {
            test_any(tile, ref, NULL, packet, rays);
        } else {
            test_closest(tile, ref, NULL, packet, rays);
        }
    }
}
