/* SPDX-License-Identifier: MIT
 * Many rays with nothing in common, some of them under way at a time. Part of kernel.c.
 *
 * A single ray spends most of its time waiting: for the next node, and for the processor to find
 * out that it guessed a branch wrong. Here a step is a straight line of code. The rays under way
 * stand in lists by what they do next (a node, a kind of leaf); a round goes through the lists, a
 * loop for each, and what a ray needs in the next round is fetched meanwhile.
 *
 * Tried, and no faster: spheres by gathered lanes (their numbers are few, to collect them costs as
 * much), a list of their own for them, popping in a loop apart from pushing. */
#pragma once

#ifdef GI_HAS_EIGHT

enum {
    WALKER_COUNT = 32, /* 16 are up to a tenth slower, 64 no faster */
    LIST_COUNT = 5,    /* GiChildKind, and what else stands on a stack */
    STACK_ROOM = 96    /* deep enough for all but strange trees, and the rays stay close together */
};

/* What else stands on a stack, above the children that there can be: an instance to go into, the
 * way out of it, and the end, which looks like no child. */
#define CHILD_INSTANCE 0xe0000000u /* and its index */
#define CHILD_OUTSIDE  0xfffffffeu

/* A ray under way. What a hit makes too far is thrown off the stack at once, so that the topmost
 * entry is always the next. */
typedef struct Walker {
    Line line; /* in the tree it is in */
    GiTraceHit best;
    double t_min, t_max;
    float from, to;
    int first_row[3], last_row[3]; /* of a node's low[3] and high[3]: where the line comes first */
    uint32_t skip;                 /* of this tree */
    int number;                    /* of the ray */
    int depth;                     /* of the stack */
    int floor;                     /* the lowest entry of this tree lies above */
    uint32_t child;                /* where it is; off the stack */
    const char *base[4];           /* where a tree has its children of a kind */
    float enter[STACK_ROOM];
    uint32_t children[STACK_ROOM];
    Line outside; /* while in an instance */
} Walker;

typedef struct List {
    int count;
    uint32_t walker[WALKER_COUNT];
} List;

/* Rays and shapes that they may meet. */
enum { CANDIDATE_LIMIT = 8 * WALKER_COUNT + 8 };
typedef struct Candidates {
    int count;
    uint32_t walker[CANDIDATE_LIMIT], shape[CANDIDATE_LIMIT];
} Candidates;

typedef struct Wave {
    const GiTrace *trace;
    const GiTraceRay *rays;
    bool any;
    uint32_t size[4], mask[4];              /* of a child of a kind: bytes, bits of the index */
    List *now, *next, lists[2][LIST_COUNT]; /* what walkers do in this round and in the next */
    List idle;
    Candidates triangles, others;
    Walker walkers[WALKER_COUNT];
} Wave;

/* On to the topmost entry. */
static inline void walker_pop(Wave *wave, uint32_t number) {
    Walker *walker = &wave->walkers[number];
    uint32_t child = walker->children[--walker->depth];
    walker->child = child;
    uint32_t kind = (uint32_t)gi_child_kind(child);
    const char *at = walker->base[kind] + (size_t)(child & wave->mask[kind]) * wave->size[kind];
    prefetch(at);
    prefetch(at + 64);
    prefetch(at + 128);
    prefetch(at + 192);
    List *list = &wave->next[kind + (child >= CHILD_INSTANCE)];
    list->walker[list->count++] = number;
}

/* After a hit. */
static inline void walker_shorten(Walker *walker, bool any) {
    if (any) {
        walker->depth = 1;
        return;
    }
    walker->to = line_parameter(&walker->line, walker->best.t);
    int kept = walker->floor + 1;
    for (int i = kept; i < walker->depth; i++) {
        float enter = walker->enter[i];
        walker->children[kept] = walker->children[i];
        walker->enter[kept] = enter;
        kept += enter <= walker->to;
    }
    walker->depth = kept;
}

/* Its line is new. */
static inline void walker_turn(Walker *walker) {
    const Line *line = &walker->line;
    const GiTraceRay *given = line->given;
    walker->skip = given->skip_instance == line->instance ? given->skip : GI_SHAPE_NONE;
    walker->base[GI_CHILD_NODE] = (const char *)line->tree->nodes;
    walker->base[GI_CHILD_TRIANGLES] = (const char *)line->shapes->triangles.corners;
    walker->base[GI_CHILD_BOXES] = (const char *)line->tree->box_blocks;
    walker->base[GI_CHILD_SPHERES] = (const char *)line->tree->sphere_blocks;
    for (int axis = 0; axis < 3; axis++) {
        walker->first_row[axis] = 8 * (axis + 3 * line->negative[axis]);
        walker->last_row[axis] = 8 * (axis + 3 * !line->negative[axis]);
    }
}

/* Whether the stack may not hold a node's children, a block's instances, the two entries of one of
 * these, and what whole vectors write behind them. The ray is then
 * traced alone, from its beginning. */
static inline bool walker_gives_up(const Wave *wave, Walker *walker) {
    if (walker->depth <= STACK_ROOM - 24) return false;
    const GiTraceRay *given = walker->line.given;
    walker->best = (GiTraceHit){given->t_max, {GI_SHAPE_NONE}, GI_SHAPE_NONE};
    walker->depth = 1;
    line_alone(wave->trace, given, wave->any, &walker->best);
    return true;
}

/* From the top of a tree. */
static inline void walker_descend(Walker *walker, bool any) {
    const GiTree *tree = walker->line.tree;
    bool found = false;
    for (uint32_t i = 0; i < tree->unbounded_count && !(found && any); i++) {
        found |= line_test(&walker->line, tree->unbounded[i], any, &walker->best);
    }
    if (found) walker_shorten(walker, any);
    walker->children[walker->depth] = tree->root;
    walker->enter[walker->depth] = walker->from;
    walker->depth += !(found && any) && tree->root != GI_CHILD_NONE && walker->from <= walker->to;
}

/* Up to GI_DOUBLES rays set out, with the operations of line_of. */
static inline void wave_begin(Wave *wave, int first, int count) {
    const GiTree *tree = wave->trace->tree;
    const GiTraceRay *rays = wave->rays + first;
    uint32_t index[GI_DOUBLES];
    for (int i = 0; i < GI_DOUBLES; i++) index[i] = (uint32_t)(i < count ? i : count - 1);
#define LANES(member) r_gather(&rays->member, index, (int)(sizeof *rays / sizeof(double)))
    const gi_wide_Ray ray = gi_wide_ray(LANES(origin.x), LANES(origin.y), LANES(origin.z),
        LANES(direction.x), LANES(direction.y), LANES(direction.z));
    R t_min = LANES(t_min), t_max = LANES(t_max);
#undef LANES
    R scale = R_OF(tree->scale);
    R length = R_SQRT(ray.dx * ray.dx + ray.dy * ray.dy + ray.dz * ray.dz);
    R origin[3] = {(ray.ox - R_OF(tree->center.x)) * scale, (ray.oy - R_OF(tree->center.y)) * scale,
        (ray.oz - R_OF(tree->center.z)) * scale};
    R part = R_OF(1) / length;
    R direction[3] = {ray.dx * part, ray.dy * part, ray.dz * part};
    R shift = origin[0] * direction[0] + origin[1] * direction[1] + origin[2] * direction[2];
    length = length * scale;
    double o[10][GI_DOUBLES], lengths[GI_DOUBLES], shifts[GI_DOUBLES];
    float places[3][GI_DOUBLES], slopes[3][GI_DOUBLES], inverses[3][GI_DOUBLES];
    float from[GI_DOUBLES], to[GI_DOUBLES];
    const R numbers[10] = {
        ray.ox, ray.oy, ray.oz, ray.dx, ray.dy, ray.dz, ray.ix, ray.iy, ray.iz, ray.inverse_square};
    for (int i = 0; i < 10; i++) r_store(o[i], numbers[i]);
    r_store(lengths, length);
    r_store(shifts, shift);
    r_store_floats(from, t_min * length + shift);
    r_store_floats(to, t_max * length + shift);
    for (int axis = 0; axis < 3; axis++) {
        R d = direction[axis];
        r_store_floats(places[axis], origin[axis] - d * shift);
        r_store_floats(slopes[axis], d);
        r_store_floats(
            inverses[axis], R_SELECT(R_LESS(R_ABS(d), R_OF(1e-30)), R_OF(1e30), R_OF(1) / d));
    }
    for (int i = 0; i < count; i++) {
        uint32_t number = wave->idle.walker[--wave->idle.count];
        Walker *walker = &wave->walkers[number];
        Line *line = &walker->line;
        line->tree = tree;
        line->shapes = wave->trace->shapes;
        line->instance = GI_SHAPE_NONE;
        line->given = &rays[i];
        line->ray = (gi_hit_Ray){o[0][i], o[1][i], o[2][i], o[3][i], o[4][i], o[5][i], o[6][i],
            o[7][i], o[8][i], o[9][i]};
        for (int axis = 0; axis < 3; axis++) {
            line->origin[axis] = places[axis][i];
            line->direction[axis] = slopes[axis][i];
            line->inverse[axis] = inverses[axis][i];
            line->negative[axis] = inverses[axis][i] < 0;
        }
        line->length = lengths[i];
        line->shift = shifts[i];
        walker->best = (GiTraceHit){rays[i].t_max, {GI_SHAPE_NONE}, GI_SHAPE_NONE};
        walker->t_min = rays[i].t_min;
        walker->t_max = rays[i].t_max;
        walker->from = from[i];
        walker->to = to[i];
        walker->number = first + i;
        walker->children[0] = GI_CHILD_NONE;
        walker->floor = 0;
        walker->depth = 1;
        walker_turn(walker);
        walker_descend(walker, wave->any);
        walker_pop(wave, number);
    }
}

static inline void walker_enter(const Wave *wave, Walker *walker, uint32_t index) {
    const GiShapes *shapes = wave->trace->shapes;
    walker->outside = walker->line;
    const GiTraceRay *given = walker->line.given;
    const GiTraceRay inner = ray_inside(shapes, index, given);
    walker->line = line_of(shapes->instances[index].tree, shapes, index, &inner, false);
    walker->line.given = given; /* but for origin and direction the same */
    walker->from = line_parameter(&walker->line, walker->t_min);
    walker->to = line_parameter(&walker->line, walker->best.t);
    walker->floor = walker->depth;
    walker->children[walker->depth++] = CHILD_OUTSIDE;
    walker_turn(walker);
    walker_descend(walker, wave->any);
}

static inline void walker_leave(Walker *walker) {
    walker->line = walker->outside;
    walker->from = line_parameter(&walker->line, walker->t_min);
    walker->floor = 0;
    walker_turn(walker);
    walker_shorten(walker, false);
}

/* The children that the line meets come onto the stack, the nearest on top. */
static inline void walker_node(Walker *walker) {
    const GiNode *node = &walker->line.tree->nodes[gi_child_index(walker->child)];
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

static inline void candidates_add(
    Candidates *candidates, uint32_t number, const GiShapeRef shape[8], unsigned bits) {
    eight_fill(candidates->walker + candidates->count, number);
    candidates->count += eight_append(candidates->shape + candidates->count, shape, bits);
}

static inline void wave_spheres(Wave *wave, const List *list) {
    for (int i = 0; i < list->count; i++) {
        uint32_t number = list->walker[i];
        const Walker *walker = &wave->walkers[number];
        const GiSphereBlock *block =
            &walker->line.tree->sphere_blocks[gi_child_index(walker->child)];
        unsigned bits = line_spheres(&walker->line, block, walker->from, walker->to);
        bits &= ~eight_equal(walker->skip, block->shape);
        candidates_add(&wave->others, number, block->shape, bits);
    }
}

/* Instances are walked through like nodes. */
static inline void walker_instances(
    Walker *walker, const GiBoxBlock *block, unsigned bits, const float enter[8]) {
    uint32_t child[8];
    for (int i = 0; i < 8; i++) child[i] = CHILD_INSTANCE | gi_shape_index(block->shape[i]);
    walker->depth += eight_push_sorted(walker->enter + walker->depth,
        walker->children + walker->depth, f_load(enter), child, bits);
}

static inline void wave_boxes(Wave *wave, const List *list) {
    for (int i = 0; i < list->count; i++) {
        uint32_t number = list->walker[i];
        Walker *walker = &wave->walkers[number];
        const GiBoxBlock *block = &walker->line.tree->box_blocks[gi_child_index(walker->child)];
        float enter[8];
        unsigned bits =
            line_boxes(&walker->line, block->low, block->high, walker->from, walker->to, enter);
        bits &= ~eight_equal(walker->skip, block->shape);
        unsigned instances =
            bits & eight_of_kind(gi_shape_ref(GI_SHAPE_INSTANCE, 0).bits, block->shape);
        if (instances != 0) {
            walker_instances(walker, block, instances, enter);
            bits &= ~instances;
        }
        unsigned triangles =
            bits & eight_of_kind(gi_shape_ref(GI_SHAPE_TRIANGLE, 0).bits, block->shape);
        candidates_add(&wave->triangles, number, block->shape, triangles);
        candidates_add(&wave->others, number, block->shape, bits & ~triangles);
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
    wave->size[GI_CHILD_NODE] = sizeof(GiNode);
    wave->size[GI_CHILD_TRIANGLES] = sizeof *trace->shapes->triangles.corners;
    wave->size[GI_CHILD_BOXES] = sizeof(GiBoxBlock);
    wave->size[GI_CHILD_SPHERES] = sizeof(GiSphereBlock);
    for (int i = 0; i < 4; i++) wave->mask[i] = gi_child_index(UINT32_MAX);
    wave->mask[GI_CHILD_TRIANGLES] = gi_child_first(UINT32_MAX);
    wave->now = wave->lists[0];
    wave->next = wave->lists[1];
    for (int i = 0; i < LIST_COUNT; i++) wave->next[i].count = 0;
    wave->triangles.count = wave->others.count = 0;
    wave->idle.count = WALKER_COUNT;
    for (uint32_t i = 0; i < WALKER_COUNT; i++) wave->idle.walker[i] = i;
}

/* All walkers take a step. */
static inline void wave_round(Wave *wave) {
    List *now = wave->next, *next = wave->now;
    wave->now = now;
    wave->next = next;
    for (int i = 0; i < LIST_COUNT; i++) next[i].count = 0;
    for (int i = 0; i < now[GI_CHILD_NODE].count; i++) {
        uint32_t number = now[GI_CHILD_NODE].walker[i];
        if (!walker_gives_up(wave, &wave->walkers[number])) walker_node(&wave->walkers[number]);
        walker_pop(wave, number);
    }
    wave_spheres(wave, &now[GI_CHILD_SPHERES]);
    wave_boxes(wave, &now[GI_CHILD_BOXES]);
    wave_triangles(wave, &now[GI_CHILD_TRIANGLES]);
    test_triangles(wave);
    test_others(wave);
    for (int kind = GI_CHILD_TRIANGLES; kind <= GI_CHILD_SPHERES; kind++) {
        for (int i = 0; i < now[kind].count; i++) walker_pop(wave, now[kind].walker[i]);
    }
}

/* hits, or for `any` blocked. */
static inline void wave_run(const GiTrace *trace, const GiTraceRay *rays, int count, bool any,
    GiTraceHit *hits, bool *blocked) {
    Wave wave;
    wave_init(&wave, trace, rays, any);
    for (int started = 0, arrived = 0; arrived < count;) {
        while (started < count && wave.idle.count >= GI_DOUBLES) {
            int together = count - started < GI_DOUBLES ? count - started : GI_DOUBLES;
            wave_begin(&wave, started, together);
            started += together;
        }
        wave_round(&wave);
        const List *list = &wave.now[LIST_COUNT - 1];
        for (int i = 0; i < list->count; i++) {
            uint32_t number = list->walker[i];
            Walker *walker = &wave.walkers[number];
            if (walker->child != GI_CHILD_NONE) {
                if (walker->child == CHILD_OUTSIDE) {
                    walker_leave(walker);
                } else {
                    walker_enter(&wave, walker, walker->child & ~CHILD_INSTANCE);
                }
                walker_pop(&wave, number);
                continue;
            }
            arrived++;
            wave.idle.walker[wave.idle.count++] = number;
            if (any) {
                blocked[walker->number] = walker->best.shape.bits != GI_SHAPE_NONE;
            } else {
                hits[walker->number] = walker->best;
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
