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

/* The rays from i on, but for 1 / d. */
static inline gi_wide_Ray tile_line(const GiBundle *bundle, int i) {
    return (gi_wide_Ray){.ox = r_load(bundle->ox + i),
        .oy = r_load(bundle->oy + i),
        .oz = r_load(bundle->oz + i),
        .dx = r_load(bundle->dx + i),
        .dy = r_load(bundle->dy + i),
        .dz = r_load(bundle->dz + i),
        .inverse_square = r_load(bundle->inverse_square + i)};
}

/* Only slabs need 1 / d, so it is worked out when the first slab is met. */
static inline gi_wide_Ray tile_ray(Tile *tile, GiShapeRef ref, int i) {
    GiBundle *bundle = tile->bundle;
    gi_wide_Ray ray = tile_line(bundle, i);
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
        uint32_t *instance = &tile->bundle->instance[i + lowest_bit(bits)];
        if (*shape != GI_SHAPE_NONE &&
            gi_shape_before(tile->shapes, ref, tile->instance, (GiShapeRef){*shape}, *instance)) {
            *shape = ref.bits;
            *instance = tile->instance;
        }
    }
}

/* Whether one of the rays j .. j + GI_DOUBLES - 1 is among the bits. */
static inline bool any_of(unsigned bits, int j) {
    return (bits >> j & ((1u << GI_DOUBLES) - 1)) != 0;
}

/* How far the rays of a packet still look. */
static inline void packet_refresh_far(Tile *tile, int packet) {
    const GiBundle *bundle = tile->bundle;
    const R scale = R_OF(tile->scale * (1 + GI_WIDER));
    float *far = tile->far + packet * GI_PACKET_SIZE;
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        int i = packet * GI_PACKET_SIZE + j;
        r_store_floats(far + j, r_load(bundle->t + i) * r_load(bundle->depth + i) * scale);
    }
    tile->packets.far[packet] = f_highest(far, GI_PACKET_SIZE);
}

/* These rays of a packet look for nothing any more. Returns whether that was its last. */
static inline bool packet_stop(Tile *tile, int packet, unsigned rays) {
    tile->alive[packet] &= ~rays;
    if (rays == 0 || tile->alive[packet] != 0) return false;
    packet_clear(&tile->packets, packet);
    return true;
}

/* What the rays from i on meet of a shape: what is nearer becomes their best. Returns the bits of
 * rays to which that happened. */
static inline unsigned take_nearer(Tile *tile, GiShapeRef ref, int i, M hit, R t) {
    GiBundle *bundle = tile->bundle;
    R best = r_load(bundle->t + i);
    M nearer = hit & R_LESS(t, best);
    unsigned bits = m_bits(nearer), ties = m_bits(hit & R_EQUAL(t, best));
    if (bits != 0) {
        r_store(bundle->t + i, R_SELECT(nearer, t, best));
        u_store_where(bundle->shape + i, bits, ref.bits);
        u_store_where(bundle->instance + i, bits, tile->instance);
    }
    if (ties != 0) resolve_ties(tile, ref, i, ties);
    return bits;
}

/* How far the rays of the packet look must be found anew, when one of them has met something. */
static inline bool note_nearer(Tile *tile, int packet, unsigned changed) {
    if (changed == 0) return false;
    tile->nearer[packet / 32] |= 1u << packet % 32;
    return true;
}

/* Where the rays from i on meet the shape; corners: of a triangle. */
static inline M tile_meets(Tile *tile, GiShapeRef ref, R corners[3][3], int i, R *t) {
    const GiBundle *bundle = tile->bundle;
    gi_wide_Ray ray = tile_ray(tile, ref, i);
    R t_min = r_load(bundle->t_min + i), t_max = r_load(bundle->t_max + i);
    if (corners != NULL) return gi_wide_triangle_at(corners, &ray, t_min, t_max, t);
    return gi_wide_shape(tile->shapes, ref, &ray, t_min, t_max, t);
}

/* One shape against those rays of a packet whose bits are set. Returns whether anything changed. */
static inline bool test_closest(
    Tile *tile, GiShapeRef ref, R corners[3][3], int packet, unsigned rays) {
    unsigned changed = 0;
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        if (!any_of(rays, j)) continue;
        int i = packet * GI_PACKET_SIZE + j;
        R t;
        M hit = tile_meets(tile, ref, corners, i, &t);
        changed |= take_nearer(tile, ref, i, hit, t);
    }
    return note_nearer(tile, packet, changed);
}

/* The same of spheres. Not inline, so that it has all registers to itself. */
static NOINLINE bool closest_sphere(Tile *tile, GiShapeRef ref, int packet, unsigned rays) {
    const GiBundle *bundle = tile->bundle;
    const GiSphere *sphere = &tile->shapes->spheres[gi_shape_index(ref)];
    unsigned changed = 0;
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        if (!any_of(rays, j)) continue;
        int i = packet * GI_PACKET_SIZE + j;
        gi_wide_Ray ray = tile_line(bundle, i);
        R t;
        M hit =
            gi_wide_sphere(sphere, &ray, r_load(bundle->t_min + i), r_load(bundle->t_max + i), &t);
        changed |= take_nearer(tile, ref, i, hit, t);
    }
    return note_nearer(tile, packet, changed);
}

/* Without those rays that spare this shape. */
static inline unsigned not_sparing(const Tile *tile, GiShapeRef ref, int packet, unsigned rays) {
    const GiBundle *bundle = tile->bundle;
    unsigned skip = sixteen_equal(ref.bits, bundle->skip + packet * GI_PACKET_SIZE);
    if (skip == 0) return rays;
    return rays &
           ~(skip & sixteen_equal(tile->instance, bundle->skip_instance + packet * GI_PACKET_SIZE));
}

static inline bool test_any(
    Tile *tile, GiShapeRef ref, R corners[3][3], int packet, unsigned rays) {
    GiBundle *bundle = tile->bundle;
    unsigned stopped = 0;
    rays = not_sparing(tile, ref, packet, rays);
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        if (!any_of(rays, j)) continue;
        int i = packet * GI_PACKET_SIZE + j;
        R t;
        M hit = tile_meets(tile, ref, corners, i, &t);
        unsigned bits = m_bits(hit) & rays >> j;
        u_store_where(bundle->shape + i, bits, ref.bits);
        stopped |= bits << j;
    }
    return packet_stop(tile, packet, stopped);
}

/* Whether rays enter a sphere within their limits, by far more than the roundings that the answer
 * of gi_wide_sphere takes: without its root. rest and nearest are gi_wide_sphere_rest's. */
static inline M enters_surely(R rest, R nearest, const gi_wide_Ray *ray, R t_min, R t_max) {
    R room = nearest - t_min - R_OF(0x1p-40) * R_ABS(nearest);
    R square = rest * ray->inverse_square * R_OF(1 + 0x1p-40);
    return R_LESS(R_OF(0), room) & R_LESS(square, room * room) & R_LESS(nearest, t_max);
}

static NOINLINE bool any_sphere(Tile *tile, GiShapeRef ref, int packet, unsigned rays) {
    GiBundle *bundle = tile->bundle;
    const GiSphere *sphere = &tile->shapes->spheres[gi_shape_index(ref)];
    unsigned stopped = 0;
    rays = not_sparing(tile, ref, packet, rays);
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        if (!any_of(rays, j)) continue;
        int i = packet * GI_PACKET_SIZE + j;
        gi_wide_Ray ray = tile_line(bundle, i);
        R t, nearest, rest = gi_wide_sphere_rest(sphere, &ray, &nearest);
        unsigned bits = m_bits(R_LESS_EQUAL(R_OF(0), rest)) & rays >> j;
        if (bits == 0) continue;
        R t_min = r_load(bundle->t_min + i), t_max = r_load(bundle->t_max + i);
        unsigned sure = m_bits(enters_surely(rest, nearest, &ray, t_min, t_max));
        if ((bits & ~sure) != 0) bits &= m_bits(gi_wide_sphere(sphere, &ray, t_min, t_max, &t));
        u_store_where(bundle->shape + i, bits, ref.bits);
        stopped |= bits << j;
    }
    return packet_stop(tile, packet, stopped);
}

static inline bool tile_test(Tile *tile, GiShapeRef ref, int packet, unsigned rays) {
    if (gi_shape_kind(ref) == GI_SHAPE_SPHERE) {
        return tile->any ? any_sphere(tile, ref, packet, rays)
                         : closest_sphere(tile, ref, packet, rays);
    }
    if (gi_shape_kind(ref) == GI_SHAPE_TRIANGLE) {
        R corners[3][3];
        gi_wide_corners(&tile->shapes->triangles, gi_shape_index(ref), corners);
        return tile->any ? test_any(tile, ref, corners, packet, rays)
                         : test_closest(tile, ref, corners, packet, rays);
    }
    return tile->any ? test_any(tile, ref, NULL, packet, rays)
                     : test_closest(tile, ref, NULL, packet, rays);
}

/* ---------------------------------------------------------------- instances */

static bool bundle_inside(const Tile *tile, uint32_t instance, GiBundle *inner, double apart);

/* The next larger number: hits at t itself count then, which document order decides about. */
static inline double step_up(double t) {
    uint64_t bits;
    if (!(t < INFINITY)) return t;
    t += 0.0; /* no minus zero */
    memcpy(&bits, &t, sizeof bits);
    bits = t < 0 ? bits - 1 : bits + 1;
    memcpy(&t, &bits, sizeof bits);
    return t;
}

/* Takes the rays of one test into the instance's space, appending them to the inner bundle. */
static inline void take_inside(const Tile *tile, const Test *test, const GiAffine *to_object,
    GiBundle *inner, uint16_t *from) {
    const GiBundle *bundle = tile->bundle;
    unsigned rays = test->rays & tile->alive[test->packet];
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        if (!any_of(rays, j)) continue;
        int first = (int)test->packet * GI_PACKET_SIZE + j;
        gi_wide_Ray ray = {.ox = r_load(bundle->ox + first),
            .oy = r_load(bundle->oy + first),
            .oz = r_load(bundle->oz + first),
            .dx = r_load(bundle->dx + first),
            .dy = r_load(bundle->dy + first),
            .dz = r_load(bundle->dz + first)};
        ray = gi_wide_to_object(&ray, to_object);
        double o[3][GI_DOUBLES], d[3][GI_DOUBLES];
        r_store(o[0], ray.ox);
        r_store(o[1], ray.oy);
        r_store(o[2], ray.oz);
        r_store(d[0], ray.dx);
        r_store(d[1], ray.dy);
        r_store(d[2], ray.dz);
        for (int lane = 0; lane < GI_DOUBLES; lane++) {
            if (!(rays >> (j + lane) & 1)) continue;
            int i = first + lane, to = inner->count++;
            from[to] = (uint16_t)i;
            inner->ox[to] = o[0][lane], inner->oy[to] = o[1][lane], inner->oz[to] = o[2][lane];
            inner->dx[to] = d[0][lane], inner->dy[to] = d[1][lane], inner->dz[to] = d[2][lane];
            inner->t_min[to] = bundle->t_min[i];
            inner->t_max[to] = bundle->t_max[i];
            inner->skip[to] = bundle->skip[i];
            inner->skip_instance[to] = bundle->skip_instance[i];
            if (tile->any) continue;
            bool found = bundle->shape[i] != GI_SHAPE_NONE;
            inner->t[to] = found ? step_up(bundle->t[i]) : bundle->t[i];
        }
    }
}

/* Brings home what the rays of a packet met inside. */
static inline bool bring_home(
    Tile *tile, const GiBundle *inner, const uint16_t *from, int begin, int end) {
    GiBundle *bundle = tile->bundle;
    int packet = from[begin] / GI_PACKET_SIZE;
    unsigned met = 0;
    for (int k = begin; k < end; k++) {
        if (inner->shape[k] == GI_SHAPE_NONE) continue;
        int i = from[k];
        GiShapeRef ref = {inner->shape[k]};
        met |= 1u << i % GI_PACKET_SIZE;
        if (!tile->any && inner->t[k] == bundle->t[i] && bundle->shape[i] != GI_SHAPE_NONE &&
            !gi_shape_before(tile->shapes, ref, inner->instance[k], (GiShapeRef){bundle->shape[i]},
                bundle->instance[i])) {
            continue;
        }
        if (!tile->any) bundle->t[i] = inner->t[k];
        bundle->shape[i] = ref.bits;
        bundle->instance[i] = inner->instance[k];
    }
    if (tile->any) return packet_stop(tile, packet, met);
    if (met != 0) tile->nearer[packet / 32] |= 1u << packet % 32;
    return met != 0;
}

/* All tests of the instance that the first one names: their rays are a bundle of their own, since
 * an affine map leaves them one point in common. The bundle is too large for a frame that is always
 * there, hence a function of its own. Returns whether anything changed. */
static bool tile_instance(Tile *tile, int first) {
    GiBundle inner;
    uint16_t from[GI_BUNDLE_SIZE];
    GiShapeRef ref = tile->tests[first].shape;
    uint32_t index = gi_shape_index(ref);
    const GiInstance *instance = &tile->shapes->instances[index];
    const GiAffine *to_object = &tile->shapes->transforms[instance->transform].to_object;
    inner.count = 0;
    for (int i = first; i < tile->test_count; i++) {
        if (tile->tests[i].shape.bits != ref.bits) continue;
        take_inside(tile, &tile->tests[i], to_object, &inner, from);
        tile->tests[i].rays = 0; /* done */
    }
    if (inner.count == 0) return false;
    inner.apex = gi_affine_point(to_object, tile->bundle->apex);
    inner.side = gi_affine_vector(to_object, tile->bundle->side);
    inner.stop = tile->bundle->stop;
    inner.stop_context = tile->bundle->stop_context;
    /* Sixteen roundings of the numbers that a point's image is the sum of. */
    double largest = gi_largest(tile->bundle->apex), apart = 0;
    for (int row = 0; row < 3; row++) {
        const double *m = to_object->m[row];
        double sum = (fabs(m[0]) + fabs(m[1]) + fabs(m[2])) * largest + fabs(m[3]);
        if (apart < sum) apart = sum;
    }
    tile->stopped |= bundle_inside(tile, index, &inner, 0x1p-48 * apart);
    bool changed = false;
    for (int begin = 0, end; begin < inner.count; begin = end) {
        int packet = from[begin] / GI_PACKET_SIZE;
        for (end = begin + 1; end < inner.count && from[end] / GI_PACKET_SIZE == packet;) end++;
        changed |= bring_home(tile, &inner, from, begin, end);
    }
    return changed;
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
        if (gi_shape_kind(test->shape) == GI_SHAPE_INSTANCE) {
            if (test->rays != 0) changed |= tile_instance(tile, i);
            continue;
        }
        unsigned rays = test->rays & tile->alive[test->packet];
        if (rays != 0) changed |= tile_test(tile, test->shape, (int)test->packet, rays);
    }
    tile_count(tile, tile->test_count);
    tile->test_count = 0;
    if (changed && tile->any) tile_enclose(tile);
    for (int k = 0; k < GI_PACKET_COUNT; k += 32) {
        for (unsigned rest = tile->nearer[k / 32]; rest != 0; rest &= rest - 1) {
            packet_refresh_far(tile, k + lowest_bit(rest));
        }
        tile->nearer[k / 32] = 0;
    }
    if (changed && !tile->any) tile_refresh_far(tile);
}

/* Pairs of one lane of a leaf and a packet. */
typedef struct Pairs {
    int count;
    uint32_t pair[GI_TREE_WIDTH * GI_PACKET_COUNT + 16]; /* lane * GI_PACKET_COUNT + packet */
} Pairs;

/* Notes the tests that a leaf's shapes need. Which shapes, packets and rays these are cannot be
 * foretold, so each step writes a list without asking, and the next runs down the list: branches
 * that go wrong half of the time would cost more than the work. */
static inline void tile_pairs(
    const Tile *tile, const Rectangles *rectangles, unsigned bits, Pairs *pairs) {
    pairs->count = 0;
    for (int g = 0; g < GROUP_COUNT; g++) {
        unsigned rest = bits & tile_group(&tile->groups, g, rectangles);
        for (; rest != 0; rest &= rest - 1) {
            int lane = lowest_bit(rest);
            unsigned packets = tile_overlaps(&tile->packets, rectangles, lane, g * GROUP_SIZE);
            pairs->count += sixteen_append(pairs->pair + pairs->count, packets,
                (uint32_t)(lane * GI_PACKET_COUNT + g * GROUP_SIZE));
        }
    }
}

static inline void tile_block(Tile *tile, uint32_t child) {
    const GiTree *tree = tile->tree;
    uint32_t index = gi_child_index(child);
    Rectangles rectangles;
    const GiShapeRef *shapes;
    unsigned bits;
    if (gi_child_kind(child) == GI_CHILD_SPHERES) {
        bits = tile_spheres(&tile->frustum, &tree->sphere_blocks[index], &rectangles);
        shapes = tree->sphere_blocks[index].shape;
    } else {
        bits = tile_boxes(&tile->frustum, &tree->box_blocks[index], &rectangles);
        shapes = tree->box_blocks[index].shape;
    }
    Pairs pairs;
    tile_pairs(tile, &rectangles, bits, &pairs);
    int count = tile->test_count;
    for (int i = 0; i < pairs.count; i++) {
        int lane = (int)(pairs.pair[i] / GI_PACKET_COUNT);
        uint32_t packet = pairs.pair[i] % GI_PACKET_COUNT;
        unsigned rays = tile_rays(tile, &rectangles, lane, (int)packet);
        prefetch_shape(tile->shapes, shapes[lane]);
        tile->tests[count] = (Test){shapes[lane], packet, rays};
        count += rays != 0;
    }
    tile->test_count = count;
    if (count >= TEST_BATCH) tile_flush(tile);
}

static inline void tile_leaf(Tile *tile, uint32_t child) {
    Rectangles rectangles;
    Edges edges;
    uint32_t first = gi_child_first(child);
    unsigned bits = tile_triangles(&tile->frustum, &tile->shapes->triangles, first,
        gi_child_count(child), &rectangles, &edges);
    Pairs pairs;
    tile_pairs(tile, &rectangles, bits, &pairs);
    int count = tile->test_count;
    for (int i = 0; i < pairs.count; i++) {
        uint32_t lane = pairs.pair[i] / GI_PACKET_COUNT, packet = pairs.pair[i] % GI_PACKET_COUNT;
        unsigned rays = tile_rays_inside(tile, &rectangles, &edges, (int)lane, (int)packet);
        tile->tests[count] = (Test){gi_shape_ref(GI_SHAPE_TRIANGLE, first + lane), packet, rays};
        count += rays != 0;
    }
    tile->test_count = count;
    if (count >= TEST_BATCH) tile_flush(tile);
}

/* Leaves of triangles wait for each other while their corners are on the way from memory. */
enum { LEAF_BATCH = 8 };
typedef struct Leaves {
    int count;
    StackEntry entry[LEAF_BATCH];
} Leaves;

static inline void tile_leaves(Tile *tile, Leaves *leaves) {
    for (int i = 0; i < leaves->count; i++) {
        if (leaves->entry[i].enter <= tile->frustum.far) tile_leaf(tile, leaves->entry[i].child);
    }
    leaves->count = 0;
}

static inline void tile_put_off(Tile *tile, StackEntry entry, Leaves *leaves) {
    const GiTriangles *triangles = &tile->shapes->triangles;
    const uint32_t(*rows)[3] = triangles->corners + gi_child_first(entry.child);
    for (uint32_t i = 0; i < gi_child_count(entry.child); i++) {
        for (int k = 0; k < 3; k++) prefetch(triangles->positions[rows[i][k]]);
    }
    leaves->entry[leaves->count++] = entry;
    if (leaves->count == LEAF_BATCH) tile_leaves(tile, leaves);
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
    StackEntry stack[STACK_LIMIT];
    Leaves leaves = {.count = 0};
    int count = 0;
    if (tree->root != GI_CHILD_NONE) stack[count++] = (StackEntry){tree->root, -INFINITY};
    while (count > 0 && !tile->stopped) {
        StackEntry top = stack[--count];
        if (!(top.enter <= tile->frustum.far)) continue;
        switch (gi_child_kind(top.child)) {
        case GI_CHILD_NODE: {
            const GiNode *node = &tree->nodes[top.child];
            float enter[8];
            unsigned bits = tile_node(&tile->frustum, node, enter);
            count = push_children(tree, tile->shapes, stack, count, node->child, bits, enter);
            break;
        }
        case GI_CHILD_TRIANGLES: tile_put_off(tile, top, &leaves); break;
        default: tile_block(tile, top.child); break;
        }
    }
    tile_leaves(tile, &leaves);
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

/* For closest, bundle->t says how far each ray looks. */
static inline void bundle_one_by_one(const Tile *tile) {
    GiBundle *bundle = tile->bundle;
    for (int i = 0; i < bundle->count; i++) {
        if (i % 16 == 0 && bundle->stop != NULL && bundle->stop(bundle->stop_context)) return;
        GiTraceRay ray = bundle_ray(bundle, i);
        GiTraceHit hit = {tile->any ? ray.t_max : bundle->t[i], {GI_SHAPE_NONE}, GI_SHAPE_NONE};
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
    double toward = tile->any ? -1 : 1;
    tile->scale = tile->tree->scale;
    tile->test_count = tile->tests_made = 0;
    tile->stopped = false;
    for (int i = 0; i < GI_PACKET_COUNT / 32; i++) tile->nearer[i] = 0;
    for (int i = 0; i < GI_BUNDLE_SIZE / 32; i++) tile->inverse_known[i] = 0;
    int end = (bundle->count + GI_PACKET_SIZE - 1) / GI_PACKET_SIZE * GI_PACKET_SIZE;
    for (int i = 0; i < end; i++) bundle->shape[i] = bundle->instance[i] = GI_SHAPE_NONE;
    GiVec u, v, w;
    if (bundle->count >= TILE_MINIMUM && tile_frame(bundle, toward, &u, &v, &w)) {
        tile_pad(bundle);
        if (tile_packets(tile, toward, u, v, w)) {
            tile_planes(tile, u, v, w);
            tile_walk(tile);
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
    bundle_run(&tile);
    return tile.stopped;
}

static inline void bundle_trace(const GiTrace *trace, GiBundle *bundle, bool any) {
    Tile tile;
    tile.tree = trace->tree;
    tile.shapes = trace->shapes;
    tile.instance = GI_SHAPE_NONE;
    tile.apart = 0;
    tile.bundle = bundle;
    tile.any = any;
    if (!any) {
        for (int i = 0; i < bundle->count; i++) bundle->t[i] = bundle->t_max[i];
    }
    bundle_run(&tile);
}

static void GI_KERNEL(bundle_closest)(const GiTrace *trace, GiBundle *bundle) {
    bundle_trace(trace, bundle, false);
}

static void GI_KERNEL(bundle_any)(const GiTrace *trace, GiBundle *bundle) {
    bundle_trace(trace, bundle, true);
}
