/* SPDX-License-Identifier: MIT
 * The order of regroup.h: sort-tile-recursive packing (Leutenegger, Lopez, Edgington 1997). Rays
 * become points in the plane across their mean direction. Along the longer axis of their cloud they
 * are cut into slabs of equal numbers, and each slab across into packets. What makes more than two
 * bundles is first cut into these, and then each of them along axes of its own:
 *
 *        +---+------+-----+       Every other slab is walked backwards, so that a group which
 *        |   |  >---|---v |       holds the end of one and the beginning of the next is no larger
 *        | ^ +------+   | |       than others. Equal numbers, not lengths: behind a silhouette a
 *        | | |      |   | |       few far points would otherwise make all others one group.
 *        | | |      +-----+
 *        +---+------+-----+
 *
 * Both cuts are counting sorts, so the whole costs a few nanoseconds a ray. Part of kernel.c, for
 * the sake of its vectors. */
#pragma once

enum {
    BUCKETS = 256,    /* that places along an axis are told apart by */
    SLABS = 32,       /* at most */
    SLAB_BUCKETS = 32 /* that a slab is sorted by */
};

typedef struct Axes {
    float u[3], v[3], w[3];
} Axes;

static void store(float to[3], GiVec v) {
    to[0] = (float)v.x;
    to[1] = (float)v.y;
    to[2] = (float)v.z;
}

/* A frame across the mean direction; u and v are arbitrary. */
static Axes axes_of(const float *x, const float *y, const float *z, int count) {
    GiVec sum = {0, 0, 0};
    for (int i = 0; i < count; i += 1 + count / 64) sum = gi_add(sum, gi_vec(x[i], y[i], z[i]));
    GiVec w = gi_normalize(sum);
    if (gi_vec_is_zero(w)) w = gi_vec(0, 0, 1);
    GiVec u = gi_normalize(gi_cross(w, fabs(w.x) < 0.6 ? gi_vec(1, 0, 0) : gi_vec(0, 1, 0)));
    Axes axes;
    store(axes.w, w);
    store(axes.u, u);
    store(axes.v, gi_cross(w, u));
    return axes;
}

static void project(const Axes *across, const float *restrict xs, const float *restrict ys,
    const float *restrict zs, int count, float *restrict a, float *restrict b) {
    const Axes axes = *across;
    for (int i = 0; i < count; i++) {
        float x = xs[i], y = ys[i], z = zs[i];
        float depth = axes.w[0] * x + axes.w[1] * y + axes.w[2] * z;
        float least = 1e-3f * (fabsf(x) + fabsf(y) + fabsf(z)); /* rays across or backward */
        float divisor = depth > least ? depth : least;
        float inverse = divisor > 0 ? 1 / divisor : 0;
        a[i] = (axes.u[0] * x + axes.u[1] * y + axes.u[2] * z) * inverse;
        b[i] = (axes.v[0] * x + axes.v[1] * y + axes.v[2] * z) * inverse;
    }
}

/* Smallest and largest. */
typedef struct Extent {
    float low, high;
} Extent;

static inline Extent extent_of(const float *p, int count) {
    return (Extent){f_lowest(p, count), f_highest(p, count)};
}

static inline void extend(Extent *extent, Extent by) {
    if (by.low < extent->low) extent->low = by.low;
    if (by.high > extent->high) extent->high = by.high;
}

static inline float area_of(Extent a, Extent b) { return (a.high - a.low) * (b.high - b.low); }

/* Whether the rays may stay as they are: where a scene is coarse, packets that overlap cost less
 * than the sorting. About as many leaves as there are in the scene are spread over the rectangle
 * round all rays; how many times its area the packets cover then says how many they meet. The limit
 * was found by trial; a few packets tell enough. */
static bool order_serves(
    const Axes *axes, const float *x, const float *y, const float *z, int count, double leaves) {
    enum { APART = 4 };
    Extent all_a = {INFINITY, -INFINITY}, all_b = all_a;
    float sum = 0, a[GI_PACKET_SIZE], b[GI_PACKET_SIZE];
    for (int i = 0; i + GI_PACKET_SIZE <= count; i += APART * GI_PACKET_SIZE) {
        project(axes, x + i, y + i, z + i, GI_PACKET_SIZE, a, b);
        Extent packet_a = extent_of(a, GI_PACKET_SIZE), packet_b = extent_of(b, GI_PACKET_SIZE);
        sum += area_of(packet_a, packet_b);
        extend(&all_a, packet_a);
        extend(&all_b, packet_b);
    }
    return APART * (double)sum * leaves <= 5000 * (double)area_of(all_a, all_b);
}

/* Turns points so that x runs along their longest extent. */
typedef struct Turn {
    float c, s; /* x = a c + b s, y = b c - a s */
    float aspect;
} Turn;

/* By the moments of some of the points. */
static Turn turn_of(const float *as, const float *bs, int count) {
    double mean_a = 0, mean_b = 0, aa = 0, ab = 0, bb = 0;
    int step = 1 + count / 64, samples = 0;
    for (int i = 0; i < count; i += step, samples++) {
        double a = as[i], b = bs[i];
        mean_a += a;
        mean_b += b;
        aa += a * a;
        ab += a * b;
        bb += b * b;
    }
    aa -= mean_a * mean_a / samples;
    ab -= mean_a * mean_b / samples;
    bb -= mean_b * mean_b / samples;
    double half = (aa - bb) / 2, root = sqrt(half * half + ab * ab), middle = (aa + bb) / 2;
    double x = half + root, y = ab, length = sqrt(x * x + y * y);
    if (!(length > 0)) return (Turn){1, 0, 1};
    double thin = middle - root, least = 1e-4 * middle;
    double aspect = sqrt((middle + root) / (thin > least ? thin : least));
    return (Turn){(float)(x / length), (float)(y / length), (float)aspect};
}

/* Behind the last point, up to a whole vector. */
static void repeat_first(float *a, float *b, int count) {
    for (int i = count; i % GI_FLOATS != 0; i++) a[i] = a[0], b[i] = b[0];
}

/* The turned points; those behind the last are as good as any. */
static void turn_points(const Turn *turn, const float *a, const float *b, int count, float *x,
    float *y, Extent *x_extent, Extent *y_extent) {
    const F c = f_of(turn->c), s = f_of(turn->s), minus = f_of(-turn->s);
    F x_low = f_of(INFINITY), y_low = x_low, x_high = f_of(-INFINITY), y_high = x_high;
    for (int i = 0; i < count; i += GI_FLOATS) {
        F p = f_load(a + i), q = f_load(b + i);
        F x_now = f_fused(p, c, q * s), y_now = f_fused(q, c, p * minus);
        f_store(x + i, x_now);
        f_store(y + i, y_now);
        x_low = f_min(x_now, x_low), x_high = f_max(x_now, x_high);
        y_low = f_min(y_now, y_low), y_high = f_max(y_now, y_high);
    }
    *x_extent = (Extent){f_least(x_low), f_most(x_high)};
    *y_extent = (Extent){f_least(y_low), f_most(y_high)};
}

/* The buckets of all values; the ends also take what lies outside or is not a number, so that
 * nothing a scene may hold leads out of the array. Without branches, so that compilers make vectors
 * of it. */
static void find_buckets(
    const float *restrict value, int count, Extent extent, int buckets, uint16_t *restrict bucket) {
    const float last = (float)buckets - 1, low = extent.low;
    float scale = ((float)buckets - 0.01f) / (extent.high - extent.low);
    if (!(scale > 0 && scale < 1e30f)) scale = 0; /* all alike, or not numbers */
    for (int i = 0; i < count; i++) {
        float place = (value[i] - low) * scale;
        place = place > 0 ? place : 0;
        place = place < last ? place : last;
        bucket[i] = (uint16_t)(int)place;
    }
}

/* How many values are in each bucket. Neighbours often fall into the same one, and the next count
 * of it would wait for the last: four take turns, each with counts of its own. */
enum { TURNS = 4, MOST_BUCKETS = SLABS * SLAB_BUCKETS };
typedef struct Counts {
    uint16_t of[TURNS][MOST_BUCKETS], all[MOST_BUCKETS];
} Counts;

/* First the places in a slab become buckets. */
static void count_buckets(const uint16_t *restrict across, const uint16_t slab[BUCKETS],
    uint16_t *restrict bucket, int count, int buckets, Counts *counts) {
    for (int k = 0; k < TURNS; k++) {
        memset(counts->of[k], 0, (size_t)buckets * sizeof counts->of[k][0]);
    }
    int i = 0;
    for (; i + TURNS <= count; i += TURNS) {
        for (int k = 0; k < TURNS; k++) {
            counts->of[k][bucket[i + k] ^= slab[across[i + k]]]++;
        }
    }
    for (int k = 0; i + k < count; k++) counts->of[k][bucket[i + k] ^= slab[across[i + k]]]++;
    for (int k = 0; k < buckets; k++) {
        counts->all[k] =
            (uint16_t)(counts->of[0][k] + counts->of[1][k] + counts->of[2][k] + counts->of[3][k]);
    }
}

/* What order[i] is to be: the values bucket by bucket. The counts become places. */
static void sort_by_bucket(
    const uint16_t *bucket, int count, int buckets, Counts *counts, uint16_t *order) {
    for (int i = 0, below = 0; i < buckets; i++) {
        int here = counts->all[i];
        counts->all[i] = (uint16_t)below;
        below += here;
    }
    for (int i = 0; i < buckets; i++) {
        unsigned place = counts->all[i];
        for (int k = 0; k < TURNS; k++) {
            unsigned here = counts->of[k][i];
            counts->of[k][i] = (uint16_t)place;
            place += here;
        }
    }
    int i = 0;
    for (; i + TURNS <= count; i += TURNS) {
        for (int k = 0; k < TURNS; k++) order[counts->of[k][bucket[i + k]]++] = (uint16_t)(i + k);
    }
    for (int k = 0; i + k < count; k++) order[counts->of[k][bucket[i + k]]++] = (uint16_t)(i + k);
}

/* Slabs of equal numbers, up to a bucket: for each bucket the first of its slab's own, or the last
 * where these run backwards, so that an exclusive or with a place in the slab gives the bucket. */
static void find_slabs(const uint16_t *bucket, int count, int slabs, uint16_t slab[BUCKETS]) {
    enum { APART = 3 }; /* some of the values tell the numbers well enough */
    uint16_t here[BUCKETS] = {0};
    for (int i = 0; i < count; i += APART) here[bucket[i]]++;
    float scale = ((float)slabs - 0.01f) / (float)(count / APART + 1);
    for (int i = 0, below = 0; i < BUCKETS; below += here[i++]) {
        int at = (int)((float)(below + here[i] / 2) * scale);
        slab[i] = (uint16_t)(at * SLAB_BUCKETS + (at % 2 == 0 ? 0 : SLAB_BUCKETS - 1));
    }
}

/* Sorts points into groups of so many; order gets a permutation. Returns how the points were
 * turned. */
static Turn pack(
    GiRegroup *regroup, const float *a, const float *b, int count, int group, uint16_t *order) {
    uint16_t *restrict across = regroup->across, *restrict along = regroup->along;
    const Turn turn = turn_of(a, b, count);
    Extent x, y;
    turn_points(&turn, a, b, count, regroup->x, regroup->y, &x, &y);
    int groups = (count + group - 1) / group, most = groups < SLABS ? groups : SLABS;
    float wanted = sqrtf((float)groups * turn.aspect) + 0.5f;
    int slabs = wanted < (float)most ? (int)wanted : most;
    find_buckets(regroup->x, count, x, BUCKETS, across);
    uint16_t slab[BUCKETS];
    find_slabs(across, count, slabs, slab);
    find_buckets(regroup->y, count, y, SLAB_BUCKETS, along);
    Counts counts;
    count_buckets(across, slab, along, count, slabs * SLAB_BUCKETS, &counts);
    sort_by_bucket(along, count, slabs * SLAB_BUCKETS, &counts, order);
    return turn;
}

/* The direction that groups are aligned with. */
static GiVec side_of(const Axes *axes, const Turn *turn) {
    const float *u = axes->u, *v = axes->v;
    return gi_vec(turn->c * u[0] + turn->s * v[0], turn->c * u[1] + turn->s * v[1],
        turn->c * u[2] + turn->s * v[2]);
}

static void pack_bundle(
    GiRegroup *regroup, const Axes *axes, const uint16_t *rays, int count, int begin, GiVec *side) {
    float a[GI_BUNDLE_SIZE + 16] = {0}, b[GI_BUNDLE_SIZE + 16] = {0};
    uint16_t order[GI_BUNDLE_SIZE];
    for (int i = 0; i < count; i++) {
        a[i] = regroup->a[rays[i]];
        b[i] = regroup->b[rays[i]];
    }
    repeat_first(a, b, count);
    const Turn turn = pack(regroup, a, b, count, GI_PACKET_SIZE, order);
    for (int i = 0; i < count; i++) regroup->order[begin + i] = rays[order[i]];
    *side = side_of(axes, &turn);
}

static void GI_KERNEL(regroup)(
    GiRegroup *regroup, const float *x, const float *y, const float *z, int count, double leaves) {
    const int size = GI_BUNDLE_SIZE;
    const float *a = regroup->a, *b = regroup->b;
    uint16_t *order = regroup->order, *bundles = regroup->bundles;
    GiVec *side = regroup->side;
    const Axes axes = axes_of(x, y, z, count);
    if (order_serves(&axes, x, y, z, count, leaves)) {
        for (int i = 0; i < count; i++) order[i] = (uint16_t)i;
        for (int i = 0; i < count; i += size) side[i / size] = gi_vec(0, 0, 0);
        return;
    }
    project(&axes, x, y, z, count, regroup->a, regroup->b);
    repeat_first(regroup->a, regroup->b, count);
    if (count <= 2 * size) { /* half of the slabs are a bundle as good as any */
        const Turn turn = pack(regroup, a, b, count, GI_PACKET_SIZE, order);
        side[0] = side[1] = side_of(&axes, &turn);
        return;
    }
    pack(regroup, a, b, count, size, bundles);
    for (int begin = 0; begin < count; begin += size) {
        int rest = count - begin < size ? count - begin : size;
        pack_bundle(regroup, &axes, bundles + begin, rest, begin, &side[begin / size]);
    }
}
