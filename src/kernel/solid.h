/* SPDX-License-Identifier: MIT
 * One small solid and the rays of a packet: which of them possibly or certainly meet it, in single
 * precision. Part of kernel.c.
 *
 * Leaves of mixed kinds know their shapes as boxes. Before doubles decide about a sphere, box or
 * cone of such a leaf, sixteen rays at once are tried against the shape itself, relative to the
 * apex: its box tells all about it, but for a cone's slope. No quotients and no intervals: what is
 * asked is only whether the ray's line meets the solid, and all of it lies between the ray's two
 * ends.
 *
 * A ray's line is s d, with d = a u + b v + w. With |a|, |b| of at most those of the tile, let
 *     D = 1 + |a| + |b|      so that every component of d is at most D,
 *     L                      the largest coordinate of a corner of the solid's box,
 *     e = 2^-24              one rounding.
 * a and b err by four roundings each, so a component of d by less than 8 e D; a coordinate of the
 * centre c by e L; a component of K = d x c by less than 24 e D L. Centres and half extents have
 * lost less than `lost` besides: in doubles, where the apex was rounded (a 32nd of `margin`), and
 * where the box was, which is at most three roundings of its distance from the tree's centre. That
 * is 2 D lost in K.
 *
 * Spheres, whose slack is that of certain.h, and 4 lost: the centre errs by less than two of it.
 *
 * Boxes, with half extents h: a line misses if and only if some |K_x| > h_y |d_z| + h_z |d_y|, of
 * which the right side errs by 24 e D L and 2 D lost at most: 64 e D L and 4 D lost are allowed for
 * both.
 *
 * Cones, with radius r + t z at height z over the centre and half height h. With the vectors of the
 * plane g = r d + t k and k = d_z c - c_z d, the line is inside of the wall where
 *     A s^2 - 2 B s + C <= 0,    A = |d|^2 - t^2 d_z^2,    B^2 - A C = |g|^2 - K_z^2,
 * and for A > 0 that is an interval, which overlaps with that of the slab when their middles are no
 * farther apart than their halves together. Times A |d_z|:
 *     |d . k + t r d_z^2|  <=  sqrt(|g|^2 - K_z^2) |d_z| + h A.
 * g errs by less than (17 + 40 t) e D L, so that 64 (1 + t) e D L is allowed in |K_z|; k by less
 * than 34 e D L, hence the left side by (92 + 19 t) e D^2 L, and h A by (36 + 18 t^2) e D^2 L: 256
 * (1 + t)^2 e D^2 L is allowed. The roundings of squares and products have room in that.
 *
 * For A < 0 the line is steeper than the wall. It comes through the wall once, if there is one
 * nappe, and leaves through the base, the wider end: it meets the cone if and only if it meets the
 * base. With R the base's radius and m its height, like c relative to the rays' apex,
 *     |d_z c - m d|  <=  R |d_z|,
 * which errs no more than k does and 10 e D L on the right: what is allowed in |K_z| is enough.
 * Certain it is only where |g|^2 - K_z^2 > 0 is certain as well: next to the cone's own apex
 * doubles might take one root for the other.
 *
 * With |A| <= 2^-10 D^2 (1 + t)^2, which is more than its error, nothing is certain. `lost` adds at
 * most 5.2 (1 + t) D lost to what errs by D L, and is allowed for sixfold. */
#pragma once

/* Of rays that possibly or certainly meet the solid with their lines: certain is what lies between
 * their two ends. */
static inline Verdict solid_between(const Tile *tile, const Solids *solids, int lane, float nearest,
    int packet, unsigned maybe, unsigned sure) {
    if (nearest < tile->frustum.start) sure = 0;
    sure &= sixteen_from(solids->end[lane], tile->surely + packet * GI_PACKET_SIZE);
    return (Verdict){maybe, sure};
}

/* Beyond this squares leave the range of floats. */
static inline bool solid_is_vast(const Solids *solids, int lane) {
    return !(solids->reach[lane] + solids->lost[lane] < 0x1p40f);
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

static inline Verdict small_box(
    const Tile *tile, const Solids *solids, int lane, float nearest, int packet) {
    const float c[3] = {solids->center[0][lane], solids->center[1][lane], solids->center[2][lane]};
    const float h[3] = {solids->half[0][lane], solids->half[1][lane], solids->half[2][lane]};
    float spread = tile->frustum.spread;
    float slack = spread * (solids->reach[lane] * 0x1p-18f + 4 * solids->lost[lane]);
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
        if (!tile->any) continue;
        sure |= p_less_equal(most, p_of(-slack)) << j;
    }
    /* Those without exits are entered as well: all of it is in front of the ray. */
    return solid_between(tile, solids, lane, nearest, packet, maybe, sure);
}

static inline Verdict small_sphere(
    const Tile *tile, const Solids *solids, int lane, float nearest, int packet) {
    float x = solids->seen[0][lane], y = solids->seen[1][lane], z = solids->seen[2][lane];
    float slack = (fabsf(x) + fabsf(y) + fabsf(z)) * 0x1p-18f + 4 * solids->lost[lane];
    float outer = (solids->half[0][lane] + slack) * (1 + 0x1p-20f);
    float inner = larger(solids->half[0][lane] - slack, 0) * (1 - 0x1p-20f);
    const Ball ball = {x, y, z, outer * outer, inner * inner - 0x1p-100f};
    return sphere_verdict(tile, tile->any, &ball, nearest, packet);
}

static inline Verdict small_cone(const Tile *tile, const GiCone *cone, const Solids *solids,
    int lane, float nearest, int packet) {
    float slope = (float)(cone->radius < 0 ? -cone->slope : cone->slope);
    float tilt = fabsf(slope), steep = 1 + tilt, spread = tile->frustum.spread;
    if (!(steep <= 4)) return (Verdict){0xffff, 0};
    const float half = solids->half[2][lane], wide = solids->half[0][lane];
    const float radius = wide - tilt * half;
    const P cx = p_of(solids->center[0][lane]), cy = p_of(solids->center[1][lane]),
            cz = p_of(solids->center[2][lane]);
    const P r = p_of(radius), t = p_of(slope), h = p_of(half);
    float room = solids->reach[lane] * 0x1p-18f + 6 * solids->lost[lane], scale = spread * steep;
    const P zero = p_of(0), apart = p_of(room * scale), beside = p_of(4 * room * scale * scale);
    const P square_slope = p_of(slope * slope), product = p_of(slope * radius);
    bool one_nappe = fabs(cone->slope) * cone->half_height <= fabs(cone->radius) * (1 + 0x1p-40);
    const float least = 0x1p-10f * scale * scale;
    const P regular_least = p_of(least), slanted_most = p_of(one_nappe ? -least : -INFINITY);
    const P base = p_of(slope < 0 ? -half : half), width = p_of(wide);
    const unsigned all = (1u << GI_WIDEST) - 1;
    unsigned maybe = 0, sure = 0;
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_WIDEST) {
        P d[3];
        rays_directions(tile, packet * GI_PACKET_SIZE + j, d);
        P kx = p_less_fused(cz, d[0], d[2] * cx), ky = p_less_fused(cz, d[1], d[2] * cy);
        P cross = p_size(p_less_fused(d[1], cx, d[0] * cy));
        P gx = p_fused(r, d[0], t * kx), gy = p_fused(r, d[1], t * ky);
        P zz = d[2] * d[2], square = p_fused(gx, gx, gy * gy);
        P a = p_less_fused(square_slope, zz, p_fused(d[0], d[0], d[1] * d[1]));
        P middles = p_size(p_fused(d[0], kx, p_fused(d[1], ky, product * zz)));
        P between = p_less_fused(h, a, middles);
        P near = p_max(cross - apart, zero), gap = p_max(between - beside, zero);
        P outer = p_less_fused(near, near, square);
        /* Where the line goes through the plane of the base. */
        P bx = p_less_fused(base, d[0], kx), by = p_less_fused(base, d[1], ky);
        P off = p_fused(bx, bx, by * by), rim = width * p_size(d[2]), around = rim + apart;
        unsigned regular = p_less_equal(regular_least, a), slanted = p_less_equal(a, slanted_most);
        maybe |= ((regular & p_less_equal(gap * gap, outer * zz)) |
                     (slanted & p_less_equal(off, around * around)) | (all & ~regular & ~slanted))
                 << j;
        if (!tile->any) continue;
        P far = cross + apart, more = p_max(between + beside, zero), inside = rim - apart;
        P inner = p_less_fused(far, far, square), within = p_max(inside, zero);
        sure |= (p_less(zero, inner) & ((regular & p_less(more * more, inner * zz)) |
                                           (slanted & p_less(off, within * within))))
                << j;
    }
    return solid_between(tile, solids, lane, nearest, packet, maybe, sure);
}

/* Of any other shape nothing is known. */
static inline Verdict small_verdict(
    const Tile *tile, GiShapeRef ref, const Solids *solids, int lane, float nearest, int packet) {
    GiShapeKind kind = gi_shape_kind(ref);
    if (kind >= SOLID_KINDS || solid_is_vast(solids, lane)) return (Verdict){0xffff, 0};
    switch (kind) {
    case GI_SHAPE_SPHERE: return small_sphere(tile, solids, lane, nearest, packet);
    case GI_SHAPE_BOX: return small_box(tile, solids, lane, nearest, packet);
    default:
        return small_cone(
            tile, &tile->shapes->cones[gi_shape_index(ref)], solids, lane, nearest, packet);
    }
}
