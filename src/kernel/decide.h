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
    const R scale = R_OF(tile->scale);
    const unsigned known = ~tile->open[packet] & 0xffff;
    float *far = tile->far + packet * GI_PACKET_SIZE;
    for (int j = 0; j < GI_PACKET_SIZE && known != 0; j += GI_WIDEST) {
        R depth[GI_PARTS];
        for (int k = 0; k < GI_PARTS; k++) {
            int i = packet * GI_PACKET_SIZE + j + k * GI_DOUBLES;
            depth[k] = r_load(bundle->t + i) * tile_depth(tile, i) * scale;
        }
        P end = p_rounded(depth);
        p_store_where(far + j, known >> j, end * p_of(1 + GI_WIDER));
        p_store_where(
            tile->surely + packet * GI_PACKET_SIZE + j, known >> j, end * p_of(1 - GI_WIDER));
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

/* Works out the t of rays of a packet that have come to triangles: as the exact test does, each ray
 * with a triangle of its own. */
static NOINLINE void tile_settle(Tile *tile, int packet, unsigned rays) {
    GiBundle *bundle = tile->bundle;
    const GiTriangles *triangles = &tile->shapes->triangles;
    tile->open[packet] &= ~rays;
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        if (!any_of(rays, j)) continue;
        int i = packet * GI_PACKET_SIZE + j;
        const float *rows[3][GI_DOUBLES];
        uint32_t first = bundle->shape[i + lowest_bit(rays >> j)];
        for (int lane = 0; lane < GI_DOUBLES; lane++) {
            GiShapeRef ref = {rays >> (j + lane) & 1 ? bundle->shape[i + lane] : first};
            const uint32_t *corners = triangles->corners[gi_shape_index(ref)];
            for (int k = 0; k < 3; k++) rows[k][lane] = triangles->positions[corners[k]];
        }
        R corners[3][3], t;
        for (int k = 0; k < 3; k++) r_rows(rows[k], corners[k]);
        const gi_wide_Ray ray = tile_ray(tile, GI_SHAPE_TRIANGLE, i);
        gi_wide_triangle_at(corners, &ray, tile_from(tile, i), tile_to(tile), &t);
        r_store(bundle->t + i, R_SELECT(m_from_bits(rays >> j), t, r_load(bundle->t + i)));
    }
}

/* What the rays from i on meet of a shape: what is nearer becomes their best. */
static inline void take_nearer(Tile *tile, GiShapeRef ref, int i, M hit, R t) {
    GiBundle *bundle = tile->bundle;
    unsigned open = m_bits(hit) & tile->open[i / GI_PACKET_SIZE] >> i % GI_PACKET_SIZE;
    if (open != 0) tile_settle(tile, i / GI_PACKET_SIZE, open << i % GI_PACKET_SIZE);
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
        M hit = tile_meets(tile, ref, corners, i, &t) & m_from_bits(rays >> j);
        take_nearer(tile, ref, i, hit, t);
    }
}

/* Bits of the rays of a packet that spare this shape. */
static inline unsigned spared_by(const Tile *tile, GiShapeRef ref, int packet) {
    const GiBundle *bundle = tile->bundle;
    return sixteen_equal(ref.bits, bundle->skip + packet * GI_PACKET_SIZE) &
           sixteen_equal(tile->instance, bundle->skip_instance + packet * GI_PACKET_SIZE);
}

static inline void test_any(
    Tile *tile, GiShapeRef ref, R corners[3][3], int packet, unsigned rays) {
    unsigned stopped = 0;
    rays &= ~spared_by(tile, ref, packet);
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

/* Any shape but a solid. */
static inline void tile_test(Tile *tile, GiShapeRef ref, int packet, unsigned rays) {
    R corners[3][3];
    switch (gi_shape_kind(ref)) {
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

/* ---------------------------------------------------------------- solids */

static inline void tile_places(Tile *tile) {
    const GiShapes *shapes = tile->shapes;
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        tile->places[kind] = (Places){(const char *)tile->tree, 0};
    }
    /* Else it is rarely that more than their boxes is looked at. */
    if (!tile->any || tile->frustum.parallel) {
        tile->places[GI_SHAPE_SPHERE] = (Places){(const char *)shapes->spheres, sizeof(GiSphere)};
        tile->places[GI_SHAPE_BOX] = (Places){(const char *)shapes->boxes, sizeof(GiBox)};
    }
    tile->places[GI_SHAPE_CONE] = (Places){(const char *)shapes->cones, sizeof(GiCone)};
    tile->places[GI_SHAPE_PLACED] = (Places){(const char *)shapes->placements, sizeof(GiPlacement)};
    tile->places[GI_SHAPE_INSTANCE] = (Places){(const char *)shapes->instances, sizeof(GiInstance)};
}

/* Without asking which kind it is: that cannot be foretold. */
static inline void prefetch_small(const Tile *tile, GiShapeRef ref) {
    const Places *places = &tile->places[gi_shape_kind(ref)];
    prefetch(places->first + places->size * gi_shape_index(ref));
}

/* Solids are tested in loops over one kind, without a question that half of the time is answered
 * wrong: which tests have rays left in which vectors is a list, and what is met is stored where it
 * is nearer, not if any is. */
typedef struct Part {
    uint32_t solid, first; /* index; the first of GI_DOUBLES rays */
    unsigned rays;         /* bits of those that look */
} Part;

enum { PART_TESTS = 64, PART_LIMIT = PART_TESTS * GI_PACKET_SIZE / GI_DOUBLES };

/* As gi_wide_unplaced, of a kind that the compiler knows. */
static inline M solid_meets(Tile *tile, GiShapeKind kind, const Part *part, R *t) {
    const GiShapes *shapes = tile->shapes;
    int i = (int)part->first;
    gi_wide_Ray ray = tile_ray(tile, kind, i);
    R t_min = tile_from(tile, i), t_max = tile_to(tile);
    bool entering_only = shapes->entering_only;
    switch (kind) {
    case GI_SHAPE_SPHERE:
        return gi_wide_sphere(&shapes->spheres[part->solid], &ray, t_min, t_max, t);
    case GI_SHAPE_BOX:
        return gi_wide_box(&shapes->boxes[part->solid], &ray, entering_only, t_min, t_max, t);
    default: return gi_wide_cone(&shapes->cones[part->solid], &ray, entering_only, t_min, t_max, t);
    }
}

static inline void closest_solids(Tile *tile, GiShapeKind kind, const Part *parts, int count) {
    GiBundle *bundle = tile->bundle;
    for (int k = 0; k < count; k++) {
        int i = (int)parts[k].first, packet = i / GI_PACKET_SIZE;
        GiShapeRef ref = gi_shape_ref(kind, parts[k].solid);
        R t;
        M hit = solid_meets(tile, kind, &parts[k], &t) & m_from_bits(parts[k].rays);
        unsigned open = m_bits(hit) & tile->open[packet] >> i % GI_PACKET_SIZE;
        if (open != 0) tile_settle(tile, packet, open << i % GI_PACKET_SIZE);
        R best = r_load(bundle->t + i);
        M nearer = hit & R_LESS(t, best);
        unsigned bits = m_bits(nearer), ties = m_bits(hit & R_EQUAL(t, best));
        r_store(bundle->t + i, R_SELECT(nearer, t, best));
        u_store_where(bundle->shape + i, bits, ref.bits);
        u_store_where(bundle->instance + i, bits, tile->instance);
        tile->nearer[packet / 32] |= (uint32_t)(bits != 0) << packet % 32;
        if (ties != 0) resolve_ties(tile, ref, i, ties);
    }
}

static inline void any_solids(Tile *tile, GiShapeKind kind, const Part *parts, int count) {
    for (int k = 0; k < count; k++) {
        int i = (int)parts[k].first, packet = i / GI_PACKET_SIZE;
        R t;
        unsigned bits = m_bits(solid_meets(tile, kind, &parts[k], &t)) & parts[k].rays;
        u_store_where(tile->bundle->shape + i, bits, gi_shape_ref(kind, parts[k].solid).bits);
        packet_stop(tile, packet, bits << i % GI_PACKET_SIZE);
    }
}

/* Not inline, so that each has all registers to itself. */
static NOINLINE FLATTEN void closest_spheres(Tile *tile, const Part *parts, int count) {
    closest_solids(tile, GI_SHAPE_SPHERE, parts, count);
}
static NOINLINE FLATTEN void closest_boxes(Tile *tile, const Part *parts, int count) {
    closest_solids(tile, GI_SHAPE_BOX, parts, count);
}
static NOINLINE FLATTEN void closest_cones(Tile *tile, const Part *parts, int count) {
    closest_solids(tile, GI_SHAPE_CONE, parts, count);
}
static NOINLINE FLATTEN void any_spheres(Tile *tile, const Part *parts, int count) {
    any_solids(tile, GI_SHAPE_SPHERE, parts, count);
}
static NOINLINE FLATTEN void any_boxes(Tile *tile, const Part *parts, int count) {
    any_solids(tile, GI_SHAPE_BOX, parts, count);
}
static NOINLINE FLATTEN void any_cones(Tile *tile, const Part *parts, int count) {
    any_solids(tile, GI_SHAPE_CONE, parts, count);
}

static inline void test_parts(Tile *tile, GiShapeKind kind, const Part *parts, int count) {
    if (count == 0) return;
    switch (kind) {
    case GI_SHAPE_SPHERE: (tile->any ? any_spheres : closest_spheres)(tile, parts, count); break;
    case GI_SHAPE_BOX: (tile->any ? any_boxes : closest_boxes)(tile, parts, count); break;
    default: (tile->any ? any_cones : closest_cones)(tile, parts, count); break;
    }
}

/* The tests of one kind of solid, for rays that still look. */
static inline void test_solids(Tile *tile, GiShapeKind kind, const Test *tests, int count) {
    Part parts[PART_LIMIT];
    for (int begin = 0; begin < count; begin += PART_TESTS) {
        int end = begin + PART_TESTS < count ? begin + PART_TESTS : count, found = 0;
        for (int k = begin; k < end; k++) {
            const Test *test = &tests[k];
            unsigned rays = test->rays & tile->alive[test->packet];
            if (tile->any) rays &= ~spared_by(tile, test->shape, (int)test->packet);
            COUNT(shapes, __builtin_popcount(rays));
            for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
                unsigned bits = rays >> j & ((1u << GI_DOUBLES) - 1);
                uint32_t first = test->packet * GI_PACKET_SIZE + (uint32_t)j;
                parts[found] = (Part){gi_shape_index(test->shape), first, bits};
                found += bits != 0;
            }
        }
        test_parts(tile, kind, parts, found);
    }
}
