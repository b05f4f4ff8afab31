/* SPDX-License-Identifier: MIT
 * Many items as few. Those of a large range whose centres lie in one cell of a grid are a cluster:
 * a box with a weight. The builder splits clusters as it would split items, down to buckets that
 * are worth a closer look, and then all items go to their buckets at once. So two passes over the
 * items do for many levels of the tree. */
#pragma once

#include "accel/split.h"

/* Cells of a grid, at most: what a worker needs for them stays in its cache. */
enum { GI_CLUSTER_LIMIT = 1 << 13 };

/* Items begin .. end - 1, which are to become the subtree of a node. */
typedef struct GiRange {
    uint32_t node, begin, end;
    int depth;
} GiRange;

typedef struct GiClusters {
    size_t cluster_count, bucket_count;
    uint32_t begin; /* of the range */
    GiBuildItem clusters[GI_CLUSTER_LIMIT];
    uint32_t weights[GI_CLUSTER_LIMIT]; /* how many items; by the cluster's id, as bucket_of */
    uint16_t bucket_of[GI_CLUSTER_LIMIT];
    GiRange buckets[GI_CLUSTER_LIMIT];
    uint32_t heads[GI_CLUSTER_LIMIT]; /* the next place of each bucket */
    uint16_t cells[GI_CLUSTER_LIMIT]; /* the cluster's id, plus one; 0: none yet */
} GiClusters;

/* Finds the clusters of a range of items, whose centres have these bounds. False: all lie in one
 * cell. */
bool gi_clusters_make(
    GiClusters *clusters, GiBuildItem *items, const GiRange *range, const GiBounds *centers);

/* How many items clusters begin .. end - 1 are. */
size_t gi_clusters_weight(const GiClusters *clusters, size_t begin, size_t end);

/* Makes these clusters a bucket, whose items come to stand behind those of the bucket before. */
void gi_clusters_close(GiClusters *clusters, size_t begin, size_t end, uint32_t node, int depth);

/* Brings all items of the range to their buckets. */
void gi_clusters_sort(GiClusters *clusters, GiBuildItem *items);
