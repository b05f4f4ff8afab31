/* SPDX-License-Identifier: MIT
 * Top down. A node's items are split at the best of 3 x 15 planes between 16 bins of their centres.
 * Large subtrees become tasks for other workers; below TASK_SIZE a worker finishes alone with a
 * stack of its own, always putting off the larger half, so that the stack stays short. */
#include "accel/build.h"

#include "sched/tasks.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum {
    BIN_COUNT = 16,
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

typedef struct Bounds { float low[3], high[3]; } Bounds;

static const Bounds empty_bounds = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static inline float minimum(float a, float b) { return a < b ? a : b; }
static inline float maximum(float a, float b) { return a > b ? a : b; }

static inline void grow(Bounds *bounds, const float low[3], const float high[3]) {
    for (int axis = 0; axis < 3; axis++) {
        bounds->low[axis] = minimum(bounds->low[axis], low[axis]);
        bounds->high[axis] = maximum(bounds->high[axis], high[axis]);
    }
}

/* Twice the centre; the factor does not matter to the bins. */
static inline float center_of(const GiBuildItem *item, int axis) {
    return item->low[axis] + item->high[axis];
}

static void bound_items(const GiBuildItem *items, size_t count, Bounds *bounds, Bounds *centers) {
    *bounds = *centers = empty_bounds;
    for (size_t i = 0; i < count; i++) {
        grow(bounds, items[i].low, items[i].high);
        float center[3] = {
            center_of(&items[i], 0), center_of(&items[i], 1), center_of(&items[i], 2)};
        grow(centers, center, center);
    }
}

/* ---------------------------------------------------------------- the split */

typedef struct Bin { Bounds bounds; uint32_t count; } Bin;

typedef struct Split {
    int axis; /* -1: none */
    int bin;  /* items of bins below it go left */
    float cost;
} Split;

/* Maps centres to bins: bin = (center - low) * scale. */
typedef struct Binning { float low[3], scale[3]; } Binning;

static Binning binning_of(const Bounds *centers) {
    Binning binning;
    for (int axis = 0; axis < 3; axis++) {
        float extent = centers->high[axis] - centers->low[axis];
        binning.low[axis] = centers->low[axis];
        /* A little less than the number of bins, so that the last centre falls into the last. */
        binning.scale[axis] = extent > FLT_MIN * 64 ? BIN_COUNT * 0.9999f / extent : 0;
    }
    return binning;
}

static inline int bin_of(const Binning *binning, const GiBuildItem *item, int axis) {
    return (int)((center_of(item, axis) - binning->low[axis]) * binning->scale[axis]);
}

/* What `count` items cost a ray that enters their box: the tests of blocks of eight, and for few
 * items, where a block is never full, of the items too. */
static inline float cost_of(uint32_t count) {
    float blocks = (float)((count + GI_BUILD_LEAF_SIZE - 1) / GI_BUILD_LEAF_SIZE);
    return count <= 64 ? 0.5f * (float)count + 4 * blocks : (float)count;
}

static Split find_split(const GiBuildItem *items, size_t count, const Binning *binning) {
    Bin bins[3][BIN_COUNT];
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < BIN_COUNT; i++) bins[axis][i] = (Bin){empty_bounds, 0};
    }
    for (size_t i = 0; i < count; i++) {
        for (int axis = 0; axis < 3; axis++) {
            Bin *bin = &bins[axis][bin_of(binning, &items[i], axis)];
            grow(&bin->bounds, items[i].low, items[i].high);
            bin->count++;
        }
    }
    Split best = {-1, 0, FLT_MAX};
    for (int axis = 0; axis < 3; axis++) {
        if (binning->scale[axis] == 0) continue;
        float right_cost[BIN_COUNT];
        Bounds bounds = empty_bounds;
        uint32_t below = 0;
        for (int i = BIN_COUNT - 1; i > 0; i--) {
            grow(&bounds, bins[axis][i].bounds.low, bins[axis][i].bounds.high);
            below += bins[axis][i].count;
            right_cost[i] =
                below == 0 ? 0 : gi_build_area(bounds.low, bounds.high) * cost_of(below);
        }
        bounds = empty_bounds;
        below = 0;
        for (int i = 1; i < BIN_COUNT; i++) {
            grow(&bounds, bins[axis][i - 1].bounds.low, bins[axis][i - 1].bounds.high);
            below += bins[axis][i - 1].count;
            if (below == 0 || below == count) continue;
            float cost =
                gi_build_area(bounds.low, bounds.high) * cost_of(below) + right_cost[i];
            if (cost < best.cost) best = (Split){axis, i, cost};
        }
    }
    return best;
}

static size_t partition(GiBuildItem *items, size_t count, const Binning *binning, Split split) {
    size_t left = 0, right = count;
    for (;;) {
        while (left < right && bin_of(binning, &items[left], split.axis) < split.bin) left++;
        while (left < right && bin_of(binning, &items[right - 1], split.axis) >= split.bin) right--;
        if (left >= right) return left;
        GiBuildItem swap = items[left];
        items[left] = items[right - 1];
        items[right - 1] = swap;
    }
}

/* Splits the range in two, or makes it a leaf and returns false. */
static bool split_range(Build *build, Range range, Range *left, Range *right) {
    GiBuildItem *items = build->items + range.begin;
    size_t count = range.end - range.begin;
    Bounds bounds, centers;
    bound_items(items, count, &bounds, &centers);
    GiBuildNode *node = &build->nodes[range.node];
    memcpy(node->low, bounds.low, sizeof node->low);
    memcpy(node->high, bounds.high, sizeof node->high);
    size_t middle = 0;
    if (count > GI_BUILD_LEAF_SIZE && range.depth < SAH_DEPTH_LIMIT) {
        Binning binning = binning_of(&centers);
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
                monitor->progress(monitor->user, GLINT_PHASE_BUILD,
                    0.9 * (double)done / (double)build->count);
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
