/* SPDX-License-Identifier: MIT
 * Top down. A node's items are split at the best of 3 x 15 planes (fewer for few items) between 16
 * bins of their centres. Large subtrees become tasks for other workers; below TASK_SIZE a worker
 * finishes alone with a stack of its own, always putting off the larger half, so that the stack
 * stays short. */
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
    TASK_SIZE = 4096,
    SAH_DEPTH_LIMIT = 60, /* deeper, halves are of equal size: the depth stays below 96 */
    STACK_SIZE = 64
};

typedef struct Range {
    uint32_t node, begin, end;
    int depth;
} Range;

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

static inline float area_of(const Bounds *bounds) {
    float low[4], high[4];
    gi_four_store(low, bounds->low);
    gi_four_store(high, bounds->high);
    return gi_build_area(low, high);
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

typedef struct Split {
    int axis; /* -1: none */
    int bin;  /* items of bins below it go left */
    float cost;
} Split;

/* Maps centres to bins: bin = (center - low) * scale. */
typedef struct Binning {
    GiFour low, scale;
    bool flat[3]; /* all centres have the same coordinate */
    int count;
} Binning;

static Binning binning_of(const Bounds *centers, size_t item_count) {
    float low[4], high[4], scale[4] = {0};
    gi_four_store(low, centers->low);
    gi_four_store(high, centers->high);
    Binning binning = {.count = item_count <= FEW_ITEMS ? FEW_BINS : BIN_COUNT};
    for (int axis = 0; axis < 3; axis++) {
        float extent = high[axis] - low[axis];
        binning.flat[axis] = !(extent > FLT_MIN * 64);
        /* A little less than the number of bins, so that the last centre falls into the last. */
        scale[axis] = binning.flat[axis] ? 0 : (float)binning.count * 0.9999f / extent;
    }
    binning.low = centers->low;
    binning.scale = gi_four_load(scale);
    return binning;
}

static inline void bins_of(const Binning *binning, const GiBuildItem *item, int32_t bins[4]) {
    GiFour place = gi_four_sub(center_of(item), binning->low);
    gi_four_to_int(gi_four_multiply(place, binning->scale), bins);
}

/* What `count` items cost a ray that enters their box: the tests of blocks of eight, and for few
 * items, where a block is never full, of the items too. */
static inline float cost_of(uint32_t count) {
    float blocks = (float)((count + GI_BUILD_LEAF_SIZE - 1) / GI_BUILD_LEAF_SIZE);
    return count <= 64 ? 0.5f * (float)count + 4 * blocks : (float)count;
}

static Split find_split(const GiBuildItem *items, size_t count, const Binning *binning) {
    Bounds bins[3][BIN_COUNT];
    uint32_t counts[3][BIN_COUNT] = {{0}};
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < binning->count; i++) bins[axis][i] = empty_bounds();
    }
    for (size_t i = 0; i < count; i++) {
        int32_t bin[4];
        bins_of(binning, &items[i], bin);
        GiFour low = gi_four_load(items[i].low), high = gi_four_load(items[i].high);
        for (int axis = 0; axis < 3; axis++) {
            grow(&bins[axis][bin[axis]], low, high);
            counts[axis][bin[axis]]++;
        }
    }
    Split best = {-1, 0, FLT_MAX};
    for (int axis = 0; axis < 3; axis++) {
        if (binning->flat[axis]) continue;
        float right_cost[BIN_COUNT];
        Bounds bounds = empty_bounds();
        uint32_t below = 0;
        for (int i = binning->count - 1; i > 0; i--) {
            grow(&bounds, bins[axis][i].low, bins[axis][i].high);
            below += counts[axis][i];
            right_cost[i] = below == 0 ? 0 : area_of(&bounds) * cost_of(below);
        }
        bounds = empty_bounds();
        below = 0;
        for (int i = 1; i < binning->count; i++) {
            grow(&bounds, bins[axis][i - 1].low, bins[axis][i - 1].high);
            below += counts[axis][i - 1];
            if (below == 0 || below == count) continue;
            float cost = area_of(&bounds) * cost_of(below) + right_cost[i];
            if (cost < best.cost) best = (Split){axis, i, cost};
        }
    }
    return best;
}

static inline bool goes_left(const GiBuildItem *item, const Binning *binning, Split split) {
    int32_t bins[4];
    bins_of(binning, item, bins);
    return bins[split.axis] < split.bin;
}

/* Every item is swapped to the end of the left part, and stays there when it belongs there: which
 * side an item goes to cannot be foretold, so a branch on it would cost more than the moves. */
static size_t partition(GiBuildItem *items, size_t count, const Binning *binning, Split split) {
    size_t left = 0;
    for (size_t i = 0; i < count; i++) {
        GiBuildItem item = items[i];
        items[i] = items[left];
        items[left] = item;
        left += goes_left(&item, binning, split);
    }
    return left;
}

/* Splits the range in two, or makes it a leaf and returns false. */
static bool split_range(Build *build, Range range, Range *left, Range *right) {
    GiBuildItem *items = build->items + range.begin;
    size_t count = range.end - range.begin;
    Bounds bounds, centers;
    bound_items(items, count, &bounds, &centers);
    GiBuildNode *node = &build->nodes[range.node];
    float low[4], high[4];
    gi_four_store(low, bounds.low);
    gi_four_store(high, bounds.high);
    memcpy(node->low, low, sizeof node->low);
    memcpy(node->high, high, sizeof node->high);
    size_t middle = 0;
    if (count > GI_BUILD_LEAF_SIZE && range.depth < SAH_DEPTH_LIMIT) {
        Binning binning = binning_of(&centers, count);
        Split split = find_split(items, count, &binning);
        if (split.axis >= 0) middle = partition(items, count, &binning, split);
    }
    if (middle == 0 && count > GI_BUILD_LEAF_SIZE) middle = count / 2; /* all centres are one */
    if (middle == 0) {
        node->first = range.begin;
        node->count = (uint32_t)count;
        return false;
    }
    uint32_t child = atomic_fetch_add(&build->node_count, 2);
    node->first = child;
    node->count = 0;
    uint32_t at = range.begin + (uint32_t)middle;
    *left = (Range){child, range.begin, at, range.depth + 1};
    *right = (Range){child + 1, at, range.end, range.depth + 1};
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
        if (split_range(build, range, &left, &right)) {
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
    Range all = {0, 0, (uint32_t)count, 0};
    GlintStatus status = gi_tasks_run(pool, memory, &all, sizeof all, run_task, &build);
    if (status == GLINT_OK && atomic_load(&build.stop)) status = GLINT_CANCELLED;
    tree->node_count = atomic_load(&build.node_count);
    return status;
}

void gi_build_free(GiMemory *memory, GiBuildTree *tree) {
    gi_memory_free(memory, tree->nodes, tree->node_capacity * sizeof *tree->nodes);
    tree->nodes = NULL;
}
