/* SPDX-License-Identifier: MIT
 * Many rays through one point, traced together. Part of kernel.c.
 *
 * In the plane at depth 1 along the bundle's axis w every ray is a point (a, b), sixteen of them (a
 * packet) a rectangle, and all of them a larger rectangle: a frustum of four planes, against which
 * nodes are tested once for all rays. A shape is a rectangle too, with a nearest depth; five
 * comparisons for sixteen packets at once tell which packets it may concern, five more which rays
 * of a packet, and only those are tested exactly. (After Reshetov 2005, Overbeck 2008 and Davidovic
 * 2012.)
 *
 *        b |   +---------------- tile
 *          |   | +--+ packet
 *          |   | |  |   ( shape's rectangle )
 *          +------------------------- a
 *
 * Staying below the error bound of layout.h: boxes are grown by 2^-19 of their distance from the
 * centre of kernel space; here they are moved so that the apex is the origin, and grown by another
 * 2^-19 of the apex' own distance. Together that is at least 32 roundings of their distance p from
 * the apex. Plane distances and rectangles are sums and quotients of a dozen roundings of p, so
 * they err to the safe side. The rays' own (a, b) are computed in double, rounded once, and
 * compared with rectangles that are widened for it. */
#pragma once

/* ---------------------------------------------------------------- deciding */

/* The rays from i on. Only slabs need 1 / d, so it is worked out when the first slab is met. */
static inline gi_wide_Ray tile_ray(Tile *tile, GiShapeRef ref, int i) {
    GiBundle *bundle = tile->bundle;
    gi_wide_Ray ray = {.ox = r_load(bundle->ox + i),
        .oy = r_load(bundle->oy + i),
        .oz = r_load(bundle->oz + i),
        .dx = r_load(bundle->dx + i),
        .dy = r_load(bundle->dy + i),
        .dz = r_load(bundle->dz + i),
        .inverse_square = r_load(bundle->inverse_square + i)};
    if (gi_shape_kind(ref) != GI_SHAPE_BOX && gi_shape_kind(ref) != GI_SHAPE_CONE) return ray;
    uint32_t bit = 1u << i / GI_DOUBLES % 32;
    uint32_t *known = &tile->inverse_known[i / GI_DOUBLES / 32];
    if (!(*known & bit)) {
        *known |= bit;
        r_store(bundle->ix + i, gi_wide_inverse(ray.dx));
        r_store(bundle->iy + i, gi_wide_inverse(ray.dy));
        r_store(bundle->iz + i, gi_wide_inverse(ray.dz));
    }
    ray.ix = r_load(bundle->ix + i);
    ray.iy = r_load(bundle->iy + i);
    ray.iz = r_load(bundle->iz + i);
    return ray;
}

/* Of two shapes at the very same t the first in document order stays. */
static inline void resolve_ties(Tile *tile, GiShapeRef ref, int i, unsigned bits) {
    for (; bits != 0; bits &= bits - 1) {
        uint32_t *shape = &tile->bundle->shape[i + lowest_bit(bits)];
        if (*shape != GI_SHAPE_NONE &&
            gi_shape_before(tile->trace->shapes, ref, GI_SHAPE_NONE, (GiShapeRef){*shape},
                tile->bundle->instance[i + lowest_bit(bits)])) {
            *shape = ref.bits;
        }
    }
}

/* Whether one of the rays j .. j + GI_DOUBLES - 1 is among the bits. */
static inline bool any_of(unsigned bits, int j) {
    return (bits >> j & ((1u << GI_DOUBLES) - 1)) != 0;
}

/* One shape against those rays of a packet whose bits are set. Returns whether anything changed. */
static inline bool test_closest(Tile *tile, GiShapeRef ref, int packet, unsigned rays) {
    GiBundle *bundle = tile->bundle;
    unsigned changed = 0;
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        if (!any_of(rays, j)) continue;
        int i = packet * GI_PACKET_SIZE + j;
        gi_wide_Ray ray = tile_ray(tile, ref, i);
        R t, best = r_load(bundle->t + i);
        M hit = gi_wide_shape(tile->trace->shapes, ref, &ray, r_load(bundle->t_min + i),
            r_load(bundle->t_max + i), &t);
        M nearer = hit & R_LESS(t, best);
        unsigned bits = m_bits(nearer), ties = m_bits(hit & R_EQUAL(t, best));
        if (bits != 0) {
            r_store(bundle->t + i, R_SELECT(nearer, t, best));
            u_store_where(bundle->shape + i, bits, ref.bits);
            changed |= bits;
        }
        if (ties != 0) resolve_ties(tile, ref, i, ties);
    }
    if (changed == 0) return false;
    R far = R_OF(-INFINITY);
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        int i = packet * GI_PACKET_SIZE + j;
        far = R_MAX(far, r_load(bundle->t + i) * r_load(bundle->depth + i));
    }
    tile->packets.far[packet] = (float)(r_maximum(far) * tile->scale) * (1 + GI_WIDER);
    return true;
}

static inline bool test_any(Tile *tile, GiShapeRef ref, int packet, unsigned rays) {
    GiBundle *bundle = tile->bundle;
    unsigned stopped = 0;
    rays &= ~sixteen_equal(ref.bits, bundle->skip + packet * GI_PACKET_SIZE);
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        if (!any_of(rays, j)) continue;
        int i = packet * GI_PACKET_SIZE + j;
        gi_wide_Ray ray = tile_ray(tile, ref, i);
        R t;
        M hit = gi_wide_shape(tile->trace->shapes, ref, &ray, r_load(bundle->t_min + i),
            r_load(bundle->t_max + i), &t);
        unsigned bits = m_bits(hit) & rays >> j;
        u_store_where(bundle->shape + i, bits, ref.bits);
        stopped |= bits << j;
    }
    tile->alive[packet] &= ~stopped;
    if (stopped == 0 || tile->alive[packet] != 0) return false;
    packet_clear(&tile->packets, packet);
    return true;
}

static inline bool tile_test(Tile *tile, GiShapeRef ref, int packet, unsigned rays) {
    return tile->any ? test_any(tile, ref, packet, rays) : test_closest(tile, ref, packet, rays);
}

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

/* Makes the exact tests that have come together. */
static inline void tile_flush(Tile *tile) {
    bool changed = false;
    for (int i = 0; i < tile->test_count; i++) {
        const Test *test = &tile->tests[i];
        unsigned rays = test->rays & tile->alive[test->packet];
        if (rays != 0) changed |= tile_test(tile, test->shape, (int)test->packet, rays);
    }
    tile_count(tile, tile->test_count);
    tile->test_count = 0;
    if (changed && tile->any) tile_shrink(tile);
    if (changed && !tile->any) tile_refresh_far(tile);
}

/* Notes the tests that a block's shapes need. Which shapes, packets and rays these are cannot be
 * foretold, so each step writes a list without asking, and the next runs down the list: branches
 * that go wrong half of the time would cost more than the work. */
static inline void tile_block(Tile *tile, uint32_t child) {
    const GiTree *tree = tile->trace->tree;
    uint32_t index = child & GI_CHILD_INDEX;
    Rectangles rectangles;
    const GiShapeRef *shapes;
    unsigned bits;
    if (child & GI_CHILD_SPHERES) {
        bits = tile_spheres(&tile->frustum, &tree->sphere_blocks[index], &rectangles);
        shapes = tree->sphere_blocks[index].shape;
    } else {
        bits = tile_boxes(&tile->frustum, &tree->box_blocks[index], &rectangles);
        shapes = tree->box_blocks[index].shape;
    }
    uint32_t pairs[GI_TREE_WIDTH * GI_PACKET_COUNT + 16];
    int pair_count = 0;
    for (; bits != 0; bits &= bits - 1) {
        int lane = lowest_bit(bits);
        for (int first = 0; first < GI_PACKET_COUNT; first += 16) {
            unsigned packets = tile_overlaps(&tile->packets, &rectangles, lane, first);
            pair_count += sixteen_append(
                pairs + pair_count, packets, (uint32_t)(lane * GI_PACKET_COUNT + first));
        }
    }
    int count = tile->test_count;
    for (int i = 0; i < pair_count; i++) {
        int lane = (int)(pairs[i] / GI_PACKET_COUNT);
        uint32_t packet = pairs[i] % GI_PACKET_COUNT;
        unsigned rays = tile_rays(tile, &rectangles, lane, (int)packet);
        prefetch_shape(tile->trace->shapes, shapes[lane]);
        tile->tests[count] = (Test){shapes[lane], packet, rays};
        count += rays != 0;
    }
    tile->test_count = count;
    if (count >= TEST_BATCH) tile_flush(tile);
}

static inline void tile_walk(Tile *tile) {
    const GiTree *tree = tile->trace->tree;
    int packet_count = (tile->bundle->count + GI_PACKET_SIZE - 1) / GI_PACKET_SIZE;
    for (uint32_t i = 0; i < tree->unbounded_count && !tile->stopped; i++) {
        tile_count(tile, packet_count);
        for (int k = 0; k < packet_count; k++) {
            tile_test(tile, tree->unbounded[i], k, tile->alive[k]);
        }
    }
    if (tree->unbounded_count > 0) tile_refresh_far(tile);
    StackEntry stack[STACK_LIMIT];
    int count = 0;
    if (tree->root != GI_CHILD_NONE) stack[count++] = (StackEntry){tree->root, -INFINITY};
    while (count > 0 && !tile->stopped) {
        StackEntry top = stack[--count];
        if (!(top.enter <= tile->frustum.far)) continue;
        if (top.child & GI_CHILD_BLOCK) {
            tile_block(tile, top.child);
        } else {
            const GiNode *node = &tree->nodes[top.child];
            float enter[8];
            unsigned bits = tile_node(&tile->frustum, node, enter);
            count = push_children(tree, stack, count, node->child, bits, enter);
        }
    }
    tile_flush(tile);
}

static inline GiTraceRay bundle_ray(const GiBundle *bundle, int i) {
    return (GiTraceRay){
        {bundle->ox[i], bundle->oy[i], bundle->oz[i]},
        {bundle->dx[i], bundle->dy[i], bundle->dz[i]},
        bundle->t_min[i],
        bundle->t_max[i],
        bundle->skip[i],
        bundle->skip_instance[i],
    };
}

/* Few rays, or rays all round the apex, are better traced one by one. */
enum { TILE_MINIMUM = 8 };

static inline void bundle_trace(const GiTrace *trace, GiBundle *bundle, bool any) {
    double toward = any ? -1 : 1;
    Tile tile;
    tile.trace = trace;
    tile.bundle = bundle;
    tile.any = any;
    tile.scale = trace->tree->scale;
    tile.test_count = tile.tests_made = 0;
    tile.stopped = false;
    for (int i = 0; i < GI_BUNDLE_SIZE / 32; i++) tile.inverse_known[i] = 0;
    for (int i = 0; i < GI_BUNDLE_SIZE; i++) {
        bundle->shape[i] = bundle->instance[i] = GI_SHAPE_NONE;
    }
    GiVec u, v, w;
    if (bundle->count >= TILE_MINIMUM && tile_frame(bundle, toward, &u, &v, &w)) {
        tile_pad(bundle);
        if (tile_packets(&tile, toward, u, v, w)) {
            if (!any) {
                for (int i = 0; i < GI_BUNDLE_SIZE; i++) bundle->t[i] = bundle->t_max[i];
            }
            tile_planes(&tile, u, v, w);
            tile_walk(&tile);
            return;
        }
    }
    for (int i = 0; i < bundle->count; i++) {
        if (i % 16 == 0 && bundle->stop != NULL && bundle->stop(bundle->stop_context)) return;
        GiTraceRay ray = bundle_ray(bundle, i);
        GiTraceHit hit;
        if (any ? line_trace(trace, &ray, true, &hit) : line_trace(trace, &ray, false, &hit)) {
            bundle->shape[i] = any ? 0 : hit.shape.bits;
            if (any) continue;
            bundle->t[i] = hit.t;
            bundle->instance[i] = hit.instance;
        }
    }
}

static void GI_KERNEL(bundle_closest)(const GiTrace *trace, GiBundle *bundle) {
    bundle_trace(trace, bundle, false);
}

static void GI_KERNEL(bundle_any)(const GiTrace *trace, GiBundle *bundle) {
    bundle_trace(trace, bundle, true);
}
