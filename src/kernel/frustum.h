/* SPDX-License-Identifier: MIT
 * A bundle of rays as a frustum: its frame and planes, its packets as rectangles, and what of the
 * tree may concern them. Part of kernel.c; bundle.h tells the whole story. */
#pragma once

/* Sixteen roundings: what rays as points, and depths, are widened by. */
#define GI_WIDER 0x1p-20f

typedef struct Packets {
    /* Rectangle, widened; farthest depth that matters, negative when no ray is left. */
    float a0[GI_PACKET_COUNT], a1[GI_PACKET_COUNT], b0[GI_PACKET_COUNT], b1[GI_PACKET_COUNT];
    float far[GI_PACKET_COUNT];
} Packets;

/* The same of sixteen packets in a row: few shapes concern more than one or two of the groups. */
enum { GROUP_SIZE = 16, GROUP_COUNT = GI_PACKET_COUNT / GROUP_SIZE };
typedef struct Groups {
    float a0[GROUP_COUNT], a1[GROUP_COUNT], b0[GROUP_COUNT], b1[GROUP_COUNT], far[GROUP_COUNT];
} Groups;

typedef struct Frustum {
    float apex[3], margin;
    float axis[3][3]; /* u, v, w as rows */
    float plane[4][3];
    float a0, a1, b0, b1, far;
    SeenFrom seen; /* triangles, from the apex */
} Frustum;

/* One shape to be tested against some rays of one packet. */
typedef struct Test {
    GiShapeRef shape;
    uint32_t packet, rays;
} Test;

/* As many tests as come together before they are made: their shapes have the time to arrive from
 * memory, and what they would have hidden is not yet looked at too often. */
enum { TEST_BATCH = 8, TEST_LIMIT = TEST_BATCH + GI_TREE_WIDTH * GI_PACKET_COUNT };

typedef struct Tile {
    const GiTree *tree;
    const GiShapes *shapes;
    uint32_t instance; /* whose tree this is, or GI_SHAPE_NONE */
    double apart;      /* how far from the apex the rays' lines may pass, by rounding */
    GiBundle *bundle;
    bool any;
    unsigned alive[GI_PACKET_COUNT]; /* bits of rays that still look for something */
    float a[GI_BUNDLE_ROOM], b[GI_BUNDLE_ROOM], far[GI_BUNDLE_ROOM]; /* the rays as points */
    uint32_t inverse_known[GI_BUNDLE_SIZE / 32]; /* bits of groups of GI_DOUBLES rays */
    Packets packets;
    Groups groups;
    Frustum frustum;
    double scale;
    bool stopped;
    uint32_t nearer[GI_PACKET_COUNT / 32]; /* bits of packets whose rays have met something since
                                              they were looked at */
    int tests_made;                        /* since `stop` was asked */
    int test_count;
    Test tests[TEST_LIMIT];
} Tile;

/* ---------------------------------------------------------------- set-up */

/* A packet that nothing concerns. */
static inline void packet_clear(Packets *packets, int k) {
    packets->a0[k] = packets->b0[k] = INFINITY;
    packets->a1[k] = packets->b1[k] = packets->far[k] = -INFINITY;
}

/* Rays that fill up the last packet: copies of the first whose interval is empty. */
static inline void tile_pad(GiBundle *bundle) {
    int end = (bundle->count + GI_PACKET_SIZE - 1) / GI_PACKET_SIZE * GI_PACKET_SIZE;
    for (int i = bundle->count; i < end; i++) {
        bundle->ox[i] = bundle->ox[0];
        bundle->oy[i] = bundle->oy[0];
        bundle->oz[i] = bundle->oz[0];
        bundle->dx[i] = bundle->dx[0];
        bundle->dy[i] = bundle->dy[0];
        bundle->dz[i] = bundle->dz[0];
        bundle->t_min[i] = 1;
        bundle->t_max[i] = bundle->t[i] = 0;
        bundle->skip[i] = bundle->skip_instance[i] = GI_SHAPE_NONE;
    }
}

/* The bundle's frame: w along the mean direction, u along `side` or, when that is not known, along
 * the longest extent of the rays. False when the rays are spread too wide for one plane. */
static inline bool tile_frame(const GiBundle *bundle, double toward, GiVec *u, GiVec *v, GiVec *w) {
    GiVec sum = {0, 0, 0};
    /* A few rays tell the direction well enough; tile_packets looks at all of them. */
    for (int i = 0; i < bundle->count; i += 1 + bundle->count / 16) {
        sum = gi_add(sum, gi_normalize(gi_vec(bundle->dx[i], bundle->dy[i], bundle->dz[i])));
    }
    *w = gi_normalize(gi_scale(sum, toward));
    if (gi_vec_is_zero(*w)) return false;
    GiVec side = bundle->side;
    if (gi_vec_is_zero(side)) {
        int last = bundle->count - 1;
        side = gi_sub(gi_normalize(gi_vec(bundle->dx[last], bundle->dy[last], bundle->dz[last])),
            gi_normalize(gi_vec(bundle->dx[0], bundle->dy[0], bundle->dz[0])));
    }
    *u = gi_sub(side, gi_scale(*w, gi_dot(side, *w)));
    if (gi_length(*u) < 1e-9 * gi_length(side) || gi_vec_is_zero(side)) {
        GiVec other = fabs(w->x) < 0.6 ? gi_vec(1, 0, 0) : gi_vec(0, 1, 0);
        *u = gi_cross(*w, other);
    }
    *u = gi_normalize(*u);
    *v = gi_cross(*w, *u);
    return true;
}

static inline R tile_dot(GiVec a, R x, R y, R z) {
    return R_OF(a.x) * x + R_OF(a.y) * y + R_OF(a.z) * z;
}

/* Rectangle and depths of the packets. False when a ray is too oblique to the axis. */
static inline bool tile_packets(Tile *tile, double toward, GiVec u, GiVec v, GiVec w) {
    GiBundle *bundle = tile->bundle;
    Packets *packets = &tile->packets;
    M oblique = M_OF(false);
    for (int k = 0; k < GI_PACKET_COUNT; k++) {
        if (k * GI_PACKET_SIZE >= bundle->count) {
            packet_clear(packets, k);
            tile->alive[k] = 0;
            continue;
        }
        for (int i = k * GI_PACKET_SIZE; i < (k + 1) * GI_PACKET_SIZE; i += GI_DOUBLES) {
            R x = r_load(bundle->dx + i), y = r_load(bundle->dy + i), z = r_load(bundle->dz + i);
            R square = x * x + y * y + z * z;
            r_store(bundle->inverse_square + i, R_OF(1) / square);
            R depth = R_OF(toward) * tile_dot(w, x, y, z);
            /* Within 66 degrees of the axis: depth / |d| > 0.4. */
            oblique = oblique |
                      M_NOT(R_LESS(R_OF(0.16) * square, depth * depth) & R_LESS(R_OF(0), depth));
            r_store(bundle->depth + i, depth);
            R scale = R_OF(toward) / depth;
            r_store_floats(tile->a + i, tile_dot(u, x, y, z) * scale);
            r_store_floats(tile->b + i, tile_dot(v, x, y, z) * scale);
            /* Shadow rays end at the apex, so a ray's depth is that of its origin. */
            R reach = depth;
            if (!tile->any) reach = depth * r_load(bundle->t + i);
            r_store_floats(tile->far + i, reach * R_OF(tile->scale * (1 + GI_WIDER)));
        }
        int first = k * GI_PACKET_SIZE;
        packets->a0[k] = f_lowest(tile->a + first, GI_PACKET_SIZE);
        packets->a1[k] = f_highest(tile->a + first, GI_PACKET_SIZE);
        packets->b0[k] = f_lowest(tile->b + first, GI_PACKET_SIZE);
        packets->b1[k] = f_highest(tile->b + first, GI_PACKET_SIZE);
        packets->far[k] = f_highest(tile->far + first, GI_PACKET_SIZE);
        packets->a0[k] -= GI_WIDER * (1 + fabsf(packets->a0[k]));
        packets->a1[k] += GI_WIDER * (1 + fabsf(packets->a1[k]));
        packets->b0[k] -= GI_WIDER * (1 + fabsf(packets->b0[k]));
        packets->b1[k] += GI_WIDER * (1 + fabsf(packets->b1[k]));
        tile->alive[k] = 0xffff;
    }
    return m_bits(oblique) == 0;
}

/* Outward normals of the four sides: p is outside when p . n > 0. */
static inline void frustum_planes(Frustum *frustum) {
    for (int i = 0; i < 3; i++) {
        float u = frustum->axis[0][i], v = frustum->axis[1][i], w = frustum->axis[2][i];
        frustum->plane[0][i] = w * frustum->a0 - u;
        frustum->plane[1][i] = u - w * frustum->a1;
        frustum->plane[2][i] = w * frustum->b0 - v;
        frustum->plane[3][i] = v - w * frustum->b1;
    }
}

static inline void tile_refresh_far(Tile *tile) {
    Groups *groups = &tile->groups;
    for (int g = 0; g < GROUP_COUNT; g++) {
        groups->far[g] = f_highest(tile->packets.far + g * GROUP_SIZE, GROUP_SIZE);
    }
    tile->frustum.far = groups->far[0];
    for (int g = 1; g < GROUP_COUNT; g++) {
        if (tile->frustum.far < groups->far[g]) tile->frustum.far = groups->far[g];
    }
}

/* The groups and the frustum closely round the packets that have rays left. */
static inline void tile_enclose(Tile *tile) {
    const Packets *packets = &tile->packets;
    Groups *groups = &tile->groups;
    Frustum *frustum = &tile->frustum;
    frustum->a0 = frustum->b0 = INFINITY;
    frustum->a1 = frustum->b1 = -INFINITY;
    for (int g = 0; g < GROUP_COUNT; g++) {
        groups->a0[g] = f_lowest(packets->a0 + g * GROUP_SIZE, GROUP_SIZE);
        groups->a1[g] = f_highest(packets->a1 + g * GROUP_SIZE, GROUP_SIZE);
        groups->b0[g] = f_lowest(packets->b0 + g * GROUP_SIZE, GROUP_SIZE);
        groups->b1[g] = f_highest(packets->b1 + g * GROUP_SIZE, GROUP_SIZE);
        if (frustum->a0 > groups->a0[g]) frustum->a0 = groups->a0[g];
        if (frustum->a1 < groups->a1[g]) frustum->a1 = groups->a1[g];
        if (frustum->b0 > groups->b0[g]) frustum->b0 = groups->b0[g];
        if (frustum->b1 < groups->b1[g]) frustum->b1 = groups->b1[g];
    }
    tile_refresh_far(tile);
    frustum_planes(frustum);
}

static inline void tile_planes(Tile *tile, GiVec u, GiVec v, GiVec w) {
    Frustum *frustum = &tile->frustum;
    const GiTree *tree = tile->tree;
    GiVec apex = gi_scale(gi_sub(tile->bundle->apex, tree->center), tree->scale);
    double largest = fmax(fabs(apex.x), fmax(fabs(apex.y), fabs(apex.z)));
    frustum->apex[0] = (float)apex.x;
    frustum->apex[1] = (float)apex.y;
    frustum->apex[2] = (float)apex.z;
    frustum->margin = (float)(GI_TREE_GROWTH * largest + tile->apart * tree->scale);
    seen_from_init(&frustum->seen, tile->bundle->apex, tile->apart, tree->scale);
    const GiVec rows[3] = {u, v, w};
    for (int i = 0; i < 3; i++) {
        frustum->axis[i][0] = (float)rows[i].x;
        frustum->axis[i][1] = (float)rows[i].y;
        frustum->axis[i][2] = (float)rows[i].z;
    }
    tile_enclose(tile);
}

/* ---------------------------------------------------------------- culling */

/* x * nx + y * ny + z * nz */
static inline F frame_dot(const float n[3], F x, F y, F z) {
    return f_fused(f_of(n[0]), x, f_fused(f_of(n[1]), y, f_of(n[2]) * z));
}

/* The smallest and the largest value of p . n over boxes relative to the apex. */
static inline F smallest_dot(const float n[3], const F low[3], const F high[3]) {
    return frame_dot(
        n, (n[0] >= 0 ? low : high)[0], (n[1] >= 0 ? low : high)[1], (n[2] >= 0 ? low : high)[2]);
}

static inline F largest_dot(const float n[3], const F low[3], const F high[3]) {
    return frame_dot(
        n, (n[0] >= 0 ? high : low)[0], (n[1] >= 0 ? high : low)[1], (n[2] >= 0 ? high : low)[2]);
}

/* Bits of the children whose boxes reach into the frustum; their nearest depths in enter[8]. */
static inline unsigned tile_node(const Frustum *frustum, const GiNode *node, float enter[8]) {
    unsigned bits = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        F low[3], high[3];
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = f_load(node->low[axis] + i) - f_of(frustum->apex[axis] + frustum->margin);
            high[axis] = f_load(node->high[axis] + i) - f_of(frustum->apex[axis] - frustum->margin);
        }
        F nearest = smallest_dot(frustum->axis[2], low, high);
        F zero = f_of(0);
        unsigned in = f_less_equal(nearest, f_of(frustum->far));
        in &= f_less_equal(zero, largest_dot(frustum->axis[2], low, high));
        for (int plane = 0; plane < 4; plane++) {
            in &= f_less_equal(smallest_dot(frustum->plane[plane], low, high), zero);
        }
        f_store(enter + i, nearest);
        bits |= in << i;
    }
    return bits;
}

/* Eight shapes as rectangles in the plane of the packets. */
typedef struct Rectangles {
    float a0[8], a1[8], b0[8], b1[8], near[8];
} Rectangles;

/* From centres and half extents along u, v, w: (x +- e) / z over all z of the shape, which is
 * farthest out at the nearest or the farthest z. A shape that reaches the apex' own plane covers
 * everything. Returns the bits of those that may concern the tile. */
static inline unsigned rectangles_of(
    const Frustum *frustum, int i, const F center[3], const F extent[3], Rectangles *rectangles) {
    F z0 = center[2] - extent[2], z1 = center[2] + extent[2];
    F one = f_of(1);
    F near_scale = one / z0, far_scale = one / z1;
    F x0 = center[0] - extent[0], x1 = center[0] + extent[0];
    F y0 = center[1] - extent[1], y1 = center[1] + extent[1];
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

static inline unsigned tile_spheres(
    const Frustum *frustum, const GiSphereBlock *block, Rectangles *rectangles) {
    unsigned bits = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        F x = f_load(block->center[0] + i) - f_of(frustum->apex[0]);
        F y = f_load(block->center[1] + i) - f_of(frustum->apex[1]);
        F z = f_load(block->center[2] + i) - f_of(frustum->apex[2]);
        F radius = f_load(block->radius + i) + f_of(frustum->margin);
        F center[3], extent[3] = {radius, radius, radius};
        for (int row = 0; row < 3; row++) center[row] = frame_dot(frustum->axis[row], x, y, z);
        bits |= rectangles_of(frustum, i, center, extent, rectangles);
    }
    return bits;
}

static inline unsigned tile_boxes(
    const Frustum *frustum, const GiBoxBlock *block, Rectangles *rectangles) {
    unsigned bits = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        F middle[3], half[3], center[3], extent[3];
        for (int axis = 0; axis < 3; axis++) {
            F low = f_load(block->low[axis] + i), high = f_load(block->high[axis] + i);
            middle[axis] = (low + high) * f_of(0.5f) - f_of(frustum->apex[axis]);
            half[axis] = (high - low) * f_of(0.5f) + f_of(frustum->margin);
        }
        for (int row = 0; row < 3; row++) {
            const float *n = frustum->axis[row];
            const float size[3] = {fabsf(n[0]), fabsf(n[1]), fabsf(n[2])};
            center[row] = frame_dot(n, middle[0], middle[1], middle[2]);
            extent[row] = frame_dot(size, half[0], half[1], half[2]);
        }
        bits |= rectangles_of(frustum, i, center, extent, rectangles);
    }
    return bits;
}

/* The edges of eight triangles in the plane of the packets. */
typedef struct Edges {
    float x[3][8], y[3][8], z[3][8], slack[8];
} Edges;

/* The places of corners: (a, b) = (x, y) / depth. A corner r away, in single precision, errs by six
 * roundings of r in each of x, y and depth, so that with |a|, |b| <= m its place errs by less than
 * 16 roundings of (1 + m)^2, and by `error` (1 + m) / depth for the apex. */
static inline unsigned tile_triangles(const Frustum *frustum, const GiTriangles *triangles,
    uint32_t first, uint32_t count, Rectangles *rectangles, Edges *edges) {
    float corners[3][3][8];
    seen_corners(&frustum->seen, triangles, first, count, corners);
    unsigned bits = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        F a[3], b[3], depth[3], one = f_of(1), most = f_of(0);
        for (int k = 0; k < 3; k++) {
            F x = f_load(corners[k][0] + i), y = f_load(corners[k][1] + i),
              z = f_load(corners[k][2] + i);
            depth[k] = frame_dot(frustum->axis[2], x, y, z);
            F inverse = one / depth[k];
            a[k] = frame_dot(frustum->axis[0], x, y, z) * inverse;
            b[k] = frame_dot(frustum->axis[1], x, y, z) * inverse;
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
        for (int k = 0; k < 3; k++) {
            int next = (k + 1) % 3;
            F x = b[k] - b[next], y = a[next] - a[k];
            f_store(edges->x[k] + i, x);
            f_store(edges->y[k] + i, y);
            f_store(edges->z[k] + i, f_of(0) - (x * a[k] + y * b[k]));
        }
        /* What reaches behind the apex, or is far off to the side, is not in the plane. */
        unsigned all = (1u << GI_FLOATS) - 1;
        unsigned whole = f_less_equal(f_of(4) * error, nearest) & f_less_equal(f_of(0), nearest) &
                         f_less_equal(most, f_of(4096));
        unsigned in = f_less_equal(a0, f_of(frustum->a1)) & f_less_equal(f_of(frustum->a0), a1) &
                      f_less_equal(b0, f_of(frustum->b1)) & f_less_equal(f_of(frustum->b0), b1) &
                      f_less_equal(near, f_of(frustum->far));
        unsigned around = ~whole & all;
        for (unsigned rest = around; rest != 0; rest &= rest - 1) {
            int lane = i + lowest_bit(rest);
            rectangles->a0[lane] = rectangles->b0[lane] = rectangles->near[lane] = -INFINITY;
            rectangles->a1[lane] = rectangles->b1[lane] = edges->slack[lane] = INFINITY;
            for (int k = 0; k < 3; k++) {
                edges->x[k][lane] = edges->y[k][lane] = edges->z[k][lane] = 0;
            }
        }
        bits |= ((in & whole) | around) << i;
    }
    return bits & ((1u << count) - 1);
}

/* Of eight shapes, bits of those that may concern the packets of a group. */
static inline unsigned tile_group(const Groups *groups, int g, const Rectangles *shapes) {
    unsigned bits = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        bits |= (f_less_equal(f_load(shapes->a0 + i), f_of(groups->a1[g])) &
                    f_less_equal(f_of(groups->a0[g]), f_load(shapes->a1 + i)) &
                    f_less_equal(f_load(shapes->b0 + i), f_of(groups->b1[g])) &
                    f_less_equal(f_of(groups->b0[g]), f_load(shapes->b1 + i)) &
                    f_less_equal(f_load(shapes->near + i), f_of(groups->far[g])))
                << i;
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

/* Bits of the rays of one packet that may be inside of a triangle and end behind its nearest
 * corner. */
static inline unsigned tile_rays_inside(
    const Tile *tile, const Rectangles *shapes, const Edges *edges, int lane, int packet) {
    int i = packet * GI_PACKET_SIZE;
    EdgeLines lines = {{edges->x[0][lane], edges->x[1][lane], edges->x[2][lane]},
        {edges->y[0][lane], edges->y[1][lane], edges->y[2][lane]},
        {edges->z[0][lane], edges->z[1][lane], edges->z[2][lane]}, edges->slack[lane]};
    return tile->alive[packet] & sixteen_inside(&lines, tile->a + i, tile->b + i) &
           sixteen_from(shapes->near[lane], tile->far + i);
}
