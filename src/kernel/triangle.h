/* SPDX-License-Identifier: MIT
 * The triangles of a leaf as the rays of a bundle see them: which rays certainly pass by, which
 * certainly meet one and between which depths, and which the exact test has to decide about. Part
 * of kernel.c.
 *
 * In the plane of the packets a triangle is its edges' lines. A ray on the inner side of all three
 * by more than `slack` is inside, one on the outer side of an edge by more than that is not. Over
 * the triangle 1 / depth is linear in (a, b), since it is so along every line in the plane:
 *
 *     1 / depth = w0 + (side 2 / all) (w1 - w0) + (side 0 / all) (w2 - w0)
 *
 * where w is that of a corner, side 2 and side 0 are the values of the edges opposite to the
 * corners 1 and 2, and `all` is the sum of the three sides. `blur` is what this errs by. A side
 * errs by less than the slack, `all` by three times that, hence a quotient q by less than (1 + 3
 * |q|) slack / (all - 3 slack), which is less than 9 slack / all when all > 7 slack; else q itself,
 * which is at most 1 + 2 slack / all for rays not certainly outside, is no more than 9 slack / all.
 * The depth of a corner errs by less than 16 roundings of (1 + m) depth, and by `error` for the
 * apex (see tile_triangles); a mean of such by no more than the worst of them.
 *
 * So a camera ray that is certainly inside, and certainly before all it has met so far, takes the
 * triangle without an exact test. How far it is then known as an interval, and t stays open until
 * another shape comes so near that it matters (tile_settle), or to the end. */
#pragma once

/* The edges of eight triangles in the plane of the packets, and 1 / depth over them. */
typedef struct Edges {
    float x[3][8], y[3][8], z[3][8], slack[8];
    float closeness[3][8], blur[8]; /* closeness: factors of a and b, and the rest */
    unsigned left;                  /* bits of those that rays leave without meeting them again */
} Edges;

/* Bits of those of GI_FLOATS triangles, from i on, that a ray does not meet again which begins on
 * them, as GI_LEFT has it, and goes to the apex: those that are not too narrow as seen from there.
 * Why, with the rounding e = 2^-53: such a ray begins at P, a mean of the corners with weights,
 * less than 14 e size off the plane, where size is the largest of the corners' numbers; and it
 * looks from 2^-42 size = 2048 e size on. Let |d| = 1, D be the triangle's diameter and A its area
 * across the ray. The exact test errs by less than 3 e D in a component of d x (corner - P), 11 e
 * D^2 in a weight, 31 e D^3 in the sum of weights * depths, hence 27 e D^3 / A + 5 e D in t, as the
 * weights are more than 2 A / sqrt(3) together; and P's distance from the plane makes less than 14
 * e size (0.44 D^2 / A) of t. D is less than 3.5 size. So if D^2 / A < 19 the triangle is found at
 * less than 1950 e size, before the ray begins.
 *     twice: twice the area in the plane of the packets, at least; product: of the three depths;
 *     error: of a corner's place. */
static inline unsigned triangles_left(float corners[3][3][8], int i, F twice, F product, F error) {
    F diameter = f_of(0), reach = f_of(0); /* squared, of the triangle and from the apex */
    for (int k = 0; k < 3; k++) {
        F side = f_of(0), distance = f_of(0);
        for (int axis = 0; axis < 3; axis++) {
            F x = f_load(corners[k][axis] + i);
            F d = x - f_load(corners[(k + 1) % 3][axis] + i);
            side = f_fused(d, d, side);
            distance = f_fused(x, x, distance);
        }
        diameter = f_max(diameter, side);
        reach = f_max(reach, distance);
    }
    /* (D + 2 error)^2 < 1.25 D^2 + 20 error^2; 2 / 19 of that, and 6 % for the roundings. */
    F least = f_of(0.14f) * diameter + f_of(2.3f) * error * error, most = twice * product;
    /* The squares are within the range of floats. */
    return f_less_equal(reach * least * least, most * most) & f_less(f_of(0), twice) &
           f_less(f_of(0x1p-50f), least) & f_less(most, f_of(0x1p50f));
}

/* The places of corners: (a, b) = (x, y) / depth. A corner r away, in single precision, errs by six
 * roundings of r in each of x, y and depth, so that with |a|, |b| <= m its place errs by less than
 * 10 roundings of (1 + m)^2, and by `error` (1 + m) / depth for the apex. Rectangles are widened by
 * 16, which is enough for the four of a ray's own place too. */
static inline unsigned tile_triangles(const Frustum *frustum, const GiTriangles *triangles,
    uint32_t first, uint32_t count, bool any, Rectangles *rectangles, Edges *edges) {
    float corners[3][3][8];
    seen_corners(&frustum->seen, triangles, first, count, corners);
    unsigned bits = 0;
    edges->left = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        F a[3], b[3], depth[3], closeness[3], one = f_of(1), most = f_of(0);
        for (int k = 0; k < 3; k++) {
            F x = f_load(corners[k][0] + i), y = f_load(corners[k][1] + i),
              z = f_load(corners[k][2] + i);
            depth[k] = frame_dot(frustum->axis[2], x, y, z);
            closeness[k] = one / depth[k];
            a[k] = frame_dot(frustum->axis[0], x, y, z) * closeness[k];
            b[k] = frame_dot(frustum->axis[1], x, y, z) * closeness[k];
            most = f_max(most, f_max(f_size(a[k]), f_size(b[k])));
        }
        F nearest = f_min(depth[0], f_min(depth[1], depth[2]));
        F error = f_of(frustum->seen.error), bigger = one + most;
        F wider = (f_of(GI_WIDER) * bigger + error / nearest) * bigger;
        F a0 = f_min(a[0], f_min(a[1], a[2])) - wider, a1 = f_max(a[0], f_max(a[1], a[2])) + wider;
        F b0 = f_min(b[0], f_min(b[1], b[2])) - wider, b1 = f_max(b[0], f_max(b[1], b[2])) + wider;
        /* Six roundings of the distance, which is at most (1 + 2 m) times the depth. */
        F near = nearest - f_of(GI_WIDER) * bigger * nearest - error;
        f_store(rectangles->a0 + i, a0);
        f_store(rectangles->a1 + i, a1);
        f_store(rectangles->b0 + i, b0);
        f_store(rectangles->b1 + i, b1);
        f_store(rectangles->near + i, near);
        F slack = f_of(4) * wider * ((a1 - a0) + (b1 - b0) + wider);
        f_store(edges->slack + i, slack);
        F x[3], y[3], z[3];
        for (int k = 0; k < 3; k++) {
            int next = (k + 1) % 3;
            x[k] = b[k] - b[next];
            y[k] = a[next] - a[k];
            z[k] = f_of(0) - (x[k] * a[k] + y[k] * b[k]);
            f_store(edges->x[k] + i, x[k]);
            f_store(edges->y[k] + i, y[k]);
            f_store(edges->z[k] + i, z[k]);
        }
        F twice = x[2] * y[0] - x[0] * y[2], part = one / twice;
        F first_slope = (closeness[1] - closeness[0]) * part;
        F second_slope = (closeness[2] - closeness[0]) * part;
        F closest = f_max(closeness[0], f_max(closeness[1], closeness[2]));
        F blur = closest * (f_of(4 * GI_WIDER) * bigger + f_of(2) * error * closest);
        blur = f_fused(f_of(16) * slack, f_size(first_slope) + f_size(second_slope), blur);
        f_store(edges->closeness[0] + i, f_fused(x[2], first_slope, x[0] * second_slope));
        f_store(edges->closeness[1] + i, f_fused(y[2], first_slope, y[0] * second_slope));
        f_store(edges->closeness[2] + i,
            f_fused(z[2], first_slope, f_fused(z[0], second_slope, closeness[0])));
        f_store(edges->blur + i, blur);
        if (any) {
            F product = depth[0] * depth[1] * depth[2];
            F deepest = f_max(depth[0], f_max(depth[1], depth[2]));
            F place = f_of(GI_WIDER) * bigger * deepest + error;
            F least = f_size(twice) - f_of(4) * slack;
            edges->left |= (triangles_left(corners, i, least, product, place) &
                               f_less_equal(f_of(64) * error, nearest))
                           << i;
        }
        /* What reaches behind the apex, or is far off to the side, is not in the plane. */
        unsigned all = (1u << GI_FLOATS) - 1;
        unsigned whole = f_less_equal(f_of(4) * error, nearest) &
                         f_less_equal(f_of(0x1p-100f), nearest) & /* so that quotients are finite */
                         f_less_equal(most, f_of(4096));
        unsigned in = f_less_equal(a0, f_of(frustum->a1)) & f_less_equal(f_of(frustum->a0), a1) &
                      f_less_equal(b0, f_of(frustum->b1)) & f_less_equal(f_of(frustum->b0), b1) &
                      f_less_equal(near, f_of(frustum->far));
        unsigned around = ~whole & all;
        for (unsigned rest = around; rest != 0; rest &= rest - 1) {
            int lane = i + lowest_bit(rest);
            rectangles->a0[lane] = rectangles->b0[lane] = rectangles->near[lane] = -INFINITY;
            rectangles->a1[lane] = rectangles->b1[lane] = INFINITY;
            edges->slack[lane] = edges->blur[lane] = INFINITY;
            for (int k = 0; k < 3; k++) {
                edges->x[k][lane] = edges->y[k][lane] = edges->z[k][lane] = 0;
                edges->closeness[k][lane] = 0;
            }
        }
        bits |= ((in & whole) | around) << i;
    }
    return bits & ((1u << count) - 1);
}

/* The rectangle round eight triangles, in lane 0. */
static inline Rectangles rectangle_around(const Rectangles *rectangles) {
    Rectangles around;
    around.a0[0] = f_lowest(rectangles->a0, 8);
    around.a1[0] = f_highest(rectangles->a1, 8);
    around.b0[0] = f_lowest(rectangles->b0, 8);
    around.b1[0] = f_highest(rectangles->b1, 8);
    around.near[0] = f_lowest(rectangles->near, 8);
    return around;
}

/* Bits of those of eight triangles that one ray does not certainly pass by or end before. */
static inline unsigned triangles_near(
    const Tile *tile, const Rectangles *rectangles, const Edges *edges, int ray) {
    const F a = f_of(tile->a[ray]), b = f_of(tile->b[ray]), far = f_of(tile->far[ray]);
    unsigned bits = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        F slack = f_load(edges->slack + i), side[3];
        for (int k = 0; k < 3; k++) {
            side[k] = f_fused(f_load(edges->x[k] + i), a,
                f_fused(f_load(edges->y[k] + i), b, f_load(edges->z[k] + i)));
        }
        F least = f_min(side[0], f_min(side[1], side[2]));
        F most = f_max(side[0], f_max(side[1], side[2]));
        bits |= ((f_less_equal(f_of(0) - slack, least) | f_less_equal(most, slack)) &
                    f_less_equal(f_load(rectangles->near + i), far))
                << i;
    }
    return bits;
}

/* 1 / depth of a triangle at the rays of a packet. */
typedef struct Closeness {
    P of[GI_PACKET_SIZE / GI_WIDEST];
} Closeness;

/* The least and the greatest of the values that a triangle's edges have at some rays. */
static inline void edges_sides(const Edges *edges, int lane, P a, P b, P *least, P *most) {
    P side[3];
    for (int k = 0; k < 3; k++) {
        side[k] = p_fused(p_of(edges->x[k][lane]), a,
            p_fused(p_of(edges->y[k][lane]), b, p_of(edges->z[k][lane])));
    }
    *least = p_min(side[0], p_min(side[1], side[2]));
    *most = p_max(side[0], p_max(side[1], side[2]));
}

/* What is certain of one triangle and the rays of one packet. */
static inline Verdict triangle_verdict(const Tile *tile, const Rectangles *rectangles,
    const Edges *edges, int lane, int packet, Closeness *closeness) {
    const P near = p_of(rectangles->near[lane]), blur = p_of(edges->blur[lane]);
    const P slack = p_of(edges->slack[lane]), zero = p_of(0);
    /* Nothing is certain of what may lie before the beginning. */
    const bool clear = tile->frustum.start <= rectangles->near[lane];
    Verdict verdict = {0, 0};
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_WIDEST) {
        int i = packet * GI_PACKET_SIZE + j;
        P a = p_load(tile->a + i), b = p_load(tile->b + i), least, most;
        edges_sides(edges, lane, a, b, &least, &most);
        unsigned maybe = p_less_equal(zero - slack, least) | p_less_equal(most, slack);
        unsigned sure = p_less(slack, least) | p_less(most, zero - slack);
        P close = p_fused(p_of(edges->closeness[0][lane]), a,
            p_fused(p_of(edges->closeness[1][lane]), b, p_of(edges->closeness[2][lane])));
        P far = p_load(tile->far + i);
        maybe &= p_less_equal(near, far) & ~p_less((close + blur) * far, p_of(1 - GI_WIDER));
        sure &= p_less(p_of(1 + GI_WIDER), (close - blur) * p_load(tile->surely + i)) &
                p_less(blur + blur, close);
        closeness->of[j / GI_WIDEST] = close;
        verdict.maybe |= maybe << j;
        verdict.sure |= sure << j;
    }
    verdict.maybe &= tile->alive[packet];
    verdict.sure &= clear ? verdict.maybe : 0;
    return verdict;
}

/* These rays of a packet have come to a triangle that is certainly nearer than anything so far. */
static inline void take_triangle(
    Tile *tile, GiShapeRef ref, int packet, unsigned rays, const Closeness *closeness, float blur) {
    GiBundle *bundle = tile->bundle;
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_WIDEST) {
        int i = packet * GI_PACKET_SIZE + j;
        unsigned bits = rays >> j;
        /* For e < 1/2: 1 / (1 - e) < 1 + 2 e, and 1 / (1 + e) > 1 - e. */
        P depth = p_of(1) / closeness->of[j / GI_WIDEST], e = depth * p_of(blur);
        p_store_where(tile->far + i, bits, depth * (p_of(1 + 4 * GI_WIDER) + e + e));
        p_store_where(tile->surely + i, bits, depth * (p_of(1 - 4 * GI_WIDER) - e));
        p_fill_where(bundle->shape + i, bits, ref.bits);
        p_fill_where(bundle->instance + i, bits, tile->instance);
    }
    tile->open[packet] |= rays;
    tile->nearer[packet / 32] |= 1u << packet % 32;
}

/* Bits of the rays of a packet that begin on this triangle and leave it. */
static inline unsigned tile_leaving(const Tile *tile, GiShapeRef ref, int packet) {
    const GiBundle *bundle = tile->bundle;
    unsigned begin = sixteen_equal(ref.bits, bundle->skip + packet * GI_PACKET_SIZE);
    if (begin == 0 || tile->instance != GI_SHAPE_NONE) return 0;
    return begin & sixteen_equal(GI_LEFT, bundle->skip_instance + packet * GI_PACKET_SIZE);
}

/* Takes what is certain. Returns the bits of rays about which doubles have to decide. */
static inline unsigned tile_rays_at(Tile *tile, GiShapeRef ref, const Rectangles *rectangles,
    const Edges *edges, int lane, int packet) {
    Closeness closeness;
    Verdict verdict = triangle_verdict(tile, rectangles, edges, lane, packet, &closeness);
    tile->taken += verdict.sure != 0;
    if (tile->any) {
        if (edges->left >> lane & 1) verdict.maybe &= ~tile_leaving(tile, ref, packet);
        return take_certain(tile, ref, packet, verdict);
    }
    if (verdict.sure != 0) {
        take_triangle(tile, ref, packet, verdict.sure, &closeness, edges->blur[lane]);
    }
    return verdict.maybe & ~verdict.sure;
}
