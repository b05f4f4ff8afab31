/* SPDX-License-Identifier: MIT
 * The shapes of a leaf as the rays of a bundle see them, eight at a time, and what sixteen rays
 * possibly or certainly meet of one, in single precision. Part of kernel.c.
 *
 * A sphere or a box is seen as two: one that certainly holds it, and one that it certainly holds. A
 * ray that passes by the first misses the shape; one through the second meets it, and where it ends
 * far enough behind, that is all a shadow ray needs to know. Only for the rays between does the
 * exact test of `any` decide. For closest it has to give t anyhow, but is spared those that pass
 * by.
 *
 * How far apart the two are. In the tree a shape is grown by 2^-19 of its largest distance from the
 * centre; the inner one is smaller by four times that, and both allow for the apex by `margin`.
 * What is computed here errs by roundings e = 2^-24: a vector c along u, v, w by six of |c|, as the
 * axes are rounded too; a and b by four each. So a component of (a, b, 1) x c errs by less than 12
 * e |c| (1 + |a| + |b|), and the distance of line and centre, which is the length of that product
 * over the length of (a, b, 1), by less than 36 e |c|: the slack of spheres is 64 e |c|. A
 * component of (a, b, 1) along an axis of the tree errs by less than 20 e, as |a|, |b| < 2.3; so a
 * point at depth z of the line by 20 e z, and no z of a box is more than twice its largest
 * coordinate, `reach`: the slack of boxes is 128 e of that. Squares and quotients add a few
 * roundings of their own, for which there are factors of 16 e. */
#pragma once

/* ---------------------------------------------------------------- rectangles */

/* Eight shapes as rectangles in the plane of the packets, with their nearest depth. */
typedef struct Rectangles {
    float a0[8], a1[8], b0[8], b1[8], near[8];
} Rectangles;

/* From where to where shapes reach along u, v, w. */
typedef struct Reach {
    F x0, x1, y0, y1, z0, z1;
} Reach;

static inline Reach reach_of(const F center[3], const F extent[3]) {
    return (Reach){center[0] - extent[0], center[0] + extent[0], center[1] - extent[1],
        center[1] + extent[1], center[2] - extent[2], center[2] + extent[2]};
}

/* As rectangles_of, of bundles whose rays are parallel. */
static inline unsigned rectangles_across(
    const Frustum *frustum, int i, const Reach *reach, F wider, Rectangles *rectangles) {
    F a0 = reach->x0 - wider, a1 = reach->x1 + wider, b0 = reach->y0 - wider;
    F b1 = reach->y1 + wider, near = reach->z0 - wider;
    f_store(rectangles->a0 + i, a0);
    f_store(rectangles->a1 + i, a1);
    f_store(rectangles->b0 + i, b0);
    f_store(rectangles->b1 + i, b1);
    f_store(rectangles->near + i, near);
    return (f_less_equal(a0, f_of(frustum->a1)) & f_less_equal(f_of(frustum->a0), a1) &
               f_less_equal(b0, f_of(frustum->b1)) & f_less_equal(f_of(frustum->b0), b1) &
               f_less_equal(near, f_of(frustum->far)))
           << i;
}

/* (x, y) / z over all z of a shape, which is farthest out at the nearest or the farthest z. A
 * shape that reaches the apex' own plane covers everything. Returns the bits of those that may
 * concern the tile. */
static inline unsigned rectangles_of(
    const Frustum *frustum, int i, const Reach *reach, Rectangles *rectangles) {
    const F x0 = reach->x0, x1 = reach->x1, y0 = reach->y0, y1 = reach->y1;
    const F z0 = reach->z0, z1 = reach->z1, one = f_of(1);
    if (frustum->parallel) {
        return rectangles_across(frustum, i, reach, f_of(GI_PARALLEL_WIDER), rectangles);
    }
    F near_scale = one / z0, far_scale = one / z1;
    F a0 = f_min(x0 * near_scale, x0 * far_scale), a1 = f_max(x1 * near_scale, x1 * far_scale);
    F b0 = f_min(y0 * near_scale, y0 * far_scale), b1 = f_max(y1 * near_scale, y1 * far_scale);
    /* Rays have |a|, |b| < 2.3 (tile_packets), so this is more than their rounding. */
    F wider = f_of(4 * GI_WIDER);
    a0 = a0 - wider;
    a1 = a1 + wider;
    b0 = b0 - wider;
    b1 = b1 + wider;
    f_store(rectangles->a0 + i, a0);
    f_store(rectangles->a1 + i, a1);
    f_store(rectangles->b0 + i, b0);
    f_store(rectangles->b1 + i, b1);
    f_store(rectangles->near + i, z0);
    unsigned reaching = f_less_equal(z0, f_of(frustum->far)) & f_less_equal(f_of(0), z1);
    unsigned around = reaching & f_less_equal(z0, f_of(frustum->margin));
    unsigned in = f_less_equal(a0, f_of(frustum->a1)) & f_less_equal(f_of(frustum->a0), a1) &
                  f_less_equal(b0, f_of(frustum->b1)) & f_less_equal(f_of(frustum->b0), b1);
    for (unsigned bits = around; bits != 0; bits &= bits - 1) {
        int lane = i + lowest_bit(bits);
        rectangles->a0[lane] = rectangles->b0[lane] = rectangles->near[lane] = -INFINITY;
        rectangles->a1[lane] = rectangles->b1[lane] = INFINITY;
    }
    return ((in & reaching) | around) << i;
}

/* The smallest and the largest value of p . n over boxes. */
static inline F smallest_dot(const float n[3], const F low[3], const F high[3]) {
    return frame_dot(
        n, (n[0] >= 0 ? low : high)[0], (n[1] >= 0 ? low : high)[1], (n[2] >= 0 ? low : high)[2]);
}

static inline F largest_dot(const float n[3], const F low[3], const F high[3]) {
    return smallest_dot(n, high, low);
}

/* A node's children. */
static inline unsigned tile_children(
    const Frustum *frustum, const GiNode *node, Rectangles *rectangles) {
    unsigned bits = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        F low[3], high[3];
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = f_load(node->low[axis] + i) - f_of(frustum->apex[axis] + frustum->margin);
            high[axis] = f_load(node->high[axis] + i) - f_of(frustum->apex[axis] - frustum->margin);
        }
        const float(*axes)[3] = frustum->axis;
        const Reach reach = {smallest_dot(axes[0], low, high), largest_dot(axes[0], low, high),
            smallest_dot(axes[1], low, high), largest_dot(axes[1], low, high),
            smallest_dot(axes[2], low, high), largest_dot(axes[2], low, high)};
        bits |= rectangles_of(frustum, i, &reach, rectangles);
    }
    return bits;
}

/* Eight shapes of any kind by their boxes, relative to the apex. */
typedef struct Solids {
    float center[3][8], half[3][8]; /* along the axes of the tree, half extents not grown */
    float seen[3][8];               /* the centre along u, v, w */
    float end[8];                   /* nothing of the shape is deeper */
    float reach[8], lost[8];        /* L and `lost` of solid.h */
} Solids;

/* Rectangles are those of boxes that are grown, as the tree has them. Of solids the growth is taken
 * back. */
static inline unsigned tile_boxes(
    const Frustum *frustum, const GiBoxBlock *block, Rectangles *rectangles, Solids *solids) {
    unsigned bits = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        F middle[3], half[3], center[3], extent[3], largest = f_of(0), reach = f_of(0);
        for (int axis = 0; axis < 3; axis++) {
            F low = f_load(block->low[axis] + i), high = f_load(block->high[axis] + i);
            middle[axis] = (low + high) * f_of(0.5f) - f_of(frustum->apex[axis]);
            half[axis] = (high - low) * f_of(0.5f);
            largest = f_max(largest, f_max(f_size(low), f_size(high)));
            reach = f_max(reach, f_size(middle[axis]) + half[axis]);
        }
        const F least = f_of((float)GI_TREE_GROWTH_LEAST);
        F growth = f_fused(largest, f_of((float)GI_TREE_GROWTH), least);
        F lost = f_fused(largest, f_of(0x1p-22f), least + f_of(frustum->margin * 0x1p-3f));
        lost = lost + f_of(frustum->lost);
        for (int axis = 0; axis < 3; axis++) {
            f_store(solids->center[axis] + i, middle[axis]);
            f_store(solids->half[axis] + i, half[axis] - growth);
            half[axis] = half[axis] + f_of(frustum->margin);
        }
        for (int row = 0; row < 3; row++) {
            const float *n = frustum->axis[row];
            const float(*size)[8] = frustum->extent[row];
            center[row] = frame_dot(n, middle[0], middle[1], middle[2]);
            extent[row] = f_by_kind(size[2], block->shape + i) * half[2];
            extent[row] = f_fused(f_by_kind(size[1], block->shape + i), half[1], extent[row]);
            extent[row] = f_fused(f_by_kind(size[0], block->shape + i), half[0], extent[row]);
            f_store(solids->seen[row] + i, center[row]);
        }
        f_store(solids->end + i, center[2] + extent[2] + lost * f_of(2));
        f_store(solids->reach + i, reach);
        f_store(solids->lost + i, lost);
        const Reach seen = reach_of(center, extent);
        bits |= rectangles_of(frustum, i, &seen, rectangles);
    }
    return bits;
}

/* Bits of those rectangles that have less than this area. */
static inline unsigned rectangles_below(const Rectangles *rectangles, float area) {
    unsigned bits = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        F width = f_load(rectangles->a1 + i) - f_load(rectangles->a0 + i);
        F height = f_load(rectangles->b1 + i) - f_load(rectangles->b0 + i);
        bits |= f_less(width * height, f_of(area)) << i;
    }
    return bits;
}

/* Of the groups, bits of those that one shape may concern. */
static inline unsigned groups_overlaps(const Groups *groups, const Rectangles *shapes, int lane) {
    const F a0 = f_of(shapes->a0[lane]), a1 = f_of(shapes->a1[lane]), b0 = f_of(shapes->b0[lane]),
            b1 = f_of(shapes->b1[lane]), near = f_of(shapes->near[lane]);
    unsigned bits = 0;
    for (int g = 0; g < GROUP_COUNT; g += GI_FLOATS) {
        bits |=
            (f_less_equal(a0, f_load(groups->a1 + g)) & f_less_equal(f_load(groups->a0 + g), a1) &
                f_less_equal(b0, f_load(groups->b1 + g)) &
                f_less_equal(f_load(groups->b0 + g), b1) &
                f_less_equal(near, f_load(groups->far + g)))
            << g;
    }
    return bits;
}

/* Of the sixteen packets from `first` on, bits of those that the rectangle of one shape overlaps,
 * nearer than they look. */
static inline unsigned tile_overlaps(
    const Packets *packets, const Rectangles *shapes, int lane, int first) {
    return sixteen_from(shapes->a0[lane], packets->a1 + first) &
           sixteen_up_to(shapes->a1[lane], packets->a0 + first) &
           sixteen_from(shapes->b0[lane], packets->b1 + first) &
           sixteen_up_to(shapes->b1[lane], packets->b0 + first) &
           sixteen_from(shapes->near[lane], packets->far + first);
}

/* Bits of the rays of one packet that lie in the rectangle and end behind its nearest point. */
static inline unsigned tile_rays(const Tile *tile, const Rectangles *shapes, int lane, int packet) {
    int i = packet * GI_PACKET_SIZE;
    return tile->alive[packet] & sixteen_from(shapes->a0[lane], tile->a + i) &
           sixteen_up_to(shapes->a1[lane], tile->a + i) &
           sixteen_from(shapes->b0[lane], tile->b + i) &
           sixteen_up_to(shapes->b1[lane], tile->b + i) &
           sixteen_from(shapes->near[lane], tile->far + i);
}

/* ---------------------------------------------------------------- what is certain */

/* Sixteen rays and a shape: bits of those that possibly meet it, and of those that certainly do. */
typedef struct Verdict {
    unsigned maybe, sure;
} Verdict;

/* Of `any`: these rays meet the shape, and look for nothing more. */
static inline void take_sure(Tile *tile, GiShapeRef ref, int packet, unsigned rays) {
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_WIDEST) {
        p_fill_where(tile->bundle->shape + packet * GI_PACKET_SIZE + j, rays >> j, ref.bits);
    }
    packet_stop(tile, packet, rays);
}

/* Takes what is certain, which is asked for `any` alone. Returns the bits of rays about which
 * doubles have to decide. Nearly without a branch: whether there are such rays cannot be foretold.
 */
static inline unsigned take_certain(Tile *tile, GiShapeRef ref, int packet, Verdict verdict) {
    unsigned maybe = verdict.maybe & tile->alive[packet];
    if (!tile->any) return maybe;
    maybe &= ~spared_by(tile, ref, packet);
    unsigned sure = verdict.sure & maybe;
    take_sure(tile, ref, packet, sure);
    return maybe & ~sure;
}

/* ---------------------------------------------------------------- boxes */

/* A box, relative to the apex, by what a ray's components are multiplied with to give 1 / depth: of
 * the planes it enters through, to which `offset` is added, and of those it leaves through. */
typedef struct BoxPlanes {
    float enter[3], offset[3], leave[2][3];
} BoxPlanes;

/* Grown by so much on all sides. One without an inside is never met; of one round the apex the
 * entrance is infinitely near. */
static inline BoxPlanes box_planes(const float low[3], const float high[3], float grow) {
    BoxPlanes planes;
    const float least = 0x1p-60f;
    for (int axis = 0; axis < 3; axis++) {
        float from = low[axis] - grow, to = high[axis] + grow;
        bool full = from < to;
        bool before = least < from, behind = to < -least;
        if (fabsf(from) < least) from = -least;
        if (fabsf(to) < least) to = least;
        planes.enter[axis] = !full ? 0 : before ? 1 / from : behind ? 1 / to : 0;
        planes.offset[axis] = !full ? -INFINITY : before || behind ? 0 : INFINITY;
        planes.leave[0][axis] = 1 / (before ? to : from);
        planes.leave[1][axis] = 1 / (behind ? from : to);
    }
    return planes;
}

/* Bits of the rays whose lines are in the box, and 1 / depth of where they enter. */
static inline unsigned box_meets(const BoxPlanes *planes, const P d[3], P *near) {
    P enter = p_fused(d[0], p_of(planes->enter[0]), p_of(planes->offset[0])), leave = p_of(0);
    for (int axis = 0; axis < 3; axis++) {
        P plane = p_fused(d[axis], p_of(planes->enter[axis]), p_of(planes->offset[axis]));
        enter = p_min(enter, plane);
        leave = p_max(leave,
            p_max(d[axis] * p_of(planes->leave[0][axis]), d[axis] * p_of(planes->leave[1][axis])));
    }
    *near = enter;
    return p_less_equal(leave, enter);
}

/* Those of a block that are boxes and large, so that it pays. */
typedef struct Boxes {
    BoxPlanes outer[8], inner[8];
} Boxes;

/* Bits of the shapes that it may pay for: a floor, not what is small and seen by few packets. */
static inline unsigned tile_wide(const Frustum *frustum, const Rectangles *shapes) {
    const F width = f_of((frustum->a1 - frustum->a0) / 2),
            height = f_of((frustum->b1 - frustum->b0) / 2);
    unsigned bits = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        bits |= (f_less(width, f_load(shapes->a1 + i) - f_load(shapes->a0 + i)) &
                    f_less(height, f_load(shapes->b1 + i) - f_load(shapes->b0 + i)))
                << i;
    }
    return bits;
}

static inline float larger(float a, float b) { return a > b ? a : b; }

static inline void boxes_look(
    const Tile *tile, const GiBoxBlock *block, int lane, float near, Boxes *boxes) {
    const Frustum *frustum = &tile->frustum;
    float low[3], high[3], largest = 0, reach = 0;
    for (int axis = 0; axis < 3; axis++) {
        float from = block->low[axis][lane], to = block->high[axis][lane];
        largest = larger(largest, larger(fabsf(from), fabsf(to)));
        low[axis] = from - frustum->apex[axis];
        high[axis] = to - frustum->apex[axis];
        reach = larger(reach, larger(fabsf(low[axis]), fabsf(high[axis])));
    }
    float slack = frustum->margin + reach * 0x1p-17f;
    float growth = largest * 0x1p-19f + 0x1p-40f;
    boxes->outer[lane] = box_planes(low, high, slack);
    boxes->inner[lane] = box_planes(low, high, -slack - 2 * growth);
    /* Nothing is certain of what may lie before the beginning, or of boxes without exits, where it
     * matters which end the ray starts from. */
    bool clear = frustum->start <= near && !tile->shapes->entering_only;
    if (!clear) boxes->inner[lane].offset[0] = -INFINITY;
}

static inline Verdict box_verdict(const Tile *tile, const Boxes *boxes, int lane, int packet) {
    const Frustum *frustum = &tile->frustum;
    Verdict verdict = {0, 0};
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_WIDEST) {
        int i = packet * GI_PACKET_SIZE + j;
        P a = p_load(tile->a + i), b = p_load(tile->b + i), d[3], near;
        for (int k = 0; k < 3; k++) {
            d[k] = p_fused(a, p_of(frustum->axis[0][k]),
                p_fused(b, p_of(frustum->axis[1][k]), p_of(frustum->axis[2][k])));
        }
        unsigned maybe = box_meets(&boxes->outer[lane], d, &near);
        maybe &= p_less_equal(p_of(1 - GI_WIDER), near * p_load(tile->far + i));
        verdict.maybe |= maybe << j;
        if (!tile->any || maybe == 0) continue;
        unsigned sure = box_meets(&boxes->inner[lane], d, &near);
        sure &= p_less(p_of(1 + GI_WIDER), near * p_load(tile->surely + i));
        verdict.sure |= sure << j;
    }
    return verdict;
}

/* ---------------------------------------------------------------- spheres */

/* A sphere, relative to the apex along u, v, w, by its centre and the squares of two radii: of one
 * that holds the sphere, and of one that is held by it. */
typedef struct Ball {
    float x, y, z, outer, inner;
} Ball;

/* Eight of them. */
typedef struct Spheres {
    float x[8], y[8], z[8], outer[8], inner[8];
} Spheres;

static inline unsigned tile_spheres(
    const Frustum *frustum, const GiSphereBlock *block, Rectangles *rectangles, Spheres *spheres) {
    unsigned bits = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        F x = f_load(block->center[0] + i), y = f_load(block->center[1] + i),
          z = f_load(block->center[2] + i), radius = f_load(block->radius + i);
        F margin = f_of(frustum->margin), wide = radius + margin;
        F growth = f_max(f_size(x), f_max(f_size(y), f_size(z))) + radius;
        x = x - f_of(frustum->apex[0]);
        y = y - f_of(frustum->apex[1]);
        z = z - f_of(frustum->apex[2]);
        F center[3];
        for (int row = 0; row < 3; row++) center[row] = frame_dot(frustum->axis[row], x, y, z);
        const F extent[3] = {wide, wide, wide};
        const Reach reach = reach_of(center, extent);
        unsigned in = rectangles_of(frustum, i, &reach, rectangles);
        bits |= in;
        F slack = (f_size(center[0]) + f_size(center[1]) + f_size(center[2])) * f_of(0x1p-18f);
        F outer = (wide + slack) * f_of(1 + 0x1p-20f);
        F inner = radius - margin - slack - growth * f_of(0x1p-17f) - f_of(0x1p-38f);
        inner = f_max(inner, f_of(0)) * f_of(1 - 0x1p-20f);
        f_store(spheres->x + i, center[0]);
        f_store(spheres->y + i, center[1]);
        f_store(spheres->z + i, center[2]);
        f_store(spheres->outer + i, outer * outer);
        f_store(spheres->inner + i, inner * inner - f_of(0x1p-100f));
        /* Out of the range of squares everything is possible. */
        unsigned vast = in >> i & ~f_less_equal(outer + slack, f_of(0x1p40f));
        for (; vast != 0; vast &= vast - 1) {
            int lane = i + lowest_bit(vast);
            spheres->x[lane] = spheres->y[lane] = spheres->z[lane] = 0;
            spheres->outer[lane] = INFINITY;
            spheres->inner[lane] = -1;
        }
    }
    return bits;
}

static inline Verdict sphere_verdict(
    const Tile *tile, bool any, const Ball *ball, float nearest, int packet) {
    const P x = p_of(ball->x), y = p_of(ball->y), z = p_of(ball->z);
    const P outer = p_of(ball->outer), near = p_of(nearest);
    /* Nothing is certain of what may lie before the beginning. */
    const P inner = p_of(tile->frustum.start <= nearest ? ball->inner : -1);
    Verdict verdict = {0, 0};
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_WIDEST) {
        int i = packet * GI_PACKET_SIZE + j;
        P a = p_load(tile->a + i), b = p_load(tile->b + i);
        P cross_x = p_less_fused(b, z, y), cross_y = p_less_fused(a, z, x);
        P cross_z = p_less_fused(b, x, a * y);
        P apart = p_fused(cross_x, cross_x, p_fused(cross_y, cross_y, cross_z * cross_z));
        P square = p_fused(a, a, p_fused(b, b, p_of(1)));
        unsigned maybe =
            p_less_equal(apart, square * outer) & p_less_equal(near, p_load(tile->far + i));
        verdict.maybe |= maybe << j;
        if (!any) continue;
        /* It is met before the point of closest approach, whose depth is along / square. */
        P along = p_fused(a, x, p_fused(b, y, z));
        unsigned sure = p_less_equal(apart, square * inner) &
                        p_less(along * p_of(1 + 0x1p-18f), square * p_load(tile->surely + i));
        verdict.sure |= sure << j;
    }
    return verdict;
}
