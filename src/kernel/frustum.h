/* SPDX-License-Identifier: MIT
 * A bundle of rays as a frustum: its frame, and its rays, packets and groups of
 * packets as points and rectangles. Part of kernel.c; bundle.h tells the whole story. */
#pragma once

/* Sixteen roundings: what rays as points, and depths, are widened by. */
#define GI_WIDER 0x1p-20f

/* And where rays are parallel, shapes and depths. */
#define GI_PARALLEL_WIDER (4 * GI_WIDER)

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
    bool parallel; /* the apex is infinitely far away (parallel.h) */
    float apex[3], margin;
    float axis[3][3];      /* u, v, w as rows */
    float extent[3][3][8]; /* see frustum_extents */
    float a0, a1, b0, b1, far;
    float spread;  /* 1 + |a| + |b|, at most */
    float start;   /* depth from which on nothing is before what the rays look at */
    float lost;    /* of a depth, by what doubles round */
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

/* Spheres, boxes and cones, which wait kind by kind. */
#define SOLID_KINDS (GI_SHAPE_CONE + 1)
typedef struct SolidTests {
    int count;
    Test tests[TEST_LIMIT];
} SolidTests;

/* Where the shapes of a kind are; of all kinds that a ref has bits for. */
enum { KIND_COUNT = 16 };
typedef struct Places {
    const char *first;
    size_t size; /* of one; 0: as good as none */
} Places;

typedef struct Tile {
    const GiTree *tree;
    const GiShapes *shapes;
    uint32_t instance; /* whose tree this is, or GI_SHAPE_NONE */
    double apart;      /* how far from the apex the rays' lines may pass, by rounding */
    GiBundle *bundle;
    bool any;
    unsigned alive[GI_PACKET_COUNT]; /* bits of rays that still look for something */
    /* Whether the quotients of GI_DOUBLES rays are known: bits of such groups. */
    uint32_t inverse_known[GI_BUNDLE_SIZE / 32], square_known[GI_BUNDLE_SIZE / 32];
    float a[GI_BUNDLE_ROOM], b[GI_BUNDLE_ROOM]; /* the rays as points */
    float far[GI_BUNDLE_ROOM];                  /* depth that they do not look beyond, */
    float surely[GI_BUNDLE_ROOM];               /* and one that they certainly look up to */
    unsigned open[GI_PACKET_COUNT]; /* bits of rays that have come to a triangle, shape and instance
                                       of the bundle, but their t is not worked out yet */
    Packets packets;
    Groups groups;
    Frustum frustum;
    float area; /* of the packets' rectangles, the mean, to begin with */
    double scale;
    GiVec toward; /* along the rays: w, or for any its opposite */
    bool stopped;
    int emptied; /* packets that have no rays left since these were looked at */
    uint32_t nearer[GI_PACKET_COUNT / 32]; /* bits of packets whose rays have met something since
                                              they were looked at */
    int tests_made;                        /* since `stop` was asked */
    int taken;                             /* packets with rays that took a triangle, not flushed */
    Places places[KIND_COUNT];
    SolidTests solids[SOLID_KINDS];
    int test_count; /* of all other shapes */
    Test tests[TEST_LIMIT];
} Tile;

/* ---------------------------------------------------------------- set-up */

/* The directions of the rays from i on. */
static inline void bundle_directions(const GiBundle *bundle, bool any, int i, R *dx, R *dy, R *dz) {
    if (any && !bundle->own) {
        *dx = R_OF(bundle->apex.x) - r_load(bundle->ox + i);
        *dy = R_OF(bundle->apex.y) - r_load(bundle->oy + i);
        *dz = R_OF(bundle->apex.z) - r_load(bundle->oz + i);
    } else {
        *dx = r_load(bundle->dx + i), *dy = r_load(bundle->dy + i), *dz = r_load(bundle->dz + i);
    }
}

static inline GiVec bundle_direction(const GiBundle *bundle, bool any, int i) {
    if (!any || bundle->own) return gi_bundle_direction(bundle, i);
    return gi_sub(bundle->apex, gi_vec(bundle->ox[i], bundle->oy[i], bundle->oz[i]));
}

/* A packet that nothing concerns. */
static inline void packet_clear(Packets *packets, int k) {
    packets->a0[k] = packets->b0[k] = INFINITY;
    packets->a1[k] = packets->b1[k] = packets->far[k] = -INFINITY;
}

/* Rays that fill up the last packet: copies of the first that look for nothing. */
static inline void tile_pad(Tile *tile) {
    GiBundle *bundle = tile->bundle;
    int end = (bundle->count + GI_PACKET_SIZE - 1) / GI_PACKET_SIZE * GI_PACKET_SIZE;
    for (int i = bundle->count; i < end; i++) {
        if (!tile->any || bundle->own) {
            bundle->dx[i] = bundle->dx[0];
            bundle->dy[i] = bundle->dy[0];
            bundle->dz[i] = bundle->dz[0];
        }
        bundle->t[i] = 0;
        if (!tile->any) continue;
        bundle->ox[i] = bundle->ox[0];
        bundle->oy[i] = bundle->oy[0];
        bundle->oz[i] = bundle->oz[0];
        /* At the apex, or, where there is none, no farther away than the first. */
        bundle->t_min[i] = tile->frustum.parallel ? bundle->t_min[0] : 1;
        bundle->skip[i] = bundle->skip_instance[i] = GI_SHAPE_NONE;
    }
}

/* The bundle's frame: w along the mean direction, u along `side` or, when that is not known, along
 * the longest extent of the rays. False when the rays are spread too wide for one plane. */
static inline bool tile_frame(const GiBundle *bundle, bool any, GiVec *u, GiVec *v, GiVec *w) {
    GiVec sum = {0, 0, 0};
    /* A few rays tell the direction well enough; tile_packets looks at all of them. */
    for (int i = 0; i < bundle->count; i += 1 + bundle->count / 16) {
        sum = gi_add(sum, gi_normalize(bundle_direction(bundle, any, i)));
    }
    *w = gi_normalize(any ? gi_negate(sum) : sum);
    if (gi_vec_is_zero(*w)) return false;
    GiVec side = bundle->side;
    if (gi_vec_is_zero(side)) {
        int last = bundle->count - 1;
        side = gi_sub(gi_normalize(bundle_direction(bundle, any, last)),
            gi_normalize(bundle_direction(bundle, any, 0)));
    }
    *u = gi_sub(side, gi_scale(*w, gi_dot(side, *w)));
    if (gi_length(*u) < 1e-9 * gi_length(side) || gi_vec_is_zero(side)) {
        GiVec other = fabs(w->x) < 0.6 ? gi_vec(1, 0, 0) : gi_vec(0, 1, 0);
        *u = gi_cross(*w, other);
    }
    /* Where `side` is nearly w, what is left of it is across only roughly; another step makes it so
     * to the last bits. */
    *u = gi_normalize(*u);
    *u = gi_normalize(gi_sub(*u, gi_scale(*w, gi_dot(*u, *w))));
    *v = gi_cross(*w, *u);
    return true;
}

static inline R tile_dot(GiVec a, R x, R y, R z) {
    return R_OF(a.x) * x + R_OF(a.y) * y + R_OF(a.z) * z;
}

/* The rays from i on: how deep a step of their length goes. */
static inline R tile_depth(const Tile *tile, int i) {
    R dx, dy, dz;
    bundle_directions(tile->bundle, tile->any, i, &dx, &dy, &dz);
    return tile_dot(tile->toward, dx, dy, dz);
}

/* Rays along their bundle's axes, in doubles. */
typedef struct Along {
    R a[GI_PARTS], b[GI_PARTS], depth[GI_PARTS];
} Along;

/* What is not within the range of floats, perhaps: a and b become quotients. */
static NOINLINE void rays_divide(Along *along) {
    for (int k = 0; k < GI_PARTS; k++) {
        /* What does not go along the axis becomes as oblique as can be. */
        M forward = R_LESS(R_OF(0), along->depth[k]);
        along->a[k] = R_SELECT(forward, along->a[k] / along->depth[k], R_OF(INFINITY));
        along->b[k] = along->b[k] / along->depth[k];
    }
}

/* The rays from i on as points, and how deep they end. Returns whether none is too oblique to the
 * axis, more than 66 degrees; *most becomes the largest depth there is. */
static inline bool rays_place(Tile *tile, bool any, int i, GiVec u, GiVec v, R *most) {
    const GiBundle *bundle = tile->bundle;
    const R one = R_OF(1);
    const unsigned all = (1u << GI_WIDEST) - 1;
    Along along;
    R end[GI_PARTS];
    for (int k = 0; k < GI_PARTS; k++) {
        int at = i + k * GI_DOUBLES;
        R x, y, z;
        bundle_directions(bundle, any, at, &x, &y, &z);
        along.depth[k] = tile_dot(tile->toward, x, y, z);
        along.a[k] = tile_dot(u, x, y, z);
        along.b[k] = tile_dot(v, x, y, z);
        *most = R_MAX(*most, along.depth[k]);
        R to;
        if (any) {
            /* Shadow rays end at the apex, so t counts from the other end. */
            to = one - r_load(bundle->t_min + at);
        } else {
            to = r_load(bundle->t + at);
        }
        end[k] = to * along.depth[k] * R_OF(tile->scale);
    }
    P depth = p_rounded(along.depth), scale = p_of(any ? -1 : 1);
    if ((p_less(p_of(0x1p-60f), depth) & p_less(depth, p_of(0x1p60f))) == all) {
        scale = scale / depth;
    } else {
        rays_divide(&along);
    }
    P a = p_rounded(along.a) * scale, b = p_rounded(along.b) * scale, far = p_rounded(end);
    p_store(tile->a + i, a);
    p_store(tile->b + i, b);
    if (any) {
        P lost = p_of(tile->frustum.lost);
        p_store(tile->far + i, far * p_of(1 + GI_WIDER) + lost);
        p_store(tile->surely + i, p_max(far * p_of(1 - GI_WIDER) - lost, p_of(0)));
    } else {
        p_store(tile->far + i, far * p_of(1 + GI_WIDER));
        p_store(tile->surely + i, far * p_of(1 - GI_WIDER));
    }
    /* depth / |d| > 0.4 */
    return p_less(p_fused(a, a, b * b), p_of(5.25f)) == all;
}

/* Rectangles and depths of the GI_FLOATS packets from k on, whose rays have their places. */
static inline void packets_enclose(Tile *tile, int k) {
    Packets *packets = &tile->packets;
    const F one = f_of(1), wider = f_of(GI_WIDER);
    int first = k * GI_PACKET_SIZE;
    F a0 = f_ends(tile->a + first, false), a1 = f_ends(tile->a + first, true);
    F b0 = f_ends(tile->b + first, false), b1 = f_ends(tile->b + first, true);
    f_store(packets->a0 + k, a0 - wider * (one + f_size(a0)));
    f_store(packets->a1 + k, a1 + wider * (one + f_size(a1)));
    f_store(packets->b0 + k, b0 - wider * (one + f_size(b0)));
    f_store(packets->b1 + k, b1 + wider * (one + f_size(b1)));
    f_store(packets->far + k, f_ends(tile->far + first, true));
}

/* So many packets have rays that look for something. */
static inline void packets_begin(Tile *tile, int count) {
    for (int k = 0; k < GI_PACKET_COUNT; k++) {
        tile->alive[k] = k < count ? 0xffff : 0;
        tile->open[k] = 0;
    }
    for (int k = count; k < GI_PACKET_COUNT; k++) packet_clear(&tile->packets, k);
    int rest = tile->bundle->count % GI_PACKET_SIZE;
    if (rest != 0) tile->alive[tile->bundle->count / GI_PACKET_SIZE] = (1u << rest) - 1;
}

/* Rectangle and depths of the packets. False when a ray is too oblique to the axis. */
static inline bool tile_packets(Tile *tile, bool any, GiVec u, GiVec v) {
    GiBundle *bundle = tile->bundle;
    bool narrow = true;
    R deepest = R_OF(0);
    int count = (bundle->count + GI_PACKET_SIZE - 1) / GI_PACKET_SIZE;
    for (int k = 0; k < count; k += GI_FLOATS) {
        int end = k + GI_FLOATS < count ? k + GI_FLOATS : count;
        for (int i = k * GI_PACKET_SIZE; i < end * GI_PACKET_SIZE; i += GI_WIDEST) {
            narrow &= rays_place(tile, any, i, u, v, &deepest);
        }
        packets_enclose(tile, k);
    }
    packets_begin(tile, count);
    double depths[GI_DOUBLES], most = 0;
    r_store(depths, deepest);
    for (int i = 0; i < GI_DOUBLES; i++) most = fmax(most, depths[i]);
    most *= any ? 1 - bundle->end : bundle->start;
    Frustum *frustum = &tile->frustum;
    frustum->start = (float)(2 * most * tile->scale) + 2 * frustum->margin + 16 * frustum->lost;
    return narrow;
}

static inline void tile_refresh_far(Tile *tile) {
    Groups *groups = &tile->groups;
    for (int g = 0; g < GROUP_COUNT; g += GI_FLOATS) {
        f_store(groups->far + g, f_ends(tile->packets.far + g * GROUP_SIZE, true));
    }
    tile->frustum.far = f_highest(groups->far, GROUP_COUNT);
}

/* The groups and the frustum closely round the packets that have rays left. */
static inline void tile_enclose(Tile *tile) {
    const Packets *packets = &tile->packets;
    Groups *groups = &tile->groups;
    Frustum *frustum = &tile->frustum;
    for (int g = 0; g < GROUP_COUNT; g += GI_FLOATS) {
        f_store(groups->a0 + g, f_ends(packets->a0 + g * GROUP_SIZE, false));
        f_store(groups->a1 + g, f_ends(packets->a1 + g * GROUP_SIZE, true));
        f_store(groups->b0 + g, f_ends(packets->b0 + g * GROUP_SIZE, false));
        f_store(groups->b1 + g, f_ends(packets->b1 + g * GROUP_SIZE, true));
    }
    frustum->a0 = f_lowest(groups->a0, GROUP_COUNT);
    frustum->a1 = f_highest(groups->a1, GROUP_COUNT);
    frustum->b0 = f_lowest(groups->b0, GROUP_COUNT);
    frustum->b1 = f_highest(groups->b1, GROUP_COUNT);
    float a = fabsf(frustum->a0), b = fabsf(frustum->b0);
    a = a > fabsf(frustum->a1) ? a : fabsf(frustum->a1);
    b = b > fabsf(frustum->b1) ? b : fabsf(frustum->b1);
    frustum->spread = 1 + a + b;
    tile_refresh_far(tile);
}

/* Where the apex is, before anything else. What is infinitely far away is seen from the centre. */
static inline void tile_apex(Tile *tile) {
    Frustum *frustum = &tile->frustum;
    const GiTree *tree = tile->tree;
    GiVec from = frustum->parallel ? tree->center : tile->bundle->apex;
    GiVec apex = gi_scale(gi_sub(from, tree->center), tree->scale);
    double largest = fmax(fabs(apex.x), fmax(fabs(apex.y), fabs(apex.z)));
    frustum->apex[0] = (float)apex.x;
    frustum->apex[1] = (float)apex.y;
    frustum->apex[2] = (float)apex.z;
    frustum->margin = (float)(GI_TREE_GROWTH * largest + tile->apart * tree->scale);
    seen_from_init(&frustum->seen, from, tile->apart, tree->scale);
    frustum->lost = frustum->seen.error < 0x1p100f ? frustum->seen.error : 0x1p100f;
}

/* How far a shape reaches along u, v or w is a sum of its box' half extents, of which each counts
 * for so much, by kind. Spheres, and cones, which stand upright, reach less far than their boxes
 * do. */
static inline void frustum_extents(Frustum *frustum, int row) {
    const float *n = frustum->axis[row];
    float(*extent)[8] = frustum->extent[row];
    for (int kind = 0; kind < 8; kind++) {
        for (int axis = 0; axis < 3; axis++) extent[axis][kind] = fabsf(n[axis]);
    }
    extent[0][GI_SHAPE_SPHERE] = 1;
    extent[0][GI_SHAPE_CONE] = sqrtf(n[0] * n[0] + n[1] * n[1]);
    extent[1][GI_SHAPE_SPHERE] = extent[1][GI_SHAPE_CONE] = extent[2][GI_SHAPE_SPHERE] = 0;
}

/* How large a packet's rectangle is, in the mean. */
static inline float packets_area(const Tile *tile) {
    const Packets *packets = &tile->packets;
    int count = (tile->bundle->count + GI_PACKET_SIZE - 1) / GI_PACKET_SIZE;
    float sum = 0;
    for (int k = 0; k < count; k++) {
        sum += (packets->a1[k] - packets->a0[k]) * (packets->b1[k] - packets->b0[k]);
    }
    return sum / (float)count;
}

static inline void tile_axes(Tile *tile, GiVec u, GiVec v, GiVec w) {
    Frustum *frustum = &tile->frustum;
    const GiVec rows[3] = {u, v, w};
    for (int i = 0; i < 3; i++) {
        frustum->axis[i][0] = (float)rows[i].x;
        frustum->axis[i][1] = (float)rows[i].y;
        frustum->axis[i][2] = (float)rows[i].z;
    }
    for (int row = 0; row < 3; row++) frustum_extents(frustum, row);
    tile->area = packets_area(tile);
    tile_enclose(tile);
}

/* ---------------------------------------------------------------- culling */

/* x * nx + y * ny + z * nz */
static inline F frame_dot(const float n[3], F x, F y, F z) {
    return f_fused(f_of(n[0]), x, f_fused(f_of(n[1]), y, f_of(n[2]) * z));
}
