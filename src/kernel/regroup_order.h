/* SPDX-License-Identifier: MIT
 * The order of regroup.h. Rays become points in the plane across their mean direction, with axes
 * along the cloud's own; each coordinate is replaced by its rank among 128, and the rays are walked
 * along a Hilbert curve. Ranks, not lengths: behind a silhouette one far pixel would otherwise push
 * all others into a few cells. One counting sort does the rest, so the whole costs a few
 * nanoseconds a ray. Part of kernel.c, for the sake of its vectors. */
#pragma once

enum { BUCKETS = 512, RANKS = 128, CELLS = RANKS * RANKS, KEEP_ORDER = 16 };

static const float GOOD_WIDTH = 1.5f;

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
    for (int i = 0; i < count; i += 1 + count / 64) {
        sum = gi_add(sum, gi_normalize(gi_vec(x[i], y[i], z[i])));
    }
    GiVec w = gi_normalize(sum);
    if (gi_vec_is_zero(w)) w = gi_vec(0, 0, 1);
    GiVec u = gi_normalize(gi_cross(w, fabs(w.x) < 0.6 ? gi_vec(1, 0, 0) : gi_vec(0, 1, 0)));
    Axes axes;
    store(axes.w, w);
    store(axes.u, u);
    store(axes.v, gi_cross(w, u));
    return axes;
}

static void project(
    GiRegroup *regroup, const float *xs, const float *ys, const float *zs, int count) {
    const Axes axes = axes_of(xs, ys, zs, count);
    for (int i = 0; i < count; i++) {
        float x = xs[i], y = ys[i], z = zs[i];
        float depth = axes.w[0] * x + axes.w[1] * y + axes.w[2] * z;
        float least = 1e-3f * (fabsf(x) + fabsf(y) + fabsf(z)); /* rays across or backward */
        float divisor = depth > least ? depth : least;
        float inverse = divisor > 0 ? 1 / divisor : 0;
        regroup->a[i] = (axes.u[0] * x + axes.u[1] * y + axes.u[2] * z) * inverse;
        regroup->b[i] = (axes.v[0] * x + axes.v[1] * y + axes.v[2] * z) * inverse;
    }
}

/* Turns the coordinates so that a runs along the axis of largest variance. */
static void align(GiRegroup *regroup, int count) {
    double mean_a = 0, mean_b = 0, aa = 0, ab = 0, bb = 0;
    int step = 1 + count / 256, samples = 0;
    for (int i = 0; i < count; i += step, samples++) {
        double a = regroup->a[i], b = regroup->b[i];
        mean_a += a;
        mean_b += b;
        aa += a * a;
        ab += a * b;
        bb += b * b;
    }
    aa -= mean_a * mean_a / samples;
    ab -= mean_a * mean_b / samples;
    bb -= mean_b * mean_b / samples;
    double half = (aa - bb) / 2, root = sqrt(half * half + ab * ab);
    double x = half + root, y = ab, length = sqrt(x * x + y * y);
    if (!(length > 0)) return;
    float c = (float)(x / length), s = (float)(y / length);
    for (int i = 0; i < count; i++) {
        float a = regroup->a[i], b = regroup->b[i];
        regroup->a[i] = a * c + b * s;
        regroup->b[i] = b * c - a * s;
    }
}

/* The place of each cell on the curve (Hilbert 1891), from squares of one cell up: four of a size
 * make the next, turned so that the curve stays in one piece. Made when it is first needed, since
 * not all scenes have shadows. */
static void draw_curve(uint16_t curve[RANKS * RANKS]) {
    curve[0] = 0;
    for (unsigned side = 1; side < RANKS; side *= 2) {
        unsigned cells = side * side;
        for (unsigned x = 0; x < side; x++) {
            for (unsigned y = 0; y < side; y++) {
                unsigned place = curve[x * RANKS + y];
                unsigned turned_x = 2 * side - 1 - y, turned_y = side - 1 - x;
                curve[x * RANKS + side + y] = (uint16_t)(cells + place);
                curve[(side + x) * RANKS + side + y] = (uint16_t)(2 * cells + place);
                curve[turned_x * RANKS + turned_y] = (uint16_t)(3 * cells + place);
            }
        }
        for (unsigned x = 0; x < side; x++) {
            for (unsigned y = 0; y < x; y++) {
                uint16_t place = curve[x * RANKS + y];
                curve[x * RANKS + y] = curve[y * RANKS + x];
                curve[y * RANKS + x] = place;
            }
        }
    }
}

/* The buckets of all values; the ends also take what lies outside or is not a number, so that
 * nothing a scene may hold leads out of the array. Without branches, so that compilers make vectors
 * of it. */
static void find_buckets(
    const float *restrict value, int count, float low, float scale, uint16_t *restrict bucket) {
    const float last = BUCKETS - 1;
    for (int i = 0; i < count; i++) {
        float place = (value[i] - low) * scale;
        place = place > 0 ? place : 0;
        place = place < last ? place : last;
        bucket[i] = (uint16_t)(int)place;
    }
}

/* How many values are in each bucket. Neighbours often fall into the same one, and the next count
 * of it would wait for the last: four take turns. */
static void count_buckets(const uint16_t *bucket, int count, int counts[BUCKETS]) {
    int turns[4][BUCKETS] = {{0}};
    int i = 0;
    for (; i + 4 <= count; i += 4) {
        for (int k = 0; k < 4; k++) turns[k][bucket[i + k]]++;
    }
    for (; i < count; i++) turns[0][bucket[i]]++;
    for (int k = 0; k < BUCKETS; k++) {
        counts[k] = turns[0][k] + turns[1][k] + turns[2][k] + turns[3][k];
    }
}

/* Adds the rank of every value, times a factor, to its key. The values are followed by room for
 * fifteen more. */
static void rank(GiRegroup *regroup, float *value, int count, int factor) {
    int whole = (count + 15) / 16 * 16;
    for (int i = count; i < whole; i++) value[i] = value[0];
    float low = f_lowest(value, whole), high = f_highest(value, whole);
    float scale = (BUCKETS - 0.01f) / (high - low);
    if (!(scale > 0 && scale < 1e30f)) return; /* all alike, or not numbers */
    int counts[BUCKETS];
    find_buckets(value, count, low, scale, regroup->bucket);
    count_buckets(regroup->bucket, count, counts);
    uint16_t ranks[BUCKETS];
    float rank_scale = (RANKS - 0.01f) / (float)count;
    for (int i = 0, below = 0; i < BUCKETS; i++) {
        int middle = below + counts[i] / 2; /* of a bucket, which is not split */
        ranks[i] = (uint16_t)((int)((float)middle * rank_scale) * factor);
        below += counts[i];
    }
    for (int i = 0; i < count; i++) {
        regroup->key[i] = (uint16_t)(regroup->key[i] + ranks[regroup->bucket[i]]);
    }
}

/* The curve is the same on a coarser grid, four cells to one; so few rays need few cells. */
static int coarseness(int count) {
    int shift = 0;
    while (shift < 6 && CELLS >> shift >= 4 * count) shift += 2;
    return shift;
}

static void sort_by_key(GiRegroup *regroup, int count) {
    int shift = coarseness(count);
    uint16_t start[CELLS + 1];
    for (int i = 0; i <= CELLS >> shift; i++) start[i] = 0;
    for (int i = 0; i < count; i++) start[(regroup->key[i] >> shift) + 1]++;
    for (int i = 0; i < CELLS >> shift; i++) start[i + 1] = (uint16_t)(start[i + 1] + start[i]);
    for (int i = 0; i < count; i++) {
        regroup->order[start[regroup->key[i] >> shift]++] = (uint16_t)i;
    }
}

/* How wide packets are in the order that there is, beside what they would be if all of them
 * together paved the rectangle of all rays. */
static float packet_width(const GiRegroup *regroup, int count) {
    int packets = count / GI_PACKET_SIZE;
    float sum = 0, low_a = INFINITY, high_a = -INFINITY, low_b = INFINITY, high_b = -INFINITY;
    for (int i = 0; i < packets * GI_PACKET_SIZE; i += GI_PACKET_SIZE) {
        float a0 = f_lowest(regroup->a + i, GI_PACKET_SIZE);
        float a1 = f_highest(regroup->a + i, GI_PACKET_SIZE);
        float b0 = f_lowest(regroup->b + i, GI_PACKET_SIZE);
        float b1 = f_highest(regroup->b + i, GI_PACKET_SIZE);
        sum += (a1 - a0) + (b1 - b0);
        if (low_a > a0) low_a = a0;
        if (high_a < a1) high_a = a1;
        if (low_b > b0) low_b = b0;
        if (high_b < b1) high_b = b1;
    }
    return sum / (sqrtf((float)packets) * ((high_a - low_a) + (high_b - low_b)));
}

static void keep_order(GiRegroup *regroup, int count) {
    for (int i = 0; i < count; i++) regroup->order[i] = (uint16_t)i;
}

static void GI_KERNEL(regroup)(
    GiRegroup *regroup, const float *x, const float *y, const float *z, int count, bool large) {
    if (count <= KEEP_ORDER) {
        keep_order(regroup, count);
        return;
    }
    project(regroup, x, y, z, count);
    if (large && packet_width(regroup, count) < GOOD_WIDTH) {
        keep_order(regroup, count);
        return;
    }
    if (!regroup->drawn) draw_curve(regroup->curve);
    regroup->drawn = true;
    align(regroup, count);
    for (int i = 0; i < count; i++) regroup->key[i] = 0;
    rank(regroup, regroup->a, count, RANKS);
    rank(regroup, regroup->b, count, 1);
    for (int i = 0; i < count; i++) regroup->key[i] = regroup->curve[regroup->key[i]];
    sort_by_key(regroup, count);
}
