/* SPDX-License-Identifier: MIT
 * Top down. A node's items are split at the best of 3 x 15 planes (fewer for few items) between 16
 * bins of their centres. A range knows its bounds when it is made: the boxes of both sides come
 * from the bins, the bounds of their centres from the sorting to the sides, so that a level of the
 * tree takes two passes over the items. Large subtrees become tasks for other workers; below
 * TASK_SIZE a worker finishes alone with a stack of its own, always putting off the larger half, so
 * that the stack stays short. */
#include "accel/build.h"

#include "math/four.h"
#include "sched/tasks.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum {
    BIN_COUNT = 16,
    FEW_BINS = 8, /* for few items the bins cost more than the items do */
    FEW_ITEMS = 64,
    BLOCK_SIZE = 64, /* of partition */
    TASK_SIZE = 4096,
    SAH_DEPTH_LIMIT = 60, /* deeper, halves are of equal size: the depth stays below 96 */
    STACK_SIZE = 64
};

typedef struct Build {
    GiBuildItem *items;
    GiBuildNode *nodes;
    _Atomic uint32_t node_count;
    _Atomic size_t done; /* items in finished leaves */
    _Atomic bool stop;
    size_t count;
    const GlintMonitor *monitor;
} Build;

/* A box; the fourth lane holds nothing of use. */
typedef struct Bounds {
    GiFour low, high;
} Bounds;

static inline Bounds empty_bounds(void) { return (Bounds){gi_four(INFINITY), gi_four(-INFINITY)}; }

static inline void grow(Bounds *bounds, GiFour low, GiFour high) {
    bounds->low = gi_four_min(bounds->low, low);
    bounds->high = gi_four_max(bounds->high, high);
}

/* Twice the centre; the factor does not matter to the bins. */
static inline GiFour center_of(const GiBuildItem *item) {
    return gi_four_add(gi_four_load(item->low), gi_four_load(item->high));
}

static inline void grow_item(Bounds *bounds, Bounds *centers, const GiBuildItem *item) {
    GiFour center = center_of(item);
    grow(bounds, gi_four_load(item->low), gi_four_load(item->high));
    grow(centers, center, center);
}

/* Two bounds at once, since each step has to wait for the one before it. */
static void bound_items(const GiBuildItem *items, size_t count, Bounds *bounds, Bounds *centers) {
    Bounds all = empty_bounds(), middle = empty_bounds();
    Bounds all2 = empty_bounds(), middle2 = empty_bounds();
    size_t i = 0;
    for (; i + 2 <= count; i += 2) {
        grow_item(&all, &middle, &items[i]);
        grow_item(&all2, &middle2, &items[i + 1]);
    }
    if (i < count) grow_item(&all, &middle, &items[i]);
    grow(&all, all2.low, all2.high);
    grow(&middle, middle2.low, middle2.high);
    *bounds = all;
    *centers = middle;
}

/* ---------------------------------------------------------------- the split */

/* Items that are to become a subtree. */
typedef struct Range {
    Bounds bounds, centers;
    uint32_t node, begin, end;
    int depth;
} Range;

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
    Bounds bounds[BIN_COUNT][3];
    int32_t counts[BIN_COUNT][4];
} Bins;

static Binning binning_of(const Bounds *centers, size_t item_count) {
    float low[4], high[4], scale[4] = {0};
    gi_four_store(low, centers->low);
    gi_four_store(high, centers->high);
    Binning binning = {.low = centers->low};
    binning.count = item_count <= FEW_ITEMS ? FEW_BINS : BIN_COUNT;
    for (int axis = 0; axis < 3; axis++) {
        float extent = high[axis] - low[axis];
        /* A little less than the number of bins, so that the last centre falls into the last. */
        scale[axis] = extent > FLT_MIN * 64 ? (float)binning.count * 0.9999f / extent : 0;
    }
    binning.scale = gi_four_load(scale);
    return binning;
}

static inline GiFour place_of(const Binning *binning, GiFour center) {
    return gi_four_multiply(gi_four_sub(center, binning->low), binning->scale);
}

static inline void bin_item(const GiBuildItem *item, const Binning *binning, Bins *bins) {
    int32_t bin[4];
    gi_four_to_int(place_of(binning, center_of(item)), bin);
    GiFour low = gi_four_load(item->low), high = gi_four_load(item->high);
    for (int axis = 0; axis < 3; axis++) {
        grow(&bins->bounds[bin[axis]][axis], low, high);
        bins->counts[bin[axis]][axis]++;
    }
}

/* From four places by turns: neighbours in a file are often neighbours in space, and what goes to
 * the bin of the item before has to wait for it. */
static void fill_bins(const GiBuildItem *items, size_t count, const Binning *binning, Bins *bins) {
    const Bounds empty = empty_bounds();
    for (int i = 0; i < binning->count; i++) {
        for (int axis = 0; axis < 3; axis++) bins->bounds[i][axis] = empty;
        memset(bins->counts[i], 0, sizeof bins->counts[i]);
    }
    size_t quarter = count / 4;
    for (size_t i = 0; i < quarter; i++) {
        bin_item(&items[i], binning, bins);
        bin_item(&items[i + quarter], binning, bins);
        bin_item(&items[i + 2 * quarter], binning, bins);
        bin_item(&items[i + 3 * quarter], binning, bins);
    }
    for (size_t i = 4 * quarter; i < count; i++) bin_item(&items[i], binning, bins);
}

/* Half the surfaces of three boxes, as gi_build_area has it. */
static inline GiFour areas_of(const Bounds bounds[3]) {
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

static inline void add_bin(const Bins *bins, int bin, Bounds bounds[3], GiFour *count) {
    for (int axis = 0; axis < 3; axis++) {
        grow(&bounds[axis], bins->bounds[bin][axis].low, bins->bounds[bin][axis].high);
    }
    *count = gi_four_add(*count, gi_four_of_int(bins->counts[bin]));
}

/* The three axes side by side. Where a side has no items the cost is not a number (an infinite area
 * times nothing), and never the least. */
static Split find_split(const Bins *bins, int bin_count) {
    GiFour right_cost[BIN_COUNT];
    Bounds bounds[3] = {empty_bounds(), empty_bounds(), empty_bounds()};
    GiFour count = gi_four(0);
    for (int i = bin_count - 1; i > 0; i--) {
        add_bin(bins, i, bounds, &count);
        right_cost[i] = gi_four_multiply(areas_of(bounds), costs_of(count));
    }
    for (int axis = 0; axis < 3; axis++) bounds[axis] = empty_bounds();
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

static Bounds join_bins(const Bins *bins, int axis, int begin, int end) {
    Bounds bounds = empty_bounds();
    for (int i = begin; i < end; i++) {
        grow(&bounds, bins->bounds[i][axis].low, bins->bounds[i][axis].high);
    }
    return bounds;
}

static inline void grow_unless(bool hidden, Bounds *bounds, GiFour point) {
    GiFour seen = gi_four_hide(point, hidden);
    bounds->low = gi_four_min(seen, bounds->low);
    bounds->high = gi_four_max(seen, bounds->high);
}

/* Sorts items to two sides and gathers the bounds of both. Which side an item goes to cannot be
 * foretold, so a branch on it would cost more than all else: each item is held against both
 * sides' bounds, hidden from one. */
typedef struct Sorting {
    Binning binning;
    GiFour limit; /* below it on the split's axis: left */
    Bounds left_centers, right_centers;
} Sorting;

static inline bool sort_item(Sorting *sorting, const GiBuildItem *item) {
    GiFour center = center_of(item);
    bool goes_left = gi_four_any_less(place_of(&sorting->binning, center), sorting->limit);
    grow_unless(!goes_left, &sorting->left_centers, center);
    grow_unless(goes_left, &sorting->right_centers, center);
    return goes_left;
}

/* Takes blocks from both ends, notes who stands on the wrong side, and swaps those (Edelkamp and
 * Weiss 2016). So what need not move is not written, which counts where a range is larger than the
 * caches. */
static inline size_t partition(GiBuildItem *items, size_t count, Sorting *shared) {
    Sorting sorting = *shared;
    uint8_t wrong_left[BLOCK_SIZE], wrong_right[BLOCK_SIZE];
    size_t begin = 0, end = count;
    int left_first = 0, left_count = 0, right_first = 0, right_count = 0;
    while (end - begin > 2 * BLOCK_SIZE) {
        if (left_count == 0) {
            left_first = 0;
            for (int i = 0; i < BLOCK_SIZE; i++) {
                wrong_left[left_count] = (uint8_t)i;
                left_count += !sort_item(&sorting, &items[begin + (size_t)i]);
            }
        }
        if (right_count == 0) {
            right_first = 0;
            for (int i = 0; i < BLOCK_SIZE; i++) {
                wrong_right[right_count] = (uint8_t)i;
                right_count += sort_item(&sorting, &items[end - 1 - (size_t)i]);
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
    /* Of the rest each is swapped to the end of the left part, and stays there if it belongs there.
     * Some are met a second time; bounds do not mind. */
    size_t left = begin;
    for (size_t i = begin; i < end; i++) {
        GiBuildItem item = items[i];
        items[i] = items[left];
        items[left] = item;
        left += sort_item(&sorting, &item);
    }
    *shared = sorting;
    return left;
}

/* Where no plane parts the centres, or the tree gets too deep. */
static size_t halve(const GiBuildItem *items, size_t count, Range *left, Range *right) {
    size_t middle = count / 2;
    bound_items(items, middle, &left->bounds, &left->centers);
    bound_items(items + middle, count - middle, &right->bounds, &right->centers);
    return middle;
}

static size_t divide(GiBuildItem *items, const Range *range, Range *left, Range *right) {
    size_t count = range->end - range->begin;
    if (range->depth >= SAH_DEPTH_LIMIT) return halve(items, count, left, right);
    Binning binning = binning_of(&range->centers, count);
    Bins bins;
    fill_bins(items, count, &binning, &bins);
    Split split = find_split(&bins, binning.count);
    if (split.axis < 0) return halve(items, count, left, right);
    left->bounds = join_bins(&bins, split.axis, 0, split.bin);
    right->bounds = join_bins(&bins, split.axis, split.bin, binning.count);
    float limits[4] = {-1, -1, -1, -1};
    limits[split.axis] = (float)split.bin;
    Sorting sorting = {binning, gi_four_load(limits), empty_bounds(), empty_bounds()};
    size_t middle = partition(items, count, &sorting);
    left->centers = sorting.left_centers;
    right->centers = sorting.right_centers;
    return middle;
}

/* Splits the range in two, or makes it a leaf and returns false. */
static bool split_range(Build *build, const Range *range, Range *left, Range *right) {
    GiBuildNode *node = &build->nodes[range->node];
    float low[4], high[4];
    gi_four_store(low, range->bounds.low);
    gi_four_store(high, range->bounds.high);
    memcpy(node->low, low, sizeof node->low);
    memcpy(node->high, high, sizeof node->high);
    node->first = range->begin;
    node->count = range->end - range->begin;
    if (node->count <= GI_BUILD_LEAF_SIZE) return false;
    size_t middle = divide(build->items + range->begin, range, left, right);
    node->first = atomic_fetch_add(&build->node_count, 2);
    node->count = 0;
    left->node = node->first;
    left->begin = range->begin;
    left->end = right->begin = range->begin + (uint32_t)middle;
    right->node = node->first + 1;
    right->end = range->end;
    left->depth = right->depth = range->depth + 1;
    return true;
}

/* ---------------------------------------------------------------- the tasks */

static void run_task(GiTasks *tasks, void *context, const void *task, int worker) {
    Build *build = context;
    Range stack[STACK_SIZE], range, left, right;
    int depth = 0;
    memcpy(&range, task, sizeof range);
    for (;;) {
        if (atomic_load_explicit(&build->stop, memory_order_relaxed)) return;
        size_t count = range.end - range.begin;
        if (worker == 0 && count >= 256 && build->monitor != NULL) {
            const GlintMonitor *monitor = build->monitor;
            size_t done = atomic_load_explicit(&build->done, memory_order_relaxed);
            if (monitor->progress != NULL) {
                monitor->progress(
                    monitor->user, GLINT_PHASE_BUILD, 0.9 * (double)done / (double)build->count);
            }
            if (monitor->cancelled != NULL && monitor->cancelled(monitor->user)) {
                atomic_store(&build->stop, true);
            }
        }
        if (split_range(build, &range, &left, &right)) {
            if (left.end - left.begin > right.end - right.begin) {
                Range swap = left;
                left = right;
                right = swap;
            }
            range = left;
            if (count < TASK_SIZE || !gi_tasks_add(tasks, &right)) stack[depth++] = right;
        } else {
            atomic_fetch_add_explicit(&build->done, count, memory_order_relaxed);
            if (depth == 0) return;
            range = stack[--depth];
        }
    }
}

GlintStatus gi_build(GiMemory *memory, GiPool *pool, GiBuildItem *items, size_t count,
    const GlintMonitor *monitor, GiBuildTree *tree) {
    tree->node_capacity = 2 * count;
    tree->nodes = gi_memory_allocate(memory, tree->node_capacity * sizeof *tree->nodes);
    if (tree->nodes == NULL) return GLINT_ERROR_MEMORY;
    Build build = {.items = items, .nodes = tree->nodes, .count = count, .monitor = monitor};
    atomic_init(&build.node_count, 1);
    Range all = {.end = (uint32_t)count};
    bound_items(items, count, &all.bounds, &all.centers);
    GlintStatus status = gi_tasks_run(pool, memory, &all, sizeof all, run_task, &build);
    if (status == GLINT_OK && atomic_load(&build.stop)) status = GLINT_CANCELLED;
    tree->node_count = atomic_load(&build.node_count);
    /* Leaves hold seven items, but might have held one each. */
    GiBuildNode *nodes = gi_memory_resize(
        memory, tree->nodes, tree->node_capacity * sizeof *nodes, tree->node_count * sizeof *nodes);
    if (nodes != NULL) {
        tree->nodes = nodes;
        tree->node_capacity = tree->node_count;
    }
    return status;
}

void gi_build_free(GiMemory *memory, GiBuildTree *tree) {
    gi_memory_free(memory, tree->nodes, tree->node_capacity * sizeof *tree->nodes);
    tree->nodes = NULL;
}
