/* SPDX-License-Identifier: MIT
 * Shadow rays of a bundle that run in one direction: their apex is infinitely far away. Part of
 * kernel.c.
 *
 * The plane of the packets lies across the direction, and (a, b) are lengths in kernel space, from
 * the tree's centre; so is depth, which grows away from the light and has no beginning. All else is
 * as in bundle.h: a ray looks for what overlaps its point and lies before its own depth.
 *
 * What the tree holds is within 1 of the centre along each axis. Along u, v and w it errs by less
 * than 16 roundings, which is less than what boxes and spheres are grown by; corners of triangles,
 * which are not grown, err by less than 32 roundings and twice `error`, and all rectangles are
 * widened by 64. A ray's point is worked out in doubles and rounded once. Directions are the same
 * for all rays to the bit, but across u and v only to 2^-50, and the exact test rounds as well: of
 * how far away a ray begins, 64 roundings of doubles are lost. Those that begin more than 2^16 away
 * are traced one by one, so that this is less than GI_PARALLEL_LOST, by which everything is grown:
 * next to the centre the tree's own growth is less. */
#pragma once

#define GI_PARALLEL_LOST 0x1p-31f

/* The rays from i on as points. Bits of those that begin too far away, or nowhere. */
static inline unsigned rays_place_parallel(Tile *tile, int i, GiVec u, GiVec v) {
    const GiBundle *bundle = tile->bundle;
    const GiVec *center = &tile->tree->center, direction = gi_bundle_direction(bundle, 0);
    const R scale = R_OF(tile->scale), limit = R_OF(0x1p16);
    const R step = R_OF(gi_dot(tile->toward, direction));
    R a[GI_PARTS], b[GI_PARTS], far[GI_PARTS];
    M near = M_OF(true);
    for (int k = 0; k < GI_PARTS; k++) {
        int at = i + k * GI_DOUBLES;
        R x = r_load(bundle->ox + at) - R_OF(center->x);
        R y = r_load(bundle->oy + at) - R_OF(center->y);
        R z = r_load(bundle->oz + at) - R_OF(center->z);
        a[k] = tile_dot(u, x, y, z) * scale;
        b[k] = tile_dot(v, x, y, z) * scale;
        R ahead = tile_dot(tile->toward, x, y, z) + r_load(bundle->t_min + at) * step;
        far[k] = R_OF(0) - ahead * scale;
        near = near & R_LESS(R_ABS(a[k]), limit) & R_LESS(R_ABS(b[k]), limit) &
               R_LESS(R_ABS(far[k]), limit);
    }
    const P depth = p_rounded(far), wider = p_of(GI_PARALLEL_WIDER);
    P slack = p_fused(p_max(depth, p_of(0) - depth), wider, wider);
    p_store(tile->a + i, p_rounded(a));
    p_store(tile->b + i, p_rounded(b));
    p_store(tile->far + i, depth + slack);
    p_store(tile->surely + i, depth - slack);
    return m_bits(near) ^ m_bits(M_OF(true));
}

/* As tile_packets. */
static bool parallel_packets(Tile *tile, GiVec u, GiVec v) {
    int count = (tile->bundle->count + GI_PACKET_SIZE - 1) / GI_PACKET_SIZE;
    unsigned strange = 0;
    for (int k = 0; k < count; k += GI_FLOATS) {
        int end = k + GI_FLOATS < count ? k + GI_FLOATS : count;
        for (int i = k * GI_PACKET_SIZE; i < end * GI_PACKET_SIZE; i += GI_WIDEST) {
            strange |= rays_place_parallel(tile, i, u, v);
        }
        packets_enclose(tile, k);
    }
    packets_begin(tile, count);
    tile->frustum.start = -INFINITY;
    tile->frustum.margin = GI_PARALLEL_LOST;
    return strange == 0;
}

/* ---------------------------------------------------------------- spheres */

/* Sure is that the line meets the sphere, and that the middle of what it has inside lies before the
 * ray's end. */
static inline Verdict parallel_sphere(
    const Tile *tile, const Spheres *spheres, int lane, float nearest, int packet) {
    const P x = p_of(spheres->x[lane]), y = p_of(spheres->y[lane]), z = p_of(spheres->z[lane]);
    const P outer = p_of(spheres->outer[lane]), inner = p_of(spheres->inner[lane]);
    Verdict verdict = {0, 0};
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_WIDEST) {
        int i = packet * GI_PACKET_SIZE + j;
        P a = p_load(tile->a + i) - x, b = p_load(tile->b + i) - y;
        P apart = p_fused(a, a, b * b);
        unsigned maybe =
            p_less_equal(apart, outer) & p_less_equal(p_of(nearest), p_load(tile->far + i));
        unsigned sure = p_less_equal(apart, inner) & p_less(z, p_load(tile->surely + i));
        verdict.maybe |= maybe << j;
        verdict.sure |= sure << j;
    }
    return verdict;
}

static inline void parallel_balls(Tile *tile, const GiSphereBlock *block,
    const Rectangles *rectangles, const Spheres *spheres, const Pairs *pairs) {
    for (int i = 0; i < pairs->count; i++) {
        uint32_t lane = pairs->pair[i] / GI_PACKET_COUNT, packet = pairs->pair[i] % GI_PACKET_COUNT;
        Verdict verdict =
            parallel_sphere(tile, spheres, (int)lane, rectangles->near[lane], (int)packet);
        unsigned rays = take_certain(tile, block->shape[lane], (int)packet, verdict);
        note_solid(tile, GI_SHAPE_SPHERE, (Test){block->shape[lane], packet, rays});
    }
}

/* ---------------------------------------------------------------- triangles */

/* As tile_triangles; `blur` is the greatest depth. */
static inline unsigned parallel_triangles(const Frustum *frustum, const GiTriangles *triangles,
    uint32_t first, uint32_t count, Rectangles *rectangles, Edges *edges) {
    float corners[3][3][8];
    seen_corners(&frustum->seen, triangles, first, count, corners);
    const F wider = f_of(GI_PARALLEL_WIDER + 2 * frustum->seen.error);
    unsigned bits = 0;
    edges->left = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        F a[3], b[3], depth[3];
        for (int k = 0; k < 3; k++) {
            F x = f_load(corners[k][0] + i), y = f_load(corners[k][1] + i),
              z = f_load(corners[k][2] + i);
            a[k] = frame_dot(frustum->axis[0], x, y, z);
            b[k] = frame_dot(frustum->axis[1], x, y, z);
            depth[k] = frame_dot(frustum->axis[2], x, y, z);
        }
        const Reach reach = {f_min(a[0], f_min(a[1], a[2])), f_max(a[0], f_max(a[1], a[2])),
            f_min(b[0], f_min(b[1], b[2])), f_max(b[0], f_max(b[1], b[2])),
            f_min(depth[0], f_min(depth[1], depth[2])), f_max(depth[0], f_max(depth[1], depth[2]))};
        F extent = (reach.x1 - reach.x0) + (reach.y1 - reach.y0);
        bits |= rectangles_across(frustum, i, &reach, wider, rectangles);
        f_store(edges->slack + i, f_of(4) * wider * (extent + f_of(5) * wider));
        f_store(edges->blur + i, reach.z1 + wider);
        for (int k = 0; k < 3; k++) {
            int next = (k + 1) % 3;
            F x = b[k] - b[next], y = a[next] - a[k];
            f_store(edges->x[k] + i, x);
            f_store(edges->y[k] + i, y);
            f_store(edges->z[k] + i, f_of(0) - (x * a[k] + y * b[k]));
        }
    }
    return bits & ((1u << count) - 1);
}

/* Of the rays within the triangle's rectangle, for which `slack` is more than a side errs by. */
static inline Verdict parallel_triangle(
    const Tile *tile, const Rectangles *rectangles, const Edges *edges, int lane, int packet) {
    const P slack = p_of(edges->slack[lane]), deepest = p_of(edges->blur[lane]), zero = p_of(0);
    Verdict verdict = {0, 0};
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_WIDEST) {
        int i = packet * GI_PACKET_SIZE + j;
        P a = p_load(tile->a + i), b = p_load(tile->b + i), least, most;
        edges_sides(edges, lane, a, b, &least, &most);
        unsigned maybe = p_less_equal(zero - slack, least) | p_less_equal(most, slack);
        unsigned sure = (p_less(slack, least) | p_less(most, zero - slack)) &
                        p_less(deepest, p_load(tile->surely + i));
        verdict.maybe |= maybe << j;
        verdict.sure |= sure << j;
    }
    verdict.maybe &= tile_rays(tile, rectangles, lane, packet);
    return verdict;
}

static inline void parallel_leaf(Tile *tile, Entry entry) {
    Rectangles rectangles;
    Edges edges;
    uint32_t first = gi_child_first(entry.child);
    COUNT(leaves, 1);
    unsigned bits = parallel_triangles(&tile->frustum, &tile->shapes->triangles, first,
        gi_child_count(entry.child), &rectangles, &edges);
    Pairs pairs;
    tile_pairs(tile, &rectangles, bits, entry.groups, &pairs);
    int count = tile->test_count;
    for (int i = 0; i < pairs.count; i++) {
        uint32_t lane = pairs.pair[i] / GI_PACKET_COUNT, packet = pairs.pair[i] % GI_PACKET_COUNT;
        GiShapeRef ref = gi_shape_ref(GI_SHAPE_TRIANGLE, first + lane);
        Verdict verdict = parallel_triangle(tile, &rectangles, &edges, (int)lane, (int)packet);
        unsigned rays = take_certain(tile, ref, (int)packet, verdict);
        tile->tests[count] = (Test){ref, packet, rays};
        count += rays != 0;
    }
    tile_noted(tile, count);
}

/* ---------------------------------------------------------------- all other shapes */

/* By their boxes alone. */
static inline void parallel_block(Tile *tile, const GiBoxBlock *block, const Rectangles *rectangles,
    unsigned bits, unsigned groups) {
    Pairs pairs;
    tile_pairs(tile, rectangles, bits, groups, &pairs);
    for (int i = 0; i < pairs.count; i++) {
        int lane = (int)(pairs.pair[i] / GI_PACKET_COUNT);
        int packet = (int)(pairs.pair[i] % GI_PACKET_COUNT);
        GiShapeRef ref = block->shape[lane];
        unsigned rays = tile_rays(tile, rectangles, lane, packet);
        tile_note(tile, (Test){ref, (uint32_t)packet, rays});
    }
}
