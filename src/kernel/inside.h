/* SPDX-License-Identifier: MIT
 * Instances of a bundle: the rays that reach one become a bundle of its space. Part of kernel.c. */
#pragma once

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
static inline void take_inside(
    Tile *tile, const Test *test, const GiAffine *to_object, GiBundle *inner, uint16_t *from) {
    const GiBundle *bundle = tile->bundle;
    unsigned rays = test->rays & tile->alive[test->packet];
    unsigned open = rays & tile->open[test->packet];
    if (open != 0) tile_settle(tile, (int)test->packet, open);
    for (int j = 0; j < GI_PACKET_SIZE; j += GI_DOUBLES) {
        if (!any_of(rays, j)) continue;
        int first = (int)test->packet * GI_PACKET_SIZE + j;
        const gi_wide_Ray line = tile_line(tile, first);
        const gi_wide_Ray ray = gi_wide_to_object(&line, to_object);
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
            inner->dx[to] = d[0][lane], inner->dy[to] = d[1][lane], inner->dz[to] = d[2][lane];
            if (tile->any) {
                inner->ox[to] = o[0][lane], inner->oy[to] = o[1][lane], inner->oz[to] = o[2][lane];
                inner->t_min[to] = bundle->t_min[i];
                inner->skip[to] = bundle->skip[i];
                inner->skip_instance[to] = bundle->skip_instance[i];
            } else {
                bool found = bundle->shape[i] != GI_SHAPE_NONE;
                inner->t[to] = found ? step_up(bundle->t[i]) : bundle->t[i];
            }
        }
    }
}

/* Brings home what the rays of a packet met inside. */
static inline void bring_home(
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
    if (tile->any) {
        packet_stop(tile, packet, met);
    } else if (met != 0) {
        tile->nearer[packet / 32] |= 1u << packet % 32;
    }
}

/* All tests of the instance that the first one names: their rays are a bundle of their own, since
 * an affine map leaves them one point in common. The bundle is too large for a frame that is always
 * there, hence a function of its own. */
static void tile_instance(Tile *tile, int first) {
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
    if (inner.count == 0) return;
    inner.start = tile->bundle->start;
    inner.end = tile->bundle->end;
    inner.own = tile->any;
    inner.apex = gi_affine_point(to_object, tile->bundle->apex);
    inner.side = gi_affine_vector(to_object, tile->bundle->side);
    inner.without_t = false;
    inner.stop = tile->bundle->stop;
    inner.stop_context = tile->bundle->stop_context;
    /* Sixteen roundings of the numbers that a point's image is the sum of. */
    double largest = gi_largest(tile->bundle->apex), apart = 0;
    const int rows = tile->frustum.parallel ? 0 : 3; /* parallel lines need not meet */
    for (int row = 0; row < rows; row++) {
        const double *m = to_object->m[row];
        double sum = (fabs(m[0]) + fabs(m[1]) + fabs(m[2])) * largest + fabs(m[3]);
        if (apart < sum) apart = sum;
    }
    tile->stopped |= bundle_inside(tile, index, &inner, 0x1p-48 * apart);
    for (int begin = 0, end; begin < inner.count; begin = end) {
        int packet = from[begin] / GI_PACKET_SIZE;
        for (end = begin + 1; end < inner.count && from[end] / GI_PACKET_SIZE == packet;) end++;
        bring_home(tile, &inner, from, begin, end);
    }
}
