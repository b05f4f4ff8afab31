/* SPDX-License-Identifier: MIT
 * Many rays through one point, traced together. Part of kernel.c.
 *
 * In the plane at depth 1 along the bundle's axis w every ray is a point (a, b), sixteen of them (a
 * packet) a rectangle, sixteen packets (a group) a larger one, and all of them the largest. A
 * node's children are rectangles too, with a nearest depth; those that no group looks at are left
 * out, and the others are kept with the bits of the groups that do. So is every shape of a leaf a
 * rectangle; five comparisons for sixteen packets at once tell which packets it may concern, five
 * more which rays of a packet, and only those are tested exactly. (After Reshetov 2005, Overbeck
 * 2008 and Davidovic et al. 2012.)
 *
 *        b |   +---------------- tile
 *          |   | +--+ packet
 *          |   | |  |   ( shape's rectangle )
 *          +------------------------- a
 *
 * Staying below the error bound of layout.h: boxes are grown by 2^-19 of their distance from the
 * centre of kernel space; here they are moved so that the apex is the origin, and grown by another
 * 2^-19 of the apex' own distance. Together that is at least 32 roundings of their distance p from
 * the apex. What they reach along the axes, and the rectangles, are sums and quotients of a dozen
 * roundings of p, so they err to the safe side. A group's rectangle and depth hold those of its
 * packets, so what none of the groups looks at concerns no packet. The rays' own (a, b) are
 * computed in double, rounded once, and compared with rectangles that are widened for it. */
#pragma once

/* ---------------------------------------------------------------- the walk */

/* Counts tests, and asks now and then whether to go on. */
static inline void tile_count(Tile *tile, int tests) {
    enum { TESTS_BETWEEN = 4096 };
    const GiBundle *bundle = tile->bundle;
    tile->tests_made += tests;
    if (tile->tests_made < TESTS_BETWEEN || bundle->stop == NULL) return;
    tile->tests_made = 0;
    tile->stopped = bundle->stop(bundle->stop_context);
}

/* Makes the exact tests that have come together, and finds out how far packets look now. */
static inline void tile_flush(Tile *tile) {
    for (int i = 0; i < tile->test_count; i++) {
        const Test *test = &tile->tests[i];
        if (gi_shape_kind(test->shape) == GI_SHAPE_INSTANCE) {
            if (test->rays != 0) tile_instance(tile, i);
            continue;
        }
        unsigned rays = test->rays & tile->alive[test->packet];
        COUNT(shapes, __builtin_popcount(rays));
        if (rays != 0) tile_test(tile, test->shape, (int)test->packet, rays);
    }
    int solids = 0;
    for (int kind = 0; kind < SOLID_KINDS; kind++) {
        SolidTests *list = &tile->solids[kind];
        if (list->count == 0) continue;
        solids += list->count;
        test_solids(tile, (GiShapeKind)kind, list->tests, list->count);
        list->count = 0;
    }
    tile_count(tile, tile->test_count + tile->taken + solids);
    tile->test_count = tile->taken = 0;
    if (tile->emptied > 0) tile_enclose(tile);
    tile->emptied = 0;
    bool changed = false;
    for (int k = 0; k < GI_PACKET_COUNT; k += 32) {
        for (unsigned rest = tile->nearer[k / 32]; rest != 0; rest &= rest - 1) {
            packet_refresh_far(tile, k + lowest_bit(rest));
            changed = true;
        }
        tile->nearer[k / 32] = 0;
    }
    if (changed) tile_refresh_far(tile);
}

/* A child that is still to be looked at, the depth it begins at, and bits of the groups of packets
 * that it may concern. Sparse: it is so small that few rays pass by. */
typedef struct Entry {
    uint32_t child;
    float enter;
    unsigned groups;
    bool sparse;
} Entry;

/* Pairs of one lane of a leaf and a packet. */
typedef struct Pairs {
    int count;
    uint32_t pair[GI_TREE_WIDTH * GI_PACKET_COUNT + 16]; /* lane * GI_PACKET_COUNT + packet */
} Pairs;

/* Notes the tests that a leaf's shapes need. Which shapes, packets and rays these are cannot be
 * foretold, so each step writes a list without asking, and the next runs down the list: branches
 * that go wrong half of the time would cost more than the work. */
static inline void tile_pairs(
    const Tile *tile, const Rectangles *rectangles, unsigned bits, unsigned groups, Pairs *pairs) {
    uint64_t pending = 0; /* a bit for each lane and group that overlap */
    for (unsigned rest = bits; rest != 0; rest &= rest - 1) {
        int lane = lowest_bit(rest);
        uint64_t here = groups & groups_overlaps(&tile->groups, rectangles, lane);
        pending |= here << lane * GROUP_COUNT;
    }
    int count = 0; /* not in memory, which vectors might be written over */
    for (; pending != 0; pending &= pending - 1) {
        int bit = lowest_bit_of(pending), lane = bit / GROUP_COUNT;
        int first = bit % GROUP_COUNT * GROUP_SIZE;
        unsigned packets = tile_overlaps(&tile->packets, rectangles, lane, first);
        count += sixteen_append(
            pairs->pair + count, packets, (uint32_t)(lane * GI_PACKET_COUNT + first));
    }
    pairs->count = count;
}

/* After the pairs of a leaf. Finding the frustum anew takes as long as a leaf. */
enum { EMPTIED_BATCH = 2 };
static inline void tile_noted(Tile *tile, int tests) {
    tile->test_count = tests;
    tests += tile->taken;
    for (int kind = 0; kind < SOLID_KINDS; kind++) tests += tile->solids[kind].count;
    if (tests >= TEST_BATCH || tile->emptied >= EMPTIED_BATCH) tile_flush(tile);
}

/* A test is written down without asking whether rays are left, but counted only then. */
static inline void note_solid(Tile *tile, GiShapeKind kind, Test test) {
    SolidTests *list = &tile->solids[kind];
    list->tests[list->count] = test;
    list->count += test.rays != 0;
}

static inline void tile_note(Tile *tile, Test test) {
    if (gi_shape_kind(test.shape) < SOLID_KINDS) {
        note_solid(tile, gi_shape_kind(test.shape), test);
    } else {
        tile->tests[tile->test_count] = test;
        tile->test_count += test.rays != 0;
    }
}

#include "kernel/parallel.h"

/* The boxes of a block that are large: floors and the like. */
static inline void block_large(Tile *tile, const GiBoxBlock *block, const Rectangles *rectangles,
    unsigned bits, unsigned groups) {
    Boxes boxes;
    for (unsigned rest = bits; rest != 0; rest &= rest - 1) {
        int lane = lowest_bit(rest);
        boxes_look(tile, block, lane, rectangles->near[lane], &boxes);
    }
    Pairs pairs;
    tile_pairs(tile, rectangles, bits, groups, &pairs);
    for (int i = 0; i < pairs.count; i++) {
        int lane = (int)(pairs.pair[i] / GI_PACKET_COUNT);
        int packet = (int)(pairs.pair[i] % GI_PACKET_COUNT);
        GiShapeRef ref = block->shape[lane];
        /* What rays start from is what they are said to spare, and whole packets of a floor's do.
         */
        if (tile->any && (tile->alive[packet] & ~spared_by(tile, ref, packet)) == 0) continue;
        Verdict verdict = box_verdict(tile, &boxes, lane, packet);
        unsigned rays = take_certain(tile, ref, packet, verdict);
        note_solid(tile, GI_SHAPE_BOX, (Test){ref, (uint32_t)packet, rays});
    }
}

/* All other shapes of a block. In most pairs no ray is within the shape's rectangle. What the
 * verdict is on the others cannot be foretold either, so it is taken without asking. */
static inline void block_small(Tile *tile, const GiBoxBlock *block, const Rectangles *rectangles,
    const Solids *solids, unsigned bits, unsigned groups) {
    Pairs pairs;
    tile_pairs(tile, rectangles, bits, groups, &pairs);
    int count = 0;
    for (int i = 0; i < pairs.count; i++) {
        uint32_t pair = pairs.pair[i];
        int lane = (int)(pair / GI_PACKET_COUNT), packet = (int)(pair % GI_PACKET_COUNT);
        unsigned rays = tile_rays(tile, rectangles, lane, packet);
        pairs.pair[count] = pair << GI_PACKET_SIZE | rays;
        count += rays != 0;
    }
    for (int i = 0; i < count; i++) {
        uint32_t pair = pairs.pair[i] >> GI_PACKET_SIZE;
        int lane = (int)(pair / GI_PACKET_COUNT), packet = (int)(pair % GI_PACKET_COUNT);
        GiShapeRef ref = block->shape[lane];
        Verdict verdict = small_verdict(tile, ref, solids, lane, rectangles->near[lane], packet);
        unsigned rays = pairs.pair[i] & verdict.maybe;
        if (tile->any) {
            rays &= tile->alive[packet] & ~spared_by(tile, ref, packet);
            take_sure(tile, ref, packet, rays & verdict.sure);
            rays &= ~verdict.sure;
        }
        tile_note(tile, (Test){ref, (uint32_t)packet, rays});
    }
}

static inline void tile_block(Tile *tile, Entry entry) {
    const GiBoxBlock *block = &tile->tree->box_blocks[gi_child_index(entry.child)];
    Rectangles rectangles;
    Solids solids;
    COUNT(leaves, 1);
    unsigned bits = tile_boxes(&tile->frustum, block, &rectangles, &solids), large = 0;
    for (unsigned rest = bits & tile_wide(&tile->frustum, &rectangles); rest != 0;
         rest &= rest - 1) {
        int lane = lowest_bit(rest);
        large |= (unsigned)(gi_shape_kind(block->shape[lane]) == GI_SHAPE_BOX) << lane;
    }
    for (unsigned rest = bits; rest != 0; rest &= rest - 1) {
        prefetch_small(tile, block->shape[lowest_bit(rest)]);
    }
    if (tile->frustum.parallel) {
        parallel_block(tile, block, &rectangles, bits, entry.groups);
    } else {
        if (large != 0) block_large(tile, block, &rectangles, large, entry.groups);
        block_small(tile, block, &rectangles, &solids, bits & ~large, entry.groups);
    }
    tile_noted(tile, tile->test_count);
}

/* What is certain of the pairs of a block of spheres. Only pairs that are not certain to miss are
 * kept, and they come first: to ask at once what follows from each would be a question that half of
 * the time is answered wrong. */
static inline void balls_verdicts(const Tile *tile, bool any, const Rectangles *rectangles,
    const Spheres *spheres, Pairs *pairs, Verdict *verdicts) {
    int count = 0;
    for (int i = 0; i < pairs->count; i++) {
        uint32_t pair = pairs->pair[i], lane = pair / GI_PACKET_COUNT;
        int packet = (int)(pair % GI_PACKET_COUNT);
        const Ball ball = {spheres->x[lane], spheres->y[lane], spheres->z[lane],
            spheres->outer[lane], spheres->inner[lane]};
        verdicts[count] = sphere_verdict(tile, any, &ball, rectangles->near[lane], packet);
        pairs->pair[count] = pair;
        count += verdicts[count].maybe != 0;
    }
    pairs->count = count;
}

static inline void tile_balls(Tile *tile, Entry entry) {
    const GiSphereBlock *block = &tile->tree->sphere_blocks[gi_child_index(entry.child)];
    Rectangles rectangles;
    Spheres spheres;
    COUNT(leaves, 1);
    unsigned bits = tile_spheres(&tile->frustum, block, &rectangles, &spheres);
    Pairs pairs;
    tile_pairs(tile, &rectangles, bits, entry.groups, &pairs);
    if (tile->frustum.parallel) {
        parallel_balls(tile, block, &rectangles, &spheres, &pairs);
        tile_noted(tile, tile->test_count);
        return;
    }
    Verdict verdicts[GI_TREE_WIDTH * GI_PACKET_COUNT + 1];
    if (tile->any) {
        balls_verdicts(tile, true, &rectangles, &spheres, &pairs, verdicts);
    } else {
        balls_verdicts(tile, false, &rectangles, &spheres, &pairs, verdicts);
    }
    for (int i = 0; i < pairs.count; i++) {
        uint32_t lane = pairs.pair[i] / GI_PACKET_COUNT, packet = pairs.pair[i] % GI_PACKET_COUNT;
        unsigned rays = take_certain(tile, block->shape[lane], (int)packet, verdicts[i]);
        note_solid(tile, GI_SHAPE_SPHERE, (Test){block->shape[lane], packet, rays});
    }
    tile_noted(tile, tile->test_count);
}

/* The pairs of a sparse leaf. Most of a packet's rays pass by all of its triangles, and sixteen of
 * them are a lot to ask of each triangle, where one or two are near: rather ask those about eight
 * triangles each. False when that would take longer, as there are many packets. */
static inline bool tile_sparse_pairs(const Tile *tile, const Rectangles *rectangles,
    const Edges *edges, unsigned bits, unsigned groups, Pairs *pairs) {
    enum { FEW_PACKETS = 4, FEW_RAYS = 8 };
    const Rectangles around = rectangle_around(rectangles);
    uint32_t packets[FEW_PACKETS + 16];
    int packet_count = 0, count = 0;
    for (groups &= groups_overlaps(&tile->groups, &around, 0); groups != 0; groups &= groups - 1) {
        int first = lowest_bit(groups) * GROUP_SIZE;
        unsigned here = tile_overlaps(&tile->packets, &around, 0, first);
        packet_count += sixteen_append(packets + packet_count, here, (uint32_t)first);
        if (packet_count > FEW_PACKETS) return false;
    }
    for (int i = 0; i < packet_count; i++) {
        unsigned rays = tile_rays(tile, &around, 0, (int)packets[i]);
        unsigned lanes = __builtin_popcount(rays) > FEW_RAYS ? bits : 0;
        for (; lanes != bits && rays != 0; rays &= rays - 1) {
            int ray = (int)packets[i] * GI_PACKET_SIZE + lowest_bit(rays);
            lanes |= bits & triangles_near(tile, rectangles, edges, ray);
        }
        for (; lanes != 0; lanes &= lanes - 1) {
            pairs->pair[count++] = (uint32_t)lowest_bit(lanes) * GI_PACKET_COUNT + packets[i];
        }
    }
    pairs->count = count;
    return true;
}

static inline void tile_leaf(Tile *tile, Entry entry) {
    if (tile->frustum.parallel) {
        parallel_leaf(tile, entry);
        return;
    }
    Rectangles rectangles;
    Edges edges;
    uint32_t first = gi_child_first(entry.child);
    COUNT(leaves, 1);
    unsigned bits = tile_triangles(&tile->frustum, &tile->shapes->triangles, first,
        gi_child_count(entry.child), tile->any, &rectangles, &edges);
    Pairs pairs;
    if (!entry.sparse ||
        !tile_sparse_pairs(tile, &rectangles, &edges, bits, entry.groups, &pairs)) {
        tile_pairs(tile, &rectangles, bits, entry.groups, &pairs);
    }
    int count = tile->test_count;
    for (int i = 0; i < pairs.count; i++) {
        uint32_t lane = pairs.pair[i] / GI_PACKET_COUNT, packet = pairs.pair[i] % GI_PACKET_COUNT;
        GiShapeRef ref = gi_shape_ref(GI_SHAPE_TRIANGLE, first + lane);
        unsigned rays = tile_rays_at(tile, ref, &rectangles, &edges, (int)lane, (int)packet);
        tile->tests[count] = (Test){ref, packet, rays};
        count += rays != 0;
    }
    tile_noted(tile, count);
}

/* Leaves of triangles wait for each other while their corners are on the way from memory. Which
 * corners these are is on its way itself since the leaf came onto the stack, and the last ones wait
 * for that too. */
enum { LEAF_BATCH = 8, LEAF_LAG = 3 };
typedef struct Leaves {
    int count;
    Entry entry[LEAF_BATCH];
} Leaves;

static inline void prefetch_corners(const GiTriangles *triangles, uint32_t child) {
    const uint32_t(*rows)[3] = triangles->corners + gi_child_first(child);
    for (uint32_t i = 0; i < gi_child_count(child); i++) {
        for (int k = 0; k < 3; k++) prefetch(triangles->positions[rows[i][k]]);
    }
}

static inline void tile_leaves(Tile *tile, Leaves *leaves) {
    int first = leaves->count > LEAF_LAG ? leaves->count - LEAF_LAG : 0;
    for (int i = first; i < leaves->count; i++) {
        prefetch_corners(&tile->shapes->triangles, leaves->entry[i].child);
    }
    for (int i = 0; i < leaves->count; i++) {
        if (leaves->entry[i].enter <= tile->frustum.far) tile_leaf(tile, leaves->entry[i]);
    }
    leaves->count = 0;
}

static inline void tile_put_off(Tile *tile, Entry entry, Leaves *leaves) {
    int ready = leaves->count - LEAF_LAG;
    if (ready >= 0) prefetch_corners(&tile->shapes->triangles, leaves->entry[ready].child);
    leaves->entry[leaves->count++] = entry;
    if (leaves->count == LEAF_BATCH) tile_leaves(tile, leaves);
}

/* What is still open of t. */
static inline void tile_close(Tile *tile) {
    for (int k = 0; k < GI_PACKET_COUNT; k++) {
        if (tile->open[k] != 0) tile_settle(tile, k, tile->open[k]);
    }
}

/* Whether a ray of these groups passes through the rectangle of a box, and looks so far. */
static inline bool tile_concerns(
    const Tile *tile, const Rectangles *boxes, int lane, unsigned groups) {
    for (; groups != 0; groups &= groups - 1) {
        int first = lowest_bit(groups) * GROUP_SIZE;
        unsigned packets = tile_overlaps(&tile->packets, boxes, lane, first);
        for (; packets != 0; packets &= packets - 1) {
            if (tile_rays(tile, boxes, lane, first + lowest_bit(packets)) != 0) return true;
        }
    }
    return false;
}

/* Pushes those children that concern a group of packets, the nearest on top. Two kinds are worth a
 * closer look: triangles, whose corners are all over the memory, and what is small beside a
 * packet's rectangle, so that it may well lie between the rays, or, with shadow rays, behind where
 * they begin. How small was found by trial, in areas of a packet: of 4 million triangles 0.54 of
 * the time for shadow rays, and no loss where shapes are large. */
static inline int tile_push(const Tile *tile, Entry *stack, int count, const GiNode *node,
    const Rectangles *boxes, unsigned bits) {
    enum { SMALL = 8, SPARSE = 4 };
    const unsigned small = rectangles_below(boxes, SMALL * tile->area);
    const unsigned sparse = rectangles_below(boxes, SPARSE * tile->area);
    int first = count;
    for (; bits != 0; bits &= bits - 1) {
        int i = lowest_bit(bits);
        Entry entry = {node->child[i], boxes->near[i], groups_overlaps(&tile->groups, boxes, i),
            sparse >> i & 1};
        if (entry.groups == 0) continue;
        bool closely = (small >> i & 1) | (gi_child_kind(entry.child) == GI_CHILD_TRIANGLES);
        if (closely && !tile_concerns(tile, boxes, i, entry.groups)) continue;
        prefetch_child(tile->tree, tile->shapes, entry.child);
        int at = count++;
        for (; at > first && stack[at - 1].enter < entry.enter; at--) stack[at] = stack[at - 1];
        stack[at] = entry;
    }
    return count;
}

static inline void tile_walk(Tile *tile) {
    const GiTree *tree = tile->tree;
    uint32_t packet_count = (uint32_t)(tile->bundle->count + GI_PACKET_SIZE - 1) / GI_PACKET_SIZE;
    for (uint32_t i = 0; i < tree->unbounded_count && !tile->stopped; i++) {
        for (uint32_t k = 0; k < packet_count; k++) {
            tile->tests[tile->test_count++] = (Test){tree->unbounded[i], k, 0xffff};
        }
        tile_flush(tile);
    }
    Entry stack[STACK_LIMIT];
    Leaves leaves = {.count = 0};
    int count = 0;
    const unsigned all = (1u << GROUP_COUNT) - 1;
    if (tree->root != GI_CHILD_NONE) stack[count++] = (Entry){tree->root, -INFINITY, all, false};
    while (count > 0 && !tile->stopped) {
        Entry top = stack[--count];
        if (!(top.enter <= tile->frustum.far)) continue;
        switch (gi_child_kind(top.child)) {
        case GI_CHILD_NODE: {
            const GiNode *node = &tree->nodes[top.child];
            Rectangles boxes;
            unsigned bits = tile_children(&tile->frustum, node, &boxes);
            COUNT(nodes, 1);
            count = tile_push(tile, stack, count, node, &boxes, bits);
            break;
        }
        case GI_CHILD_TRIANGLES: tile_put_off(tile, top, &leaves); break;
        case GI_CHILD_SPHERES: tile_balls(tile, top); break;
        default: tile_block(tile, top); break;
        }
    }
    tile_leaves(tile, &leaves);
    tile_flush(tile);
}

static inline GiTraceRay bundle_ray(const Tile *tile, int i) {
    const GiBundle *bundle = tile->bundle;
    GiTraceRay ray = {.origin = bundle->apex,
        .direction = bundle_direction(bundle, tile->any, i),
        .t_min = bundle->start,
        .t_max = bundle->t[i],
        .skip = GI_SHAPE_NONE,
        .skip_instance = GI_SHAPE_NONE};
    if (!tile->any) return ray;
    ray.origin = gi_vec(bundle->ox[i], bundle->oy[i], bundle->oz[i]);
    ray.t_min = bundle->t_min[i];
    ray.t_max = bundle->end;
    ray.skip = bundle->skip[i];
    ray.skip_instance = bundle->skip_instance[i];
    return ray;
}

/* Few rays, or rays all round the apex, are better traced one by one. */
enum { TILE_MINIMUM = 8 };

static inline void bundle_one_by_one(const Tile *tile) {
    GiBundle *bundle = tile->bundle;
    for (int i = 0; i < bundle->count; i++) {
        if (i % 16 == 0 && bundle->stop != NULL && bundle->stop(bundle->stop_context)) return;
        GiTraceRay ray = bundle_ray(tile, i);
        GiTraceHit hit = {ray.t_max, {GI_SHAPE_NONE}, GI_SHAPE_NONE};
        bool found = tile->any
                         ? line_trace(tile->tree, tile->shapes, tile->instance, &ray, true, &hit)
                         : line_trace(tile->tree, tile->shapes, tile->instance, &ray, false, &hit);
        if (!found) continue;
        bundle->shape[i] = hit.shape.bits;
        bundle->instance[i] = hit.instance;
        if (!tile->any) bundle->t[i] = hit.t;
    }
}

static inline void bundle_run(Tile *tile) {
    GiBundle *bundle = tile->bundle;
    tile->scale = tile->tree->scale;
    tile->test_count = tile->tests_made = tile->taken = 0;
    for (int kind = 0; kind < SOLID_KINDS; kind++) tile->solids[kind].count = 0;
    tile_places(tile);
    tile->emptied = 0;
    tile->stopped = false;
    for (int i = 0; i < GI_PACKET_COUNT / 32; i++) tile->nearer[i] = 0;
    memset(tile->inverse_known, 0, sizeof tile->inverse_known);
    memset(tile->square_known, 0, sizeof tile->square_known);
    int end = (bundle->count + GI_PACKET_SIZE - 1) / GI_PACKET_SIZE * GI_PACKET_SIZE;
    for (int i = 0; i < end; i++) bundle->shape[i] = bundle->instance[i] = GI_SHAPE_NONE;
    GiVec u, v, w;
    if (bundle->count >= TILE_MINIMUM && tile_frame(bundle, tile->any, &u, &v, &w)) {
        tile_pad(tile);
        tile_apex(tile);
        tile->toward = tile->any ? gi_negate(w) : w;
        bool placed = tile->frustum.parallel ? parallel_packets(tile, u, v)
                      : tile->any            ? tile_packets(tile, true, u, v)
                                             : tile_packets(tile, false, u, v);
        if (placed) {
            tile_axes(tile, u, v, w);
            tile_walk(tile);
            if (!tile->any && !bundle->without_t) tile_close(tile);
            return;
        }
    }
    bundle_one_by_one(tile);
}

static bool bundle_inside(const Tile *outer, uint32_t instance, GiBundle *inner, double apart) {
    Tile tile;
    tile.tree = outer->shapes->instances[instance].tree;
    tile.shapes = outer->shapes;
    tile.instance = instance;
    tile.apart = apart;
    tile.bundle = inner;
    tile.any = outer->any;
    tile.frustum.parallel = outer->frustum.parallel;
    bundle_run(&tile);
    return tile.stopped;
}

static inline void bundle_trace(const GiTrace *trace, GiBundle *bundle, bool any, bool parallel) {
    Tile tile;
    tile.tree = trace->tree;
    tile.shapes = trace->shapes;
    tile.instance = GI_SHAPE_NONE;
    tile.apart = 0;
    tile.bundle = bundle;
    tile.any = any;
    tile.frustum.parallel = parallel;
    bundle_run(&tile);
}

static void GI_KERNEL(bundle_closest)(const GiTrace *trace, GiBundle *bundle) {
    bundle_trace(trace, bundle, false, false);
}

static void GI_KERNEL(bundle_any)(const GiTrace *trace, GiBundle *bundle) {
    bundle_trace(trace, bundle, true, false);
}

static void GI_KERNEL(bundle_parallel)(const GiTrace *trace, GiBundle *bundle, GiVec direction) {
    for (int i = 0; i < bundle->count; i++) {
        bundle->dx[i] = direction.x;
        bundle->dy[i] = direction.y;
        bundle->dz[i] = direction.z;
    }
    bundle->apex = gi_vec(0, 0, 0);
    bundle->own = true;
    bundle->end = INFINITY;
    bundle_trace(trace, bundle, true, true);
}
