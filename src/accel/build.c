/* SPDX-License-Identifier: MIT
 * Top down. A large range of items is split by its clusters, many levels at once (clusters.h), a
 * small one item by item (split.h). What comes of a large one becomes tasks for any worker, of some
 * small ranges or one that is still large; below TASK_SIZE a worker finishes alone with a stack of
 * its own, always putting off the larger half, so that the stack stays short. */
#include "accel/build.h"

#include "accel/clusters.h"
#include "accel/split.h"
#include "port/machine.h"
#include "sched/tasks.h"

#include <string.h>

enum {
    TASK_SIZE = 2048,
    TASK_RANGES = 7,      /* that a task takes along, when they are small */
    BUCKET_CLUSTERS = 16, /* clusters of so few, or so few items, are looked at more closely */
    BUCKET_ITEMS = 256,
    SAH_DEPTH_LIMIT = 60, /* deeper, halves are of equal size: the depth stays below 96 */
    STACK_SIZE = 64
};

typedef struct Build {
    GiBuildItem *items;
    GiBuildNode *nodes;
    GiClusters *clusters; /* a worker's each; null: there are but few items */
    _Atomic uint32_t node_count;
    _Atomic size_t done; /* items in finished leaves */
    _Atomic bool stop;
    size_t count;
    const GiExtent *extent; /* of all items */
    const GlintMonitor *monitor;
} Build;

/* What a worker takes at once: a large range, or small ones that stand side by side. */
typedef struct Task {
    int count;
    GiRange ranges[TASK_RANGES];
} Task;

/* ---------------------------------------------------------------- the nodes */

static void set_bounds(GiBuildNode *node, const GiBounds *bounds) {
    float low[4], high[4];
    gi_four_store(low, bounds->low);
    gi_four_store(high, bounds->high);
    memcpy(node->low, low, sizeof node->low);
    memcpy(node->high, high, sizeof node->high);
}

static void set_leaf(Build *build, const GiRange *range) {
    build->nodes[range->node].first = range->begin;
    build->nodes[range->node].count = range->end - range->begin;
}

/* Gives the range's node two children, of which the first takes `left_count`. */
static void set_inner(Build *build, const GiRange *range, size_t left_count,
    const GiBounds bounds[2], GiRange sides[2]) {
    uint32_t first = atomic_fetch_add(&build->node_count, 2);
    uint32_t middle = range->begin + (uint32_t)left_count;
    build->nodes[range->node].first = first;
    build->nodes[range->node].count = 0;
    set_bounds(&build->nodes[first], &bounds[0]);
    set_bounds(&build->nodes[first + 1], &bounds[1]);
    sides[0] = (GiRange){first, range->begin, middle, range->depth + 1};
    sides[1] = (GiRange){first + 1, middle, range->end, range->depth + 1};
}

/* ---------------------------------------------------------------- ranges */

/* Splits the range in two, or makes it a leaf and returns false. */
static bool split_items(Build *build, const GiRange *range, GiRange sides[2]) {
    GiBuildItem *items = build->items + range->begin;
    size_t count = range->end - range->begin, left = 0;
    if (count <= GI_BUILD_LEAF_SIZE) {
        set_leaf(build, range);
        return false;
    }
    GiBounds bounds[2];
    if (range->depth < SAH_DEPTH_LIMIT) left = gi_split(items, count, NULL, bounds);
    if (left == 0) { /* no plane parts the centres, or the tree gets too deep */
        left = count / 2;
        bounds[0] = gi_bounds_of(items, left);
        bounds[1] = gi_bounds_of(items + left, count - left);
    }
    set_inner(build, range, left, bounds, sides);
    return true;
}

/* The same of a range of clusters. False: it becomes a bucket. */
static bool split_clusters(
    Build *build, GiClusters *clusters, const GiRange *range, GiRange sides[2]) {
    size_t count = range->end - range->begin;
    if (count <= BUCKET_CLUSTERS || range->depth >= SAH_DEPTH_LIMIT) return false;
    if (gi_clusters_weight(clusters, range->begin, range->end) <= BUCKET_ITEMS) return false;
    GiBounds bounds[2];
    size_t left = gi_split(clusters->clusters + range->begin, count, clusters->weights, bounds);
    if (left == 0) return false;
    set_inner(build, range, left, bounds, sides);
    return true;
}

/* Depth first, so that buckets that are near in the tree stand side by side. False: nothing was
 * split, since nearly all items are in one place. */
static bool split_to_buckets(Build *build, GiClusters *clusters, const GiRange *range) {
    GiRange stack[STACK_SIZE], sides[2];
    int height = 0;
    bool all = range->end - range->begin == build->count;
    GiBounds centers = all ? build->extent->centers
                           : gi_centers_of(build->items + range->begin, range->end - range->begin);
    if (!gi_clusters_make(clusters, build->items, range, &centers)) return false;
    GiRange part = {range->node, 0, (uint32_t)clusters->cluster_count, range->depth};
    for (;;) {
        if (split_clusters(build, clusters, &part, sides)) {
            part = sides[0];
            stack[height++] = sides[1];
        } else {
            gi_clusters_close(clusters, part.begin, part.end, part.node, part.depth);
            if (height == 0) break;
            part = stack[--height];
        }
    }
    if (clusters->bucket_count == 1) return false;
    gi_clusters_sort(clusters, build->items);
    return true;
}

/* ---------------------------------------------------------------- the tasks */

/* False: to stop. */
static bool report(Build *build, int worker) {
    const GlintMonitor *monitor = build->monitor;
    if (worker == 0 && monitor != NULL) {
        size_t done = atomic_load_explicit(&build->done, memory_order_relaxed);
        if (monitor->progress != NULL) {
            monitor->progress(
                monitor->user, GLINT_PHASE_BUILD, 0.9 * (double)done / (double)build->count);
        }
        if (monitor->cancelled != NULL && monitor->cancelled(monitor->user)) {
            atomic_store(&build->stop, true);
        }
    }
    return !atomic_load_explicit(&build->stop, memory_order_relaxed);
}

/* From a range to its leaves. */
static void finish(Build *build, GiRange range) {
    GiRange stack[STACK_SIZE], sides[2];
    int height = 0;
    for (;;) {
        if (split_items(build, &range, sides)) {
            int larger = sides[0].end - sides[0].begin > sides[1].end - sides[1].begin ? 0 : 1;
            range = sides[1 - larger];
            stack[height++] = sides[larger];
        } else {
            if (height == 0) return;
            range = stack[--height];
        }
    }
}

/* False: to stop. */
static bool finish_range(Build *build, const GiRange *range, int worker) {
    if (!report(build, worker)) return false;
    finish(build, *range);
    size_t count = range->end - range->begin;
    atomic_fetch_add_explicit(&build->done, count, memory_order_relaxed);
    return true;
}

static void hand_on(
    Build *build, GiTasks *tasks, const GiRange *ranges, size_t range_count, int worker) {
    Task task = {.count = 0};
    size_t items = 0;
    for (size_t i = 0; i < range_count; i++) {
        task.ranges[task.count++] = ranges[i];
        items += ranges[i].end - ranges[i].begin;
        if (items < TASK_SIZE && task.count < TASK_RANGES && i + 1 < range_count) continue;
        if (!gi_tasks_add(tasks, &task)) {
            for (int k = 0; k < task.count; k++) finish_range(build, &task.ranges[k], worker);
        }
        task.count = 0;
        items = 0;
    }
}

static void split_range(Build *build, GiTasks *tasks, const GiRange *range, int worker) {
    GiClusters *clusters = &build->clusters[worker];
    if (split_to_buckets(build, clusters, range)) {
        hand_on(build, tasks, clusters->buckets, clusters->bucket_count, worker);
    } else {
        GiRange sides[2];
        split_items(build, range, sides);
        hand_on(build, tasks, sides, 2, worker);
    }
}

static void run_task(GiTasks *tasks, void *context, const void *bytes, int worker) {
    Build *build = context;
    Task task;
    memcpy(&task, bytes, sizeof task);
    for (int i = 0; i < task.count; i++) {
        const GiRange *range = &task.ranges[i];
        if (range->end - range->begin < TASK_SIZE) {
            if (!finish_range(build, range, worker)) return;
        } else {
            if (!report(build, worker)) return;
            split_range(build, tasks, range, worker);
        }
    }
}

/* ---------------------------------------------------------------- the whole */

static GlintStatus build_nodes(GiMemory *memory, GiPool *pool, Build *build) {
    size_t workers = (size_t)gi_pool_worker_count(pool);
    if (build->count >= TASK_SIZE) {
        build->clusters = gi_memory_allocate_lines(memory, workers, sizeof *build->clusters);
        if (build->clusters == NULL) return GLINT_ERROR_MEMORY;
    }
    const Task all = {.count = 1, .ranges = {{.end = (uint32_t)build->count}}};
    set_bounds(&build->nodes[0], &build->extent->bounds);
    GlintStatus status = gi_tasks_run(pool, memory, &all, sizeof all, run_task, build);
    gi_memory_free_lines(memory, build->clusters, workers, sizeof *build->clusters);
    if (status == GLINT_OK && atomic_load(&build->stop)) status = GLINT_CANCELLED;
    return status;
}

GlintStatus gi_build(GiMemory *memory, GiPool *pool, GiBuildItem *items, size_t count,
    const GiExtent *extent, const GlintMonitor *monitor, GiBuildTree *tree) {
    tree->node_capacity = 2 * count;
    tree->nodes = gi_memory_allocate(memory, tree->node_capacity * sizeof *tree->nodes);
    if (tree->nodes == NULL) return GLINT_ERROR_MEMORY;
    gi_machine_large_pages(tree->nodes, tree->node_capacity * sizeof *tree->nodes);
    Build build = {.items = items,
        .nodes = tree->nodes,
        .node_count = 1,
        .count = count,
        .extent = extent,
        .monitor = monitor};
    GlintStatus status = build_nodes(memory, pool, &build);
    tree->node_count = atomic_load(&build.node_count);
    /* Leaves hold seven items, but might have held one each. */
    GiBuildNode *nodes = gi_memory_resize(
        memory, tree->nodes, tree->node_capacity * sizeof *nodes, tree->node_count * sizeof *nodes);
    if (nodes != NULL) {
        tree->nodes = nodes;
        tree->node_capacity = tree->node_count;
    }
    if (status != GLINT_OK) gi_build_free(memory, tree);
    return status;
}

void gi_build_free(GiMemory *memory, GiBuildTree *tree) {
    gi_memory_free(memory, tree->nodes, tree->node_capacity * sizeof *tree->nodes);
    tree->nodes = NULL;
}
