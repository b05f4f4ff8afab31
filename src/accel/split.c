/* SPDX-License-Identifier: MIT
 * The best of 3 x 15 planes (fewer for few items) between 16 bins of the centres. The boxes of both
 * sides come from the bins, the bounds of their centres from the sorting to the sides, so that a
 * level of the tree takes two passes over the items. */
#include "accel/split.h"

#include <float.h>
#include <string.h>

enum {
    BIN_COUNT = 16,
    FEW_BINS = 8, /* for few items the bins cost more than the items do */
    FEW_ITEMS = 64,
    BLOCK_SIZE = 64, /* of partition */
    SOME_ITEMS = 128 /* that fit into its buffer; two blocks at least */
};

GiBounds gi_bounds_of(const GiBuildItem *items, size_t count) {
    GiBounds bounds = gi_bounds_empty();
    for (size_t i = 0; i < count; i++) {
        gi_bounds_grow(&bounds, gi_four_load(items[i].low), gi_four_load(items[i].high));
    }
    return bounds;
}

/* Two bounds at once, since each step has to wait for the one before it. */
GiBounds gi_centers_of(const GiBuildItem *items, size_t count) {
    GiBounds even = gi_bounds_empty(), odd = gi_bounds_empty();
    for (size_t i = 0; i + 2 <= count; i += 2) {
        GiFour a = gi_build_center(&items[i]), b = gi_build_center(&items[i + 1]);
        gi_bounds_grow(&even, a, a);
        gi_bounds_grow(&odd, b, b);
    }
    GiFour last = gi_build_center(&items[count - 1]);
    gi_bounds_grow(&even, last, last);
    gi_bounds_grow(&even, odd.low, odd.high);
    return even;
}

/* ---------------------------------------------------------------- the bins */

typedef struct Split {
    int axis; /* -1: none */
    int bin;  /* items of bins below it go left */
    float cost;
} Split;

/* Maps centres to bins: bin = (center - low) * scale. Where all centres have the same coordinate,
 * all fall into the first. */
typedef struct Binning {
    GiFour low, scale;
    int count;
} Binning;

/* By bin and axis, so that one step of the search looks at three axes. */
typedef struct Bins {
    GiBounds bounds[BIN_COUNT][3];
    int32_t counts[BIN_COUNT][4];
} Bins;

static Binning binning_of(const GiBounds *centers, int bin_count) {
    /* A little less than the number of bins, so that the last centre falls into the last. */
    GiFour extent = gi_four_sub(centers->high, centers->low);
    GiFour scale = gi_four_divide(gi_four(0.9999f * (float)bin_count), extent);
    scale = gi_four_select_less(gi_four(FLT_MIN * 64), extent, scale, gi_four(0));
    return (Binning){centers->low, scale, bin_count};
}

static inline GiFour place_of(const Binning *binning, GiFour center) {
    return gi_four_multiply(gi_four_sub(center, binning->low), binning->scale);
}

static inline void bin_item(
    const GiBuildItem *item, const uint32_t *weights, const Binning *binning, Bins *bins) {
    int32_t weight = weights == NULL ? 1 : (int32_t)weights[gi_build_id(item)];
    int32_t bin[4];
    gi_four_to_int(place_of(binning, gi_build_center(item)), bin);
    GiFour low = gi_four_load(item->low), high = gi_four_load(item->high);
    for (int axis = 0; axis < 3; axis++) {
        gi_bounds_grow(&bins->bounds[bin[axis]][axis], low, high);
        bins->counts[bin[axis]][axis] += weight;
    }
}

/* From four places by turns: neighbours in a file are often neighbours in space, and what goes to
 * the bin of the item before has to wait for it. */
static inline void fill_bins(const GiBuildItem *items, const uint32_t *weights, size_t count,
    const Binning *binning, Bins *bins) {
    const GiBounds empty = gi_bounds_empty();
    for (int i = 0; i < binning->count; i++) {
        for (int axis = 0; axis < 3; axis++) bins->bounds[i][axis] = empty;
        memset(bins->counts[i], 0, sizeof bins->counts[i]);
    }
    size_t quarter = count / 4;
    for (size_t i = 0; i < quarter; i++) {
        bin_item(&items[i], weights, binning, bins);
        bin_item(&items[i + quarter], weights, binning, bins);
        bin_item(&items[i + 2 * quarter], weights, binning, bins);
        bin_item(&items[i + 3 * quarter], weights, binning, bins);
    }
    for (size_t i = 4 * quarter; i < count; i++) bin_item(&items[i], weights, binning, bins);
}

/* Half the surfaces of three boxes, as gi_build_area has it. */
static inline GiFour areas_of(const GiBounds bounds[3]) {
    GiFour extent[3];
    gi_four_transpose(gi_four_sub(bounds[0].high, bounds[0].low),
        gi_four_sub(bounds[1].high, bounds[1].low), gi_four_sub(bounds[2].high, bounds[2].low),
        extent);
    GiFour xy = gi_four_multiply(extent[0], extent[1]), yz = gi_four_multiply(extent[1], extent[2]);
    return gi_four_add(gi_four_add(xy, yz), gi_four_multiply(extent[2], extent[0]));
}

/* What `count` items cost a ray that enters their box: the tests of blocks of eight, and for few
 * items, where a block is never full, of the items too. */
static inline GiFour costs_of(GiFour count) {
    const float per_block = 1.0f / GI_BUILD_LEAF_SIZE;
    GiFour full = gi_four_add(count, gi_four(GI_BUILD_LEAF_SIZE - 1));
    GiFour blocks = gi_four_truncate(gi_four_multiply(full, gi_four(per_block)));
    GiFour few =
        gi_four_add(gi_four_multiply(gi_four(0.5f), count), gi_four_multiply(gi_four(4), blocks));
    return gi_four_select_less(count, gi_four(FEW_ITEMS + 1), few, count);
}

static inline void add_bin(const Bins *bins, int bin, GiBounds bounds[3], GiFour *count) {
    for (int axis = 0; axis < 3; axis++) {
        gi_bounds_grow(&bounds[axis], bins->bounds[bin][axis].low, bins->bounds[bin][axis].high);
    }
    *count = gi_four_add(*count, gi_four_of_int(bins->counts[bin]));
}

/* The three axes side by side. Where a side has no items the cost is not a number (an infinite area
 * times nothing), and never the least. */
static Split find_split(const Bins *bins, int bin_count) {
    GiFour right_cost[BIN_COUNT];
    GiBounds bounds[3] = {gi_bounds_empty(), gi_bounds_empty(), gi_bounds_empty()};
    GiFour count = gi_four(0);
    for (int i = bin_count - 1; i > 0; i--) {
        add_bin(bins, i, bounds, &count);
        right_cost[i] = gi_four_multiply(areas_of(bounds), costs_of(count));
    }
    for (int axis = 0; axis < 3; axis++) bounds[axis] = gi_bounds_empty();
    count = gi_four(0);
    GiFour least = gi_four(FLT_MAX), least_bin = gi_four(0);
    for (int i = 1; i < bin_count; i++) {
        add_bin(bins, i - 1, bounds, &count);
        GiFour cost = gi_four_multiply(areas_of(bounds), costs_of(count));
        cost = gi_four_add(cost, right_cost[i]);
        least_bin = gi_four_select_less(cost, least, gi_four((float)i), least_bin);
        least = gi_four_min(cost, least);
    }
    float costs[4];
    int32_t at[4];
    gi_four_store(costs, least);
    gi_four_to_int(least_bin, at);
    Split best = {-1, 0, FLT_MAX};
    for (int axis = 0; axis < 3; axis++) {
        if (costs[axis] < best.cost) best = (Split){axis, at[axis], costs[axis]};
    }
    return best;
}

static GiBounds join_bins(const Bins *bins, int axis, int begin, int end) {
    GiBounds bounds = gi_bounds_empty();
    for (int i = begin; i < end; i++) {
        gi_bounds_grow(&bounds, bins->bounds[i][axis].low, bins->bounds[i][axis].high);
    }
    return bounds;
}

/* Which side an item goes to cannot be foretold, so a branch on it would cost more than all else.
 */
typedef struct Side {
    Binning binning;
    GiFour limit; /* below it on the split's axis: left */
} Side;

static inline bool goes_left(const Side *side, const GiBuildItem *item) {
    return gi_four_any_less(place_of(&side->binning, gi_build_center(item)), side->limit);
}

/* Few items: those on the right wait in a buffer. */
static size_t partition_few(GiBuildItem *items, size_t count, const Side *side) {
    GiBuildItem wait[SOME_ITEMS];
    size_t left = 0, right = 0;
    for (size_t i = 0; i < count; i++) {
        GiBuildItem item = items[i];
        bool is_left = goes_left(side, &item);
        items[left] = item;
        wait[right] = item;
        left += is_left;
        right += !is_left;
    }
    memcpy(items + left, wait, right * sizeof *wait);
    return left;
}

/* Takes blocks from both ends, notes who stands on the wrong side, and swaps those (Edelkamp and
 * Weiss 2016). So what need not move is not written, which counts where a range is larger than the
 * caches. */
static size_t partition(GiBuildItem *items, size_t count, const Side *side) {
    uint8_t wrong_left[BLOCK_SIZE], wrong_right[BLOCK_SIZE];
    size_t begin = 0, end = count;
    int left_first = 0, left_count = 0, right_first = 0, right_count = 0;
    while (end - begin > SOME_ITEMS) {
        if (left_count == 0) {
            left_first = 0;
            for (int i = 0; i < BLOCK_SIZE; i++) {
                wrong_left[left_count] = (uint8_t)i;
                left_count += !goes_left(side, &items[begin + (size_t)i]);
            }
        }
        if (right_count == 0) {
            right_first = 0;
            for (int i = 0; i < BLOCK_SIZE; i++) {
                wrong_right[right_count] = (uint8_t)i;
                right_count += goes_left(side, &items[end - 1 - (size_t)i]);
            }
        }
        int swaps = left_count < right_count ? left_count : right_count;
        for (int i = 0; i < swaps; i++) {
            GiBuildItem *a = &items[begin + wrong_left[left_first + i]];
            GiBuildItem *b = &items[end - 1 - wrong_right[right_first + i]];
            GiBuildItem swap = *a;
            *a = *b;
            *b = swap;
        }
        left_first += swaps;
        left_count -= swaps;
        right_first += swaps;
        right_count -= swaps;
        if (left_count == 0) begin += BLOCK_SIZE;
        if (right_count == 0) end -= BLOCK_SIZE;
    }
    return begin + partition_few(items + begin, end - begin, side);
}

/* ---------------------------------------------------------------- the whole */

size_t gi_split(GiBuildItem *items, size_t count, const uint32_t *weights, GiBounds sides[2]) {
    Bins bins;
    GiBounds centers = gi_centers_of(items, count);
    bool few = count <= FEW_ITEMS && weights == NULL;
    Binning binning = binning_of(&centers, few ? FEW_BINS : BIN_COUNT);
    if (weights == NULL) {
        fill_bins(items, NULL, count, &binning, &bins);
    } else {
        fill_bins(items, weights, count, &binning, &bins);
    }
    Split split = find_split(&bins, binning.count);
    if (split.axis < 0) return 0;
    sides[0] = join_bins(&bins, split.axis, 0, split.bin);
    sides[1] = join_bins(&bins, split.axis, split.bin, binning.count);
    float limits[4] = {-1, -1, -1, -1};
    limits[split.axis] = (float)split.bin;
    const Side side = {binning, gi_four_load(limits)};
    return partition(items, count, &side);
}
