/* SPDX-License-Identifier: MIT
 * Sort-tile-recursive packing (Leutenegger 1997) in the plane across the mean direction: cut into
 * slabs of equal count along the longest extent, each slab across it, and the same again inside
 * each bundle for its packets. Counting sorts with a few hundred buckets are exact enough. */
#include "render/regroup.h"

#include "kernel/kernel.h"

enum { BUCKET_COUNT = 256 };

/* Sorts order[0 .. count) by key, about, and leaves it in the same place. */
static void sort_by(const float *key, uint16_t *order, uint16_t *other, int count) {
    float low = INFINITY, high = -INFINITY;
    for (int i = 0; i < count; i++) {
        float k = key[order[i]];
        low = k < low ? k : low;
        high = k > high ? k : high;
    }
    if (!(high > low)) return;
    float scale = (BUCKET_COUNT - 0.01f) / (high - low);
    if (!isfinite(scale)) return;
    uint16_t start[BUCKET_COUNT + 1] = {0};
    for (int i = 0; i < count; i++) start[(int)((key[order[i]] - low) * scale) + 1]++;
    for (int i = 0; i < BUCKET_COUNT; i++) start[i + 1] = (uint16_t)(start[i + 1] + start[i]);
    for (int i = 0; i < count; i++) {
        other[start[(int)((key[order[i]] - low) * scale)]++] = order[i];
    }
    for (int i = 0; i < count; i++) order[i] = other[i];
}

/* Packs order[0 .. count) into runs of `size`: slabs along one axis, runs along the other. */
static void pack(GiRegroup *regroup, uint16_t *order, int count, int size, bool a_first) {
    const float *first = a_first ? regroup->a : regroup->b;
    const float *second = a_first ? regroup->b : regroup->a;
    int runs = (count + size - 1) / size;
    int slabs = (int)ceil(sqrt((double)runs));
    int slab_size = (runs + slabs - 1) / slabs * size;
    sort_by(first, order, regroup->sorted, count);
    for (int begin = 0; begin < count; begin += slab_size) {
        int length = count - begin < slab_size ? count - begin : slab_size;
        sort_by(second, order + begin, regroup->sorted, length);
    }
}

/* Coordinates in the plane across the mean direction, a along the axis of largest variance. */
static void project(GiRegroup *regroup, int count) {
    GiVec sum = {0, 0, 0};
    for (int i = 0; i < count; i++) sum = gi_add(sum, gi_normalize(regroup->direction[i]));
    GiVec w = gi_normalize(sum);
    if (gi_vec_is_zero(w)) w = gi_vec(0, 0, 1);
    GiVec u = gi_normalize(gi_cross(w, fabs(w.x) < 0.6 ? gi_vec(1, 0, 0) : gi_vec(0, 1, 0)));
    GiVec v = gi_cross(w, u);
    double mean_a = 0, mean_b = 0;
    for (int i = 0; i < count; i++) {
        GiVec d = regroup->direction[i];
        double depth = fmax(gi_dot(d, w), 1e-3 * gi_length(d));
        double a = gi_dot(d, u) / depth, b = gi_dot(d, v) / depth;
        regroup->a[i] = (float)a;
        regroup->b[i] = (float)b;
        mean_a += a;
        mean_b += b;
    }
    mean_a /= count;
    mean_b /= count;
    double aa = 0, ab = 0, bb = 0;
    for (int i = 0; i < count; i++) {
        double a = regroup->a[i] - mean_a, b = regroup->b[i] - mean_b;
        aa += a * a;
        ab += a * b;
        bb += b * b;
    }
    /* The longer eigenvector of the covariance. */
    double half = (aa - bb) / 2, root = sqrt(half * half + ab * ab);
    double x = half + root, y = ab;
    if (!(x * x + y * y > 0)) x = 1, y = 0;
    double length = sqrt(x * x + y * y);
    x /= length;
    y /= length;
    for (int i = 0; i < count; i++) {
        float a = regroup->a[i], b = regroup->b[i];
        regroup->a[i] = (float)(a * x + b * y);
        regroup->b[i] = (float)(b * x - a * y);
    }
}

void gi_regroup(GiRegroup *regroup, int count) {
    for (int i = 0; i < count; i++) regroup->order[i] = (uint16_t)i;
    if (count <= GI_PACKET_SIZE) return;
    project(regroup, count);
    if (count > GI_BUNDLE_SIZE) pack(regroup, regroup->order, count, GI_BUNDLE_SIZE, true);
    for (int begin = 0; begin < count; begin += GI_BUNDLE_SIZE) {
        int length = count - begin < GI_BUNDLE_SIZE ? count - begin : GI_BUNDLE_SIZE;
        pack(regroup, regroup->order + begin, length, GI_PACKET_SIZE, true);
    }
}
