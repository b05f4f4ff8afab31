/* SPDX-License-Identifier: MIT
 * One small solid and the rays of a packet: which of them possibly or certainly meet it, in single
 * precision. Part of kernel.c.
 *
 * Leaves of mixed kinds know their shapes as boxes. Before doubles decide about a sphere, box or
 * cone of such a leaf, sixteen rays at once are tried against the shape itself, by its own numbers
 * relative to the apex. No quotients and no intervals: what is asked is only whether the ray's line
 * meets the solid, and all of it lies between the ray's two ends.
 *
 * A ray's line is s d, with d = a u + b v + w. With |a|, |b| of at most those of the tile, let
 *     D = 1 + |a| + |b|      so that every component of d is at most D,
 *     L                      the largest coordinate of a corner of the solid's box,
 *     e = 2^-24              one rounding.
 * a and b err by four roundings each, so a component of d by less than 8 e D; a coordinate of the
 * centre c by e L; a component of K = d x c by less than 24 e D L. Doubles have lost less than
 * `lost` of a place, which is 2 D lost in K.
 *
 * Boxes, with half extents h: a line misses if and only if some |K_x| > h_y |d_z| + h_z |d_y|, of
 * which the right side errs by 24 e D L at most: 64 e D L is allowed for both.
 *
 * Cones, with radius r + t z at height z over the centre and half height h. With the vectors of the
 * plane g = r d + t k and k = d_z c - c_z d, the line is inside of the wall where
 *     A s^2 - 2 B s + C <= 0,    A = |d|^2 - t^2 d_z^2,    B^2 - A C = |g|^2 - K_z^2,
 * and for A > 0 that is an interval, which overlaps with that of the slab when their middles are no
 * farther apart than their halves together. Times A |d_z|:
 *     |d . k + t r d_z^2|  <=  sqrt(|g|^2 - K_z^2) |d_z| + h A.
 * g errs by less than (17 + 40 t) e D L, so that 64 (1 + t) e D L is allowed in |K_z|; k by less
 * than 34 e D L, hence the left side by (92 + 19 t) e D^2 L, and h A by (36 + 18 t^2) e D^2 L: 256
 * (1 + t)^2 e D^2 L is allowed. With A <= 2^-10 D^2 (1 + t)^2, which is more than its error,
 * nothing is certain. Squares and products add roundings of their own, for which there are factors
 * of 16 e. */
#pragma once

/* By its box, relative to the apex along the axes of the tree. */
typedef struct Solid {
    float center[3], half[3];
    float reach; /* L */
    float lost;  /* of a place */
} Solid;

static inline Solid solid_of(const Tile *tile, GiVec center, GiVec half) {
    const Frustum *frustum = &tile->frustum;
    GiVec apex = tile->bundle->apex;
    double scale = tile->scale;
    Solid solid = {.center = {(float)((center.x - apex.x) * scale),
                       (float)((center.y - apex.y) * scale), (float)((center.z - apex.z) * scale)},
        .half = {(float)(half.x * scale), (float)(half.y * scale), (float)(half.z * scale)},
        .reach = 0,
        .lost = frustum->lost + (float)GI_TREE_GROWTH_LEAST};
    for (int axis = 0; axis < 3; axis++) {
        solid.reach = larger(solid.reach, fabsf(solid.center[axis]) + solid.half[axis]);
    }
    return solid;
}

/* Of rays that possibly or certainly meet the solid with their lines: certain is what lies between
 * their two ends. */
static inline Verdict solid_between(
    const Tile *tile, const Solid *solid, int packet, unsigned maybe, unsigned sure) {
    Verdict verdict = {maybe, 0};
    const float *w = tile->frustum.axis[2];
    float middle = 0, extent = solid->reach * 0x1p-19f + 2 * solid->lost;
    for (int axis = 0; axis < 3; axis++) {
        middle += w[axis] * solid->center[axis];
        extent += fabsf(w[axis]) * solid->half[axis];
    }
    if (middle - extent < tile->frustum.start) return verdict;
    verdict.sure = sure & sixteen_from(middle + extent, tile->surely + packet * GI_PACKET_SIZE);
    return verdict;
}

/* Beyond this squares leave the range of floats. */
static inline bool solid_is_vast(const Solid *solid) {
    return !(solid->reach < 0x1p40f && solid->lost < 0x1p40f);
}

/* The directions of rays along the axes of the tree. */
static inline void rays_directions(const Tile *tile, int i, P d[3]) {
    const float(*axis)[3] = tile->frustum.axis;
    P a = p_load(tile->a + i), b = p_load(tile->b + i);
    for (int k = 0; k < 3; k++) {
        d[k] = p_fused(a, p_of(axis[0][k]), p_fused(b, p_of(axis[1][k]), p_of(axis[2][k])));
    }
}

/* ---------------------------------------------------------------- kinds */

static inline Verdict small_box(const Tile *tile, const GiBox *box, int packet) {
    GiVec half = gi_scale(gi_sub(box->high, box->low), 0.5);
    Solid solid = solid_of(tile, gi_add(box->low, half), half);
    if (solid_is_vast(&solid)) return (Verdict){0xffff, 0};
    const float *c = solid.center, *h = solid.half;
    float spread = tile->frustum.spread;
    float slack = spread * (solid.reach * 0x1p-18f + 4 * solid.lost);
    unsigned maybe = 0, sure = 0;
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_WIDEST) {
        P d[3], most = p_of(-INFINITY);
        rays_directions(tile, packet * GI_PACKET_SIZE + j, d);
        for (int x = 0; x < 3; x++) {
            int y = (x + 1) % 3, z = (x + 2) % 3;
            P cross = p_less_fused(d[z], p_of(c[y]), d[y] * p_of(c[z]));
            P limit = p_fused(p_size(d[z]), p_of(h[y]), p_size(d[y]) * p_of(h[z]));
            most = p_max(most, p_size(cross) - limit);
        }
        maybe |= p_less_equal(most, p_of(slack)) << j;
        sure |= p_less_equal(most, p_of(-slack)) << j;
    }
    /* Those without exits are entered as well: all of it is in front of the ray. */
    return solid_between(tile, &solid, packet, maybe, sure);
}

static inline Verdict small_sphere(const Tile *tile, const GiSphere *sphere, int packet) {
    GiVec half = gi_vec(sphere->radius, sphere->radius, sphere->radius);
    Solid solid = solid_of(tile, sphere->center, half);
    if (solid_is_vast(&solid)) return (Verdict){0xffff, 0};
    const float *c = solid.center, (*axis)[3] = tile->frustum.axis;
    float p[3], size = 0;
    for (int k = 0; k < 3; k++) {
        p[k] = axis[k][0] * c[0] + axis[k][1] * c[1] + axis[k][2] * c[2];
        size += fabsf(p[k]);
    }
    float slack = size * 0x1p-18f + 2 * solid.lost;
    float outer = (solid.half[0] + slack) * (1 + 0x1p-20f);
    float inner = larger(solid.half[0] - slack, 0) * (1 - 0x1p-20f);
    const Ball ball = {p[0], p[1], p[2], outer * outer, inner * inner - 0x1p-100f};
    return sphere_verdict(tile, tile->any, &ball, p[2] - solid.half[0] - slack, packet);
}

static inline Verdict small_cone(const Tile *tile, const GiCone *cone, int packet) {
    const Verdict open = {0xffff, 0};
    double wide = fabs(cone->radius) + fabs(cone->slope) * cone->half_height;
    Solid solid = solid_of(tile, cone->center, gi_vec(wide, wide, cone->half_height));
    float tilt = (float)cone->slope, steep = 1 + fabsf(tilt), spread = tile->frustum.spread;
    if (solid_is_vast(&solid) || !(steep <= 4)) return open;
    const P cx = p_of(solid.center[0]), cy = p_of(solid.center[1]), cz = p_of(solid.center[2]);
    const P r = p_of((float)(cone->radius * tile->scale)), t = p_of(tilt), h = p_of(solid.half[2]);
    const P zero = p_of(0), more = p_of(1 + 0x1p-20f), less = p_of(1 - 0x1p-20f);
    float room = solid.reach * 0x1p-18f + 4 * solid.lost, scale = spread * steep;
    const P apart = p_of(room * scale), beside = p_of(4 * room * scale * scale);
    const P least = p_of(0x1p-10f * scale * scale);
    unsigned maybe = 0, sure = 0;
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_WIDEST) {
        P d[3];
        rays_directions(tile, packet * GI_PACKET_SIZE + j, d);
        P kx = p_less_fused(cz, d[0], d[2] * cx), ky = p_less_fused(cz, d[1], d[2] * cy);
        P cross = p_size(p_less_fused(d[1], cx, d[0] * cy));
        P gx = p_fused(r, d[0], t * kx), gy = p_fused(r, d[1], t * ky);
        P zz = d[2] * d[2], square = p_fused(gx, gx, gy * gy);
        P a = p_less_fused(t * t, zz, p_fused(d[0], d[0], d[1] * d[1]));
        P between = p_size(p_fused(d[0], kx, p_fused(d[1], ky, t * r * zz))) - h * a;
        unsigned regular = p_less_equal(least, a);
        P nearest = p_max(cross - apart, zero), farthest = cross + apart;
        P outer = p_less_fused(nearest, nearest, square * more);
        P inner = p_less_fused(farthest, farthest, square * less);
        P gap = p_max(between - beside, zero), more_gap = p_max(between + beside, zero);
        unsigned in = p_less_equal(zero, outer) & p_less_equal(gap * gap * less, outer * zz);
        maybe |= (in | (~regular & ((1u << GI_WIDEST) - 1))) << j;
        sure |= (regular & p_less_equal(zero, inner) &
                    p_less_equal(more_gap * more_gap * more, inner * zz))
                << j;
    }
    return solid_between(tile, &solid, packet, maybe & 0xffff, sure);
}

/* Takes what is certain, and leaves the tests with the rays that doubles have to decide about. */
static inline void look_at(Tile *tile, GiShapeKind kind, SolidTests *list) {
    int left = 0;
    for (int k = 0; k < list->count; k++) {
        Test test = list->tests[k];
        int packet = (int)test.packet;
        if (!test.known) {
            uint32_t index = gi_shape_index(test.shape);
            Verdict verdict;
            switch (kind) {
            case GI_SHAPE_SPHERE:
                verdict = small_sphere(tile, &tile->shapes->spheres[index], packet);
                break;
            case GI_SHAPE_BOX:
                verdict = small_box(tile, &tile->shapes->boxes[index], packet);
                break;
            default: verdict = small_cone(tile, &tile->shapes->cones[index], packet); break;
            }
            unsigned rays = test.rays & tile->alive[packet], sure = verdict.sure & rays;
            for (int j = 0; j < GI_PACKET_SIZE; j += GI_WIDEST) {
                p_fill_where(
                    tile->bundle->shape + packet * GI_PACKET_SIZE + j, sure >> j, test.shape.bits);
            }
            packet_stop(tile, packet, sure);
            test.rays = verdict.maybe & rays & ~sure;
        }
        list->tests[left] = test;
        left += test.rays != 0;
    }
    list->count = left;
}

static NOINLINE void look_at_spheres(Tile *tile, SolidTests *list) {
    look_at(tile, GI_SHAPE_SPHERE, list);
}
static NOINLINE void look_at_boxes(Tile *tile, SolidTests *list) {
    look_at(tile, GI_SHAPE_BOX, list);
}
static NOINLINE void look_at_cones(Tile *tile, SolidTests *list) {
    look_at(tile, GI_SHAPE_CONE, list);
}

static inline void solids_look(Tile *tile, GiShapeKind kind, SolidTests *list) {
    switch (kind) {
    case GI_SHAPE_SPHERE: look_at_spheres(tile, list); break;
    case GI_SHAPE_BOX: look_at_boxes(tile, list); break;
    default: look_at_cones(tile, list); break;
    }
}
