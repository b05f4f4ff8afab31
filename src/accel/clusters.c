/* SPDX-License-Identifier: MIT */
#include "accel/clusters.h"

#include "base/prefetch.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { CELL_ITEMS = 2 }; /* a cell for so many items; on surfaces most cells stay empty */

/* ---------------------------------------------------------------- the grid */

typedef struct Grid {
    GiFour low, scale;
    int32_t row, layer; /* cells from one to the next */
    size_t cell_count;
} Grid;

/* Where the longest extent has `fineness` cells, the others have as many as make them cubes, or
 * nearly. All are powers of two, so that a grid has a plane in its middle. */
static Grid make_grid(const GiBounds *centers, const float extent[3], float fineness) {
    const float least = FLT_MIN * GI_CLUSTER_LIMIT; /* below, the scale might be infinite */
    float longest = fmaxf(extent[0], fmaxf(extent[1], extent[2]));
    float scale[4] = {0}, cells[3] = {1, 1, 1};
    for (int axis = 0; axis < 3; axis++) {
        while (cells[axis] * longest < extent[axis] * fineness) cells[axis] *= 2;
        /* A little less, so that the last centre falls into the last cell. */
        if (extent[axis] > least) scale[axis] = cells[axis] * 0.9999f / extent[axis];
    }
    return (Grid){centers->low, gi_four_load(scale), (int32_t)cells[0],
        (int32_t)(cells[0] * cells[1]), (size_t)(cells[0] * cells[1] * cells[2])};
}

/* The finest grid that is worth its cells. */
static Grid choose_grid(const GiBounds *centers, size_t item_count) {
    size_t limit = item_count / CELL_ITEMS;
    if (limit > GI_CLUSTER_LIMIT) limit = GI_CLUSTER_LIMIT;
    float extent[4];
    gi_four_store(extent, gi_four_sub(centers->high, centers->low));
    Grid grid = make_grid(centers, extent, 1);
    for (float fineness = 2; fineness <= GI_CLUSTER_LIMIT; fineness *= 2) {
        Grid finer = make_grid(centers, extent, fineness);
        if (finer.cell_count > limit) break;
        grid = finer;
    }
    return grid;
}

static inline size_t cell_of(const Grid *grid, const GiBuildItem *item) {
    int32_t at[4];
    GiFour from = gi_four_sub(gi_build_center(item), grid->low);
    gi_four_to_int(gi_four_multiply(from, grid->scale), at);
    return (size_t)(at[0] + at[1] * grid->row + at[2] * grid->layer);
}

/* ---------------------------------------------------------------- clusters */

/* An item's cluster is noted in its last lane, in a not-a-number. */
static inline void note_cluster(GiBuildItem *item, uint32_t id) {
    uint32_t note = 0x7fc00000u | id;
    memcpy(&item->high[3], &note, sizeof note);
}

static inline uint32_t noted_cluster(const GiBuildItem *item) {
    uint32_t note;
    memcpy(&note, &item->high[3], sizeof note);
    return note & (GI_CLUSTER_LIMIT - 1);
}

static uint32_t begin_cluster(GiClusters *clusters) {
    uint32_t id = (uint32_t)clusters->cluster_count++;
    GiBuildItem *cluster = &clusters->clusters[id];
    gi_four_store(cluster->low, gi_four(INFINITY));
    gi_four_store(cluster->high, gi_four(-INFINITY));
    clusters->weights[id] = 0;
    return id;
}

static inline void add_item(GiClusters *clusters, const Grid *grid, GiBuildItem *item) {
    uint16_t *cell = &clusters->cells[cell_of(grid, item)];
    if (*cell == 0) *cell = (uint16_t)(begin_cluster(clusters) + 1);
    uint32_t id = *cell - 1u;
    GiBuildItem *cluster = &clusters->clusters[id];
    GiFour low = gi_four_load(item->low), high = gi_four_load(item->high);
    gi_four_store(cluster->low, gi_four_min(gi_four_load(cluster->low), low));
    gi_four_store(cluster->high, gi_four_max(gi_four_load(cluster->high), high));
    clusters->weights[id]++;
    note_cluster(item, id);
}

/* From four places by turns, as items are put into bins (split.c). */
bool gi_clusters_make(
    GiClusters *clusters, GiBuildItem *items, const GiRange *range, const GiBounds *centers) {
    size_t count = range->end - range->begin, quarter = count / 4;
    items += range->begin;
    Grid grid = choose_grid(centers, count);
    if (grid.cell_count == 1) return false;
    memset(clusters->cells, 0, grid.cell_count * sizeof *clusters->cells);
    clusters->cluster_count = clusters->bucket_count = 0;
    clusters->begin = range->begin;
    for (size_t i = 0; i < quarter; i++) {
        add_item(clusters, &grid, &items[i]);
        add_item(clusters, &grid, &items[i + quarter]);
        add_item(clusters, &grid, &items[i + 2 * quarter]);
        add_item(clusters, &grid, &items[i + 3 * quarter]);
    }
    for (size_t i = 4 * quarter; i < count; i++) add_item(clusters, &grid, &items[i]);
    for (uint32_t i = 0; i < clusters->cluster_count; i++) {
        const GiBounds box = gi_build_box(&clusters->clusters[i]);
        gi_build_set(&clusters->clusters[i], &box, i);
    }
    return true;
}

/* ---------------------------------------------------------------- buckets */

size_t gi_clusters_weight(const GiClusters *clusters, size_t begin, size_t end) {
    size_t weight = 0;
    for (size_t i = begin; i < end; i++) {
        weight += clusters->weights[gi_build_id(&clusters->clusters[i])];
    }
    return weight;
}

void gi_clusters_close(GiClusters *clusters, size_t begin, size_t end, uint32_t node, int depth) {
    size_t index = clusters->bucket_count++;
    uint32_t first = index > 0 ? clusters->buckets[index - 1].end : clusters->begin;
    uint32_t weight = (uint32_t)gi_clusters_weight(clusters, begin, end);
    clusters->buckets[index] = (GiRange){node, first, first + weight, depth};
    clusters->heads[index] = first;
    for (size_t i = begin; i < end; i++) {
        clusters->bucket_of[gi_build_id(&clusters->clusters[i])] = (uint16_t)index;
    }
}

/* An item without a place, and a place without an item. */
typedef struct Hand {
    GiBuildItem item;
    GiBuildItem *hole;
} Hand;

static inline Hand take(GiBuildItem *place) { return (Hand){*place, place}; }

/* Items from a bucket's places are traded for the next ones in the buckets they belong to, until
 * such come as belong here. Several hands do that by turns: what one waits for, the others do. */
static void fill_bucket(GiClusters *clusters, GiBuildItem *items, size_t bucket) {
    enum { HANDS = 4, AHEAD = 4 };
    uint32_t *heads = clusters->heads, end = clusters->buckets[bucket].end;
    Hand hands[HANDS];
    int count = 0;
    while (count < HANDS && heads[bucket] < end) hands[count++] = take(&items[heads[bucket]++]);
    for (int i = 0; count > 0; i = i + 1 < count ? i + 1 : 0) {
        Hand *hand = &hands[i];
        size_t to = clusters->bucket_of[noted_cluster(&hand->item)];
        if (to != bucket) {
            GiBuildItem *place = &items[heads[to]++], next = *place;
            *place = hand->item;
            hand->item = next;
            gi_prefetch_ahead(place, AHEAD * sizeof *place);
        } else {
            *hand->hole = hand->item;
            *hand = heads[bucket] < end ? take(&items[heads[bucket]++]) : hands[--count];
        }
    }
}

void gi_clusters_sort(GiClusters *clusters, GiBuildItem *items) {
    for (size_t i = 0; i < clusters->bucket_count; i++) fill_bucket(clusters, items, i);
}
