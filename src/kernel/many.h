/* SPDX-License-Identifier: MIT
 * Many rays with nothing in common, some of them under way at a time. Part of kernel.c.
 *
 * A single ray spends most of its time waiting: for the next node, and for the processor to find
 * out that it guessed a branch wrong. Here a step is a straight line of code. The rays under way
 * stand in lists by what they do next (a node, a kind of leaf); a round goes through the lists, a
 * loop for each, and what a ray needs in the next round is fetched meanwhile. */
#pragma once

#ifdef GI_HAS_EIGHT

enum {
    WALKER_COUNT = 32, /* 16 do not cover the way to memory, 64 leave the first cache */
    LIST_COUNT = 5     /* GiChildKind, and those that have arrived */
};

/* A ray under way. Of its stack all entries may still hold something: what a hit made too far is
 * thrown out at once, so that the next child is always the topmost, and the lowest entry is no
 * child, which ends the walk. */
typedef struct Walker {
    Line line;
    GiTraceHit best;
    double t_min, t_max;
    float from, to;
    int first_row[3], last_row[3]; /* of a node's low[3] and high[3]: where the line comes first */
    uint32_t skip;                 /* of this tree */
    int number;                    /* of the ray */
    int depth;                     /* of the stack */
    uint32_t child;                /* where it is; off the stack */
    float enter[STACK_LIMIT + 9];
    uint32_t children[STACK_LIMIT + 9];
} Walker;

typedef struct List {
    int count;
    uint32_t walker[WALKER_COUNT];
} List;

/* A ray and a shape that it may meet. */
enum { PAIR_LIMIT = 8 * WALKER_COUNT + 8 };
typedef struct Candidates {
    int count;
    uint32_t walker[PAIR_LIMIT], shape[PAIR_LIMIT];
} Candidates;

typedef struct Wave {
    const GiTrace *trace;
    const GiTraceRay *rays;
    bool any;
    /* Where a child of a kind lies. */
    const char *base[4];
    uint32_t size[4], mask[4];
    List lists[2][LIST_COUNT]; /* of this round and the next */
    Candidates triangles, others;
    Walker walkers[WALKER_COUNT];
} Wave;

static inline void walker_pop(Wave *wave, List *next, uint32_t number) {
    Walker *walker = &wave->walkers[number];
    uint32_t child = walker->children[--walker->depth];
    walker->child = child;
    uint32_t kind = (uint32_t)gi_child_kind(child);
    const char *at = wave->base[kind] + (size_t)(child & wave->mask[kind]) * wave->size[kind];
    prefetch(at);
    prefetch(at + 64);
    prefetch(at + 128);
    prefetch(at + 192);
    List *list = &next[kind + (child == GI_CHILD_NONE)];
    list->walker[list->count++] = number;
}

/* After a hit. */
static inline void walker_shorten(Walker *walker, bool any) {
    if (any) {
        walker->depth = 1;
        return;
    }
    walker->to = line_parameter(&walker->line, walker->best.t);
    int kept = 1;
    for (int i = 1; i < walker->depth; i++) {
        float enter = walker->enter[i];
        walker->children[kept] = walker->children[i];
        walker->enter[kept] = enter;
        kept += enter <= walker->to;
    }
    walker->depth = kept;
}

static inline void walker_begin(Wave *wave, List *next, uint32_t slot, int number) {
    Walker *walker = &wave->walkers[slot];
    const GiTree *tree = wave->trace->tree;
    const GiTraceRay *ray = &wave->rays[number];
    walker->line = line_of(tree, wave->trace->shapes, GI_SHAPE_NONE, ray);
    walker->best = (GiTraceHit){ray->t_max, {GI_SHAPE_NONE}, GI_SHAPE_NONE};
    walker->t_min = ray->t_min;
    walker->t_max = ray->t_max;
    walker->number = number;
    walker->skip = ray->skip_instance == GI_SHAPE_NONE ? ray->skip : GI_SHAPE_NONE;
    for (int axis = 0; axis < 3; axis++) {
        walker->first_row[axis] = 8 * (axis + 3 * walker->line.negative[axis]);
        walker->last_row[axis] = 8 * (axis + 3 * !walker->line.negative[axis]);
    }
    bool found = false;
    for (uint32_t i = 0; i < tree->unbounded_count && !(found && wave->any); i++) {
        found |= line_test(&walker->line, tree->unbounded[i], wave->any, &walker->best);
    }
    walker->from = line_parameter(&walker->line, ray->t_min);
    walker->to = line_parameter(&walker->line, walker->best.t);
    walker->children[0] = GI_CHILD_NONE;
    walker->depth = 1;
    if (!(found && wave->any) && walker->from <= walker->to) {
        walker->children[1] = tree->root;
        walker->enter[1] = walker->from;
        walker->depth = 2;
    }
    walker_pop(wave, next, slot);
}

/* The children that the line meets come onto the stack, the nearest on top. */
static inline void walker_node(const Wave *wave, Walker *walker) {
    const GiNode *node = &wave->trace->tree->nodes[gi_child_index(walker->child)];
    const float *rows = (const float *)node;
    F near = f_of(walker->from), far = f_of(walker->to);
    for (int axis = 0; axis < 3; axis++) {
        F first = f_load(rows + walker->first_row[axis]);
        F last = f_load(rows + walker->last_row[axis]);
        F origin = f_of(walker->line.origin[axis]), inverse = f_of(walker->line.inverse[axis]);
        near = f_max((first - origin) * inverse, near);
        far = f_min((last - origin) * inverse, far);
    }
    walker->depth += eight_push_sorted(walker->enter + walker->depth,
        walker->children + walker->depth, near, node->child, f_less_equal(near, far));
}

/* ---------------------------------------------------------------- leaves */

static inline void pairs_add(
    Candidates *pairs, uint32_t number, const GiShapeRef shape[8], unsigned bits) {
    eight_fill(pairs->walker + pairs->count, number);
    pairs->count += eight_append(pairs->shape + pairs->count, shape, bits);
}

static inline void wave_spheres(Wave *wave, const List *list) {
    for (int i = 0; i < list->count; i++) {
        uint32_t number = list->walker[i];
        const Walker *walker = &wave->walkers[number];
        const GiSphereBlock *block =
            &wave->trace->tree->sphere_blocks[gi_child_index(walker->child)];
        unsigned bits = line_spheres(&walker->line, block, walker->from, walker->to);
        bits &= ~eight_equal(walker->skip, block->shape);
        pairs_add(&wave->others, number, block->shape, bits);
    }
}

static inline void wave_boxes(Wave *wave, const List *list) {
    for (int i = 0; i < list->count; i++) {
        uint32_t number = list->walker[i];
        const Walker *walker = &wave->walkers[number];
        const GiBoxBlock *block = &wave->trace->tree->box_blocks[gi_child_index(walker->child)];
        float enter[8];
        unsigned bits =
            line_boxes(&walker->line, block->low, block->high, walker->from, walker->to, enter);
        bits &= ~eight_equal(walker->skip, block->shape);
        unsigned triangles =
            bits & eight_of_kind(gi_shape_ref(GI_SHAPE_TRIANGLE, 0).bits, block->shape);
        pairs_add(&wave->triangles, number, block->shape, triangles);
        pairs_add(&wave->others, number, block->shape, bits & ~triangles);
    }
}

/* The corners of eight triangles. */
static inline void eight_triangles(
    const GiTriangles *triangles, const uint32_t number[8], float points[3][3][8]) {
    for (int corner = 0; corner < 3; corner++) {
        const float *at[8];
        for (int i = 0; i < 8; i++) {
            at[i] = triangles->positions[triangles->corners[number[i]][corner]];
        }
        eight_points(at, points[corner]);
    }
}

static inline void load_corners(float points[3][3][8], int i, R corners[3][3]) {
    for (int corner = 0; corner < 3; corner++) {
        for (int axis = 0; axis < 3; axis++) {
            corners[corner][axis] = r_from_floats(points[corner][axis] + i);
        }
    }
}

/* The shapes of a leaf against its ray, a shape in each lane. Triangles are not looked at in single
 * precision first, which takes as long. */
static inline void walker_triangles(const Wave *wave, Walker *walker) {
    const GiTraceRay *given = walker->line.given;
    const gi_hit_Ray *line = &walker->line.ray;
    uint32_t first = gi_child_first(walker->child), number[8];
    int count = (int)gi_child_count(walker->child);
    for (int i = 0; i < 8; i++) number[i] = first + (uint32_t)(i < count ? i : count - 1);
    float points[3][3][8];
    eight_triangles(&wave->trace->shapes->triangles, number, points);
    const gi_wide_Ray ray = {.ox = R_OF(line->ox),
        .oy = R_OF(line->oy),
        .oz = R_OF(line->oz),
        .dx = R_OF(line->dx),
        .dy = R_OF(line->dy),
        .dz = R_OF(line->dz),
        .inverse_square = R_OF(line->inverse_square)};
    bool found = false;
    for (int i = 0; i < count; i += GI_DOUBLES) {
        R corners[3][3], t;
        load_corners(points, i, corners);
        M hit = gi_wide_triangle_at(corners, &ray, R_OF(given->t_min), R_OF(given->t_max), &t);
        unsigned bits = m_bits(hit & R_LESS_EQUAL(t, R_OF(walker->best.t)));
        if (count - i < GI_DOUBLES) bits &= (1u << (count - i)) - 1;
        if (bits == 0) continue;
        double meets[GI_DOUBLES];
        r_store(meets, t);
        for (; bits != 0; bits &= bits - 1) {
            int k = lowest_bit(bits);
            GiShapeRef ref = gi_shape_ref(GI_SHAPE_TRIANGLE, number[i + k]);
            if (ref.bits == walker->skip) continue;
            found |= line_keep(&walker->line, ref, meets[k], &walker->best);
        }
    }
    if (found) walker_shorten(walker, wave->any);
}

static inline void wave_triangles(Wave *wave, const List *list) {
    for (int i = 0; i < list->count; i++) {
        walker_triangles(wave, &wave->walkers[list->walker[i]]);
    }
}

/* ---------------------------------------------------------------- candidates */

/* Rays and limits of GI_DOUBLES candidates. */
typedef struct Lanes {
    gi_wide_Ray ray;
    R t_min, t_max, best;
} Lanes;

static inline Lanes lanes_of(const Wave *wave, const uint32_t *walker) {
    const Walker *first = wave->walkers;
    const gi_hit_Ray *ray = &first->line.ray;
#define LANES(member) r_gather(&(member), walker, (int)(sizeof *first / sizeof(double)))
    return (Lanes){.ray = {.ox = LANES(ray->ox),
                       .oy = LANES(ray->oy),
                       .oz = LANES(ray->oz),
                       .dx = LANES(ray->dx),
                       .dy = LANES(ray->dy),
                       .dz = LANES(ray->dz),
                       .inverse_square = LANES(ray->inverse_square)},
        .t_min = LANES(first->t_min),
        .t_max = LANES(first->t_max),
        .best = LANES(first->best.t)};
#undef LANES
}

/* The lanes behind the last candidate repeat it. */
static inline void candidates_pad(Candidates *candidates) {
    int last = candidates->count - 1;
    eight_fill(candidates->walker + last + 1, candidates->walker[last]);
    eight_fill(candidates->shape + last + 1, candidates->shape[last]);
}

/* Keeps those of GI_DOUBLES candidates, from begin on, whose bits are set. */
static inline void wave_keep(
    Wave *wave, const Candidates *candidates, int begin, unsigned bits, R t) {
    int count = candidates->count - begin;
    if (count < GI_DOUBLES) bits &= (1u << count) - 1;
    if (bits == 0) return;
    double meets[GI_DOUBLES];
    r_store(meets, t);
    for (; bits != 0; bits &= bits - 1) {
        int k = lowest_bit(bits);
        Walker *walker = &wave->walkers[candidates->walker[begin + k]];
        GiShapeRef ref = {candidates->shape[begin + k]};
        if (line_keep(&walker->line, ref, meets[k], &walker->best)) {
            walker_shorten(walker, wave->any);
        }
    }
}

static inline void test_triangles(Wave *wave) {
    Candidates *candidates = &wave->triangles;
    if (candidates->count == 0) return;
    candidates_pad(candidates);
    for (int i = 0; i < candidates->count; i += 8) {
        uint32_t number[8];
        for (int k = 0; k < 8; k++) {
            number[k] = gi_shape_index((GiShapeRef){candidates->shape[i + k]});
        }
        float points[3][3][8];
        eight_triangles(&wave->trace->shapes->triangles, number, points);
        for (int k = 0; k < 8 && i + k < candidates->count; k += GI_DOUBLES) {
            Lanes lanes = lanes_of(wave, candidates->walker + i + k);
            R corners[3][3], t;
            load_corners(points, k, corners);
            M hit = gi_wide_triangle_at(corners, &lanes.ray, lanes.t_min, lanes.t_max, &t);
            wave_keep(wave, candidates, i + k, m_bits(hit & R_LESS_EQUAL(t, lanes.best)), t);
        }
    }
    candidates->count = 0;
}

static inline void test_others(Wave *wave) {
    Candidates *candidates = &wave->others;
    for (int i = 0; i < candidates->count; i++) {
        Walker *walker = &wave->walkers[candidates->walker[i]];
        GiShapeRef ref = {candidates->shape[i]};
        if (line_test(&walker->line, ref, wave->any, &walker->best)) {
            walker_shorten(walker, wave->any);
        }
    }
    candidates->count = 0;
}

/* ---------------------------------------------------------------- the wave */

static inline void wave_init(Wave *wave, const GiTrace *trace, const GiTraceRay *rays, bool any) {
    wave->trace = trace;
    wave->rays = rays;
    wave->any = any;
    const GiTree *tree = trace->tree;
    wave->base[GI_CHILD_NODE] = (const char *)tree->nodes;
    wave->base[GI_CHILD_TRIANGLES] = (const char *)trace->shapes->triangles.corners;
    wave->base[GI_CHILD_BOXES] = (const char *)tree->box_blocks;
    wave->base[GI_CHILD_SPHERES] = (const char *)tree->sphere_blocks;
    wave->size[GI_CHILD_NODE] = sizeof *tree->nodes;
    wave->size[GI_CHILD_TRIANGLES] = sizeof *trace->shapes->triangles.corners;
    wave->size[GI_CHILD_BOXES] = sizeof *tree->box_blocks;
    wave->size[GI_CHILD_SPHERES] = sizeof *tree->sphere_blocks;
    for (int i = 0; i < 4; i++) wave->mask[i] = 0x3fffffffu;
    wave->mask[GI_CHILD_TRIANGLES] = 0x07ffffffu;
    for (int i = 0; i < LIST_COUNT; i++) wave->lists[0][i].count = wave->lists[1][i].count = 0;
    wave->triangles.count = wave->others.count = 0;
}

/* hits, or for `any` blocked. */
static inline void wave_run(const GiTrace *trace, const GiTraceRay *rays, int count, bool any,
    GiTraceHit *hits, bool *blocked) {
    Wave wave;
    wave_init(&wave, trace, rays, any);
    List *now = wave.lists[0], *next = wave.lists[1];
    int started = 0, under_way = 0;
    for (; started < count && started < WALKER_COUNT; started++, under_way++) {
        walker_begin(&wave, next, (uint32_t)started, started);
    }
    while (under_way > 0) {
        List *swap = now;
        now = next;
        next = swap;
        for (int i = 0; i < LIST_COUNT; i++) next[i].count = 0;
        for (int i = 0; i < now[GI_CHILD_NODE].count; i++) {
            uint32_t number = now[GI_CHILD_NODE].walker[i];
            walker_node(&wave, &wave.walkers[number]);
            walker_pop(&wave, next, number);
        }
        wave_spheres(&wave, &now[GI_CHILD_SPHERES]);
        wave_boxes(&wave, &now[GI_CHILD_BOXES]);
        wave_triangles(&wave, &now[GI_CHILD_TRIANGLES]);
        test_triangles(&wave);
        test_others(&wave);
        for (int kind = GI_CHILD_TRIANGLES; kind <= GI_CHILD_SPHERES; kind++) {
            for (int i = 0; i < now[kind].count; i++) walker_pop(&wave, next, now[kind].walker[i]);
        }
        for (int i = 0; i < now[LIST_COUNT - 1].count; i++) {
            uint32_t number = now[LIST_COUNT - 1].walker[i];
            const Walker *walker = &wave.walkers[number];
            if (any) {
                blocked[walker->number] = walker->best.shape.bits != GI_SHAPE_NONE;
            } else {
                hits[walker->number] = walker->best;
            }
            if (started < count) {
                walker_begin(&wave, next, number, started++);
            } else {
                under_way--;
            }
        }
    }
}

static void GI_KERNEL(many_closest)(
    const GiTrace *trace, const GiTraceRay *rays, int count, GiTraceHit *hits) {
    wave_run(trace, rays, count, false, hits, NULL);
}

static void GI_KERNEL(many_any)(
    const GiTrace *trace, const GiTraceRay *rays, int count, bool *blocked) {
    wave_run(trace, rays, count, true, NULL, blocked);
}

#else

static void GI_KERNEL(many_closest)(
    const GiTrace *trace, const GiTraceRay *rays, int count, GiTraceHit *hits) {
    for (int i = 0; i < count; i++) GI_KERNEL(closest)(trace, &rays[i], &hits[i]);
}

static void GI_KERNEL(many_any)(
    const GiTrace *trace, const GiTraceRay *rays, int count, bool *blocked) {
    for (int i = 0; i < count; i++) blocked[i] = GI_KERNEL(any)(trace, &rays[i]);
}

#endif
