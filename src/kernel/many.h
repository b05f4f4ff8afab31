/* SPDX-License-Identifier: MIT
 * Many rays with nothing in common, some of them under way at a time. Part of kernel.c.
 *
 * A single ray spends most of its time waiting: for the next node, and for the processor to find
 * out that it guessed a branch wrong. Here a step is a straight line of code. A round takes each
 * ray under way a step further, those that meet a node in one loop, those that meet a kind of leaf
 * in the next; then all go on to what is on top of their stacks, and that is fetched.
 *
 * A step is in single precision and leaves few shapes: what it needs is in an Aim. The shapes that
 * are left are tested in double precision, with what is in a Walker.
 *
 * Staying below the error bound of layout.h: as in single.h the origin o of a line is its point of
 * closest approach, not farther from the centre than any point of the line. A plane b is met at
 * b / d - o / d, where both quotients are rounded, which moves the plane by 2^-23 (|b| + |o|) at
 * most.
 *
 * Tried, and no faster: two or four nodes side by side in one loop; children in the order of the
 * ray's octant (12 to 31 % more steps); fetching in the loops themselves, some steps ahead (4 %
 * faster where all is in the cache, 5 to 9 % slower where it is not); fetching the corners of
 * triangles or the spheres that are left. */
#pragma once

#ifdef GI_HAS_EIGHT

enum {
    WALKER_COUNT = 64, /* 32 are 6 to 20 % slower, 96 no faster; a multiple of sixteen */
    STACK_ROOM = 96,   /* deep enough for all but strange trees */
    /* Room for a node's children, a block's instances, the two entries of one of these. */
    STACK_LEFT = STACK_ROOM - 24
};

/* What else stands on a stack, above the children that there can be: an instance to go into, the
 * way out of it, and the end, which looks like no child. */
#define CHILD_INSTANCE 0xe0000000u /* and its index */
#define CHILD_OUTSIDE  0xf0000000u
#define CHILD_END      0xf8000000u

/* The line of a ray as steps see it, in kernel space but for triangles. Two cache lines, written by
 * wave_begin in eights. */
typedef struct Aim {
    _Alignas(64) float from;
    float to;
    float inverse[3], shift[3]; /* it meets a plane at plane * inverse - shift */
    float origin[3], direction[3];
    float error;                       /* how far the point is off, at most, */
    float behind;                      /* and how far behind it the ray may start */
    float high[3], low[3];             /* a point of the line, a sum of two floats, not scaled */
    uint8_t first_row[4], last_row[4]; /* bytes from a node's beginning: where it comes first */
    const char *base[4];               /* where a tree has its children of a kind */
} Aim;

/* What hits a ray are too far for are thrown off its stack at once, so that the topmost entry is
 * always the next. */
typedef struct Stack {
    float enter[STACK_ROOM];
    uint32_t child[STACK_ROOM];
} Stack;

/* The rest, for exact tests. */
typedef struct Walker {
    _Alignas(64) gi_hit_Ray ray; /* in the space of the tree that it is in */
    double length, shift;        /* parameter in kernel space = t * length + shift */
    double t_min, t_max;
    GiTraceHit best;
    const GiTraceRay *given;
    const GiTree *tree;
    uint32_t instance; /* whose tree this is, or GI_SHAPE_NONE */
    uint32_t skip;     /* of this tree */
    int number;        /* of the ray; -1: none */
    int floor;         /* the lowest entry of this tree lies above */
} Walker;

/* What a walker in an instance comes back to. */
typedef struct Outside {
    gi_hit_Ray ray;
    double length, shift;
    Aim aim;
} Outside;

typedef struct List {
    int count;
    uint32_t walker[WALKER_COUNT + 16];
} List;

/* Rays and shapes that they may meet. */
enum { CANDIDATE_LIMIT = 8 * WALKER_COUNT + 8 };
typedef struct Candidates {
    int count;
    uint32_t walker[CANDIDATE_LIMIT], shape[CANDIDATE_LIMIT];
} Candidates;

typedef struct Wave {
    uint32_t child[WALKER_COUNT]; /* where walkers are; off the stack */
    int32_t depth[WALKER_COUNT];  /* of the stacks */
    Aim aims[WALKER_COUNT];
    Stack stacks[WALKER_COUNT];
    Walker walkers[WALKER_COUNT];
    Outside outside[WALKER_COUNT];
    Candidates candidates;
    const GiTrace *trace;
    const GiTraceRay *rays;
    const uint32_t (*corners)[3];    /* of triangles; at least eight */
    uint32_t last_eight;             /* the first of the last eight */
    uint32_t few[8][3];              /* when there are less */
    const char *base[4];             /* of the scene's own tree */
    bool any, has_instances, has[4]; /* kinds of children */
} Wave;

/* What a line's point is off, relative to the numbers it is made of, sixteenfold for the products
 * that it goes into (aim_triangles). */
#define AIM_ERROR (16 * 0x1p-47)

static inline void aim_rows(Aim *aim) {
    /* By the signs of the direction: x, y, z in bits 0, 1, 2. */
    static const uint32_t rows[8] = {
        0x402000, 0x402060, 0x408000, 0x408060, 0xa02000, 0xa02060, 0xa08000, 0xa08060};
    unsigned octant =
        (aim->inverse[0] < 0) | (aim->inverse[1] < 0) << 1 | (aim->inverse[2] < 0) << 2;
    memcpy(aim->first_row, &rows[octant], sizeof aim->first_row);
    memcpy(aim->last_row, &rows[octant ^ 7], sizeof aim->last_row);
}

/* wave_begin has the same for the rays of a wave. */
static void aim_of(Aim *aim, const Line *line, double t_min) {
    const gi_hit_Ray *ray = &line->ray;
    const double world[3] = {ray->ox, ray->oy, ray->oz}, along[3] = {ray->dx, ray->dy, ray->dz};
    bool far = fabs(line->shift) > 4;
    double step = far ? -line->shift / line->length : 0, largest = 0;
    double behind = (far ? 0 : line->shift) - (t_min * line->length + line->shift);
    for (int axis = 0; axis < 3; axis++) {
        aim->origin[axis] = line->origin[axis];
        aim->direction[axis] = line->direction[axis];
        aim->inverse[axis] = line->inverse[axis];
        aim->shift[axis] = line->origin[axis] * line->inverse[axis];
        double point = world[axis] + along[axis] * step;
        aim->high[axis] = (float)point;
        aim->low[axis] = (float)(point - (double)aim->high[axis]);
        largest = fmax(largest, fabs(point) + fabs(world[axis]));
    }
    aim->error = (float)(largest * AIM_ERROR);
    aim->behind = (float)(fmax(behind, 0) * (1 + 0x1p-20) / line->tree->scale);
    aim->from = line_parameter(line, t_min);
    aim_rows(aim);
}

static inline void prefetch_lines(const char *at, int count) {
    for (int i = 0; i < count; i++) prefetch(at + 64 * i);
}

/* On to the topmost entry, and at the end nowhere. */
static inline void walker_pop(Wave *wave, uint32_t number) {
    int depth = wave->depth[number];
    depth -= depth > 0;
    wave->depth[number] = depth;
    wave->child[number] = wave->stacks[number].child[depth];
}

static inline float walker_parameter(const Walker *walker, double t) {
    return (float)(t * walker->length + walker->shift);
}

/* After a hit. */
static inline void walker_shorten(Wave *wave, uint32_t number) {
    const Walker *walker = &wave->walkers[number];
    Stack *stack = &wave->stacks[number];
    if (wave->any) {
        wave->depth[number] = 1;
        return;
    }
    float to = walker_parameter(walker, walker->best.t);
    wave->aims[number].to = to;
    /* Entries are off by a few units in the last place. */
    wave->depth[number] = eight_keep_up_to(stack->enter, stack->child, walker->floor + 1,
        wave->depth[number], to + fabsf(to) * 0x1p-19f);
}

static inline void tree_bases(const Wave *wave, const GiTree *tree, const char *base[4]) {
    base[GI_CHILD_NODE] = (const char *)tree->nodes;
    base[GI_CHILD_TRIANGLES] = (const char *)wave->corners;
    base[GI_CHILD_BOXES] = (const char *)tree->box_blocks;
    base[GI_CHILD_SPHERES] = (const char *)tree->sphere_blocks;
}

/* The ray is traced alone, from its beginning: the stack may not hold more. */
static void walker_give_up(Wave *wave, uint32_t number) {
    Walker *walker = &wave->walkers[number];
    const GiTraceRay *given = walker->given;
    walker->best = (GiTraceHit){given->t_max, {GI_SHAPE_NONE}, GI_SHAPE_NONE};
    wave->depth[number] = 1;
    line_alone(wave->trace, given, wave->any, &walker->best);
}

/* Shapes without bounds. Returns whether an answer is found. */
static bool walker_unbounded(Wave *wave, uint32_t number) {
    Walker *walker = &wave->walkers[number];
    const Line line = {.shapes = wave->trace->shapes,
        .instance = walker->instance,
        .given = walker->given,
        .ray = walker->ray};
    bool found = false;
    for (uint32_t i = 0; i < walker->tree->unbounded_count && !(found && wave->any); i++) {
        found |= line_test(&line, walker->tree->unbounded[i], wave->any, &walker->best);
    }
    if (found) walker_shorten(wave, number);
    return found && wave->any;
}

/* From the top of a tree. */
static inline void walker_descend(Wave *wave, uint32_t number) {
    const GiTree *tree = wave->walkers[number].tree;
    const Aim *aim = &wave->aims[number];
    bool enters = tree->root != GI_CHILD_NONE;
    if (tree->unbounded_count > 0) enters &= !walker_unbounded(wave, number);
    int depth = wave->depth[number];
    wave->stacks[number].child[depth] = tree->root;
    wave->stacks[number].enter[depth] = aim->from;
    wave->depth[number] = depth + (enters & (aim->from <= aim->to));
    walker_pop(wave, number);
}

/* Up to eight rays set out, with the operations of line_of. Triangles are seen from the ray's
 * origin, or from the point of closest approach when the origin is far away. */
static inline void wave_begin(Wave *wave, const uint32_t *walkers, int first, int count) {
    const GiTree *tree = wave->trace->tree;
    const GiTraceRay *rays = wave->rays + first;
    const R scale = R_OF(tree->scale), zero = R_OF(0);
    const R center[3] = {R_OF(tree->center.x), R_OF(tree->center.y), R_OF(tree->center.z)};
    prefetch_lines((const char *)(rays + 8), 8 * sizeof *rays / 64); /* the next */
    double exact[12][8];
    float aims[24][8]; /* what an Aim begins with; the rows come later */
    memset(aims[22], 0, 2 * sizeof aims[22]);
    for (int begin = 0; begin < 8; begin += GI_DOUBLES) {
        uint32_t index[GI_DOUBLES];
        for (int i = 0; i < GI_DOUBLES; i++) {
            index[i] = (uint32_t)(begin + i < count ? begin + i : count - 1);
        }
#define LANES(member) r_gather(&rays->member, u_load(index), (int)(sizeof *rays / sizeof(double)))
        const gi_wide_Ray ray = gi_wide_ray(LANES(origin.x), LANES(origin.y), LANES(origin.z),
            LANES(direction.x), LANES(direction.y), LANES(direction.z));
        R t_min = LANES(t_min), t_max = LANES(t_max);
#undef LANES
        const R world[3] = {ray.ox, ray.oy, ray.oz}, along[3] = {ray.dx, ray.dy, ray.dz};
        const R inverse[3] = {ray.ix, ray.iy, ray.iz};
        R size = R_SQRT(ray.dx * ray.dx + ray.dy * ray.dy + ray.dz * ray.dz);
        R part = size * ray.inverse_square, length = size * scale;
        R origin[3], direction[3];
        for (int axis = 0; axis < 3; axis++) {
            origin[axis] = (world[axis] - center[axis]) * scale;
            direction[axis] = along[axis] * part;
        }
        R shift = origin[0] * direction[0] + origin[1] * direction[1] + origin[2] * direction[2];
        R start = t_min * length + shift;
        M far = R_LESS(R_OF(4), R_ABS(shift));
        R step = R_SELECT(far, zero - shift * part * R_OF(1 / tree->scale), zero);
        R behind = R_MAX(R_SELECT(far, zero, shift) - start, zero);
        R largest = zero;
        for (int axis = 0; axis < 3; axis++) {
            R place = origin[axis] - direction[axis] * shift;
            R slope = inverse[axis] * size;
            slope = R_SELECT(R_LESS(R_OF(1e30), R_ABS(slope)), R_OF(1e30), slope);
            R point = world[axis] + along[axis] * step;
            r_store_floats(aims[2 + axis] + begin, slope);
            r_store_floats(aims[5 + axis] + begin, place * slope);
            r_store_floats(aims[8 + axis] + begin, place);
            r_store_floats(aims[11 + axis] + begin, direction[axis]);
            r_store_floats(aims[16 + axis] + begin, point);
            R low = point - r_from_floats(aims[16 + axis] + begin);
            r_store_floats(aims[19 + axis] + begin, low);
            largest = R_MAX(largest, R_ABS(point) + R_ABS(world[axis]));
        }
        r_store_floats(aims[0] + begin, start);
        r_store_floats(aims[1] + begin, t_max * length + shift);
        r_store_floats(aims[14] + begin, largest * R_OF(AIM_ERROR));
        r_store_floats(aims[15] + begin, behind * R_OF((1 + 0x1p-20) / tree->scale));
        const R numbers[12] = {ray.ox, ray.oy, ray.oz, ray.dx, ray.dy, ray.dz, ray.ix, ray.iy,
            ray.iz, ray.inverse_square, length, shift};
        for (int i = 0; i < 12; i++) r_store(exact[i] + begin, numbers[i]);
    }
    for (int part = 0; part < 3; part++) {
        float *to[8];
        for (int i = 0; i < 8; i++) {
            to[i] = (float *)(void *)&wave->aims[walkers[i]] + 8 * part;
        }
        eight_transpose(to, aims + 8 * part);
    }
    for (int i = 0; i < count; i++) {
        uint32_t number = walkers[i];
        Walker *walker = &wave->walkers[number];
        Aim *aim = &wave->aims[number];
        aim_rows(aim);
        memcpy(aim->base, wave->base, sizeof aim->base);
        const GiTraceRay *ray = &rays[i];
        walker->tree = tree;
        walker->instance = GI_SHAPE_NONE;
        walker->given = ray;
        walker->ray = (gi_hit_Ray){exact[0][i], exact[1][i], exact[2][i], exact[3][i], exact[4][i],
            exact[5][i], exact[6][i], exact[7][i], exact[8][i], exact[9][i]};
        walker->length = exact[10][i];
        walker->shift = exact[11][i];
        walker->best = (GiTraceHit){ray->t_max, {GI_SHAPE_NONE}, GI_SHAPE_NONE};
        walker->t_min = ray->t_min;
        walker->t_max = ray->t_max;
        walker->skip = ray->skip_instance == GI_SHAPE_NONE ? ray->skip : GI_SHAPE_NONE;
        walker->number = first + i;
        walker->floor = 0;
        wave->depth[number] = 1;
        walker_descend(wave, number);
    }
}

static void walker_enter(Wave *wave, uint32_t number, uint32_t index) {
    const GiShapes *shapes = wave->trace->shapes;
    Walker *walker = &wave->walkers[number];
    Aim *aim = &wave->aims[number];
    wave->outside[number] = (Outside){walker->ray, walker->length, walker->shift, *aim};
    const GiTraceRay *given = walker->given;
    const GiTraceRay inner = ray_inside(shapes, index, given);
    const Line line = line_of(shapes->instances[index].tree, shapes, index, &inner, false);
    walker->ray = line.ray;
    walker->length = line.length;
    walker->shift = line.shift;
    walker->tree = line.tree;
    walker->instance = index;
    walker->skip = given->skip_instance == index ? given->skip : GI_SHAPE_NONE;
    aim_of(aim, &line, given->t_min);
    aim->to = walker_parameter(walker, walker->best.t);
    tree_bases(wave, line.tree, aim->base);
    walker->floor = wave->depth[number];
    wave->stacks[number].child[wave->depth[number]++] = CHILD_OUTSIDE;
    walker_descend(wave, number);
}

static void walker_leave(Wave *wave, uint32_t number) {
    Walker *walker = &wave->walkers[number];
    const Outside *outside = &wave->outside[number];
    walker->ray = outside->ray;
    walker->length = outside->length;
    walker->shift = outside->shift;
    walker->tree = wave->trace->tree;
    walker->instance = GI_SHAPE_NONE;
    walker->skip =
        walker->given->skip_instance == GI_SHAPE_NONE ? walker->given->skip : GI_SHAPE_NONE;
    walker->floor = 0;
    wave->aims[number] = outside->aim;
    if (!wave->any) walker_shorten(wave, number);
    walker_pop(wave, number);
}

/* Bits of the eight boxes that the line meets, and where it enters them. */
static inline unsigned aim_boxes(const Aim *aim, const float low[3][8], F *enter) {
    const char *rows = (const char *)low; /* and behind them those of the high corners */
    F near = f_of(aim->from), far = f_of(aim->to);
    for (int axis = 0; axis < 3; axis++) {
        F first = f_load((const float *)(const void *)(rows + aim->first_row[axis]));
        F last = f_load((const float *)(const void *)(rows + aim->last_row[axis]));
        F inverse = f_of(aim->inverse[axis]), shift = f_of(aim->shift[axis]);
        near = f_max(f_fused_less(first, inverse, shift), near);
        far = f_min(f_fused_less(last, inverse, shift), far);
    }
    *enter = near;
    return f_less_equal(near, far);
}

/* They come onto the stack, the nearest on top. */
static inline void wave_push(
    Wave *wave, uint32_t number, const uint32_t child[8], unsigned bits, F enter) {
    Stack *stack = &wave->stacks[number];
    int depth = wave->depth[number];
    wave->depth[number] =
        depth + eight_push_sorted(stack->enter + depth, stack->child + depth, enter, child, bits);
}

static inline void wave_nodes(Wave *wave, const List *list) {
    for (int i = 0; i < list->count; i++) {
        uint32_t number = list->walker[i];
        if (wave->depth[number] > STACK_LEFT) {
            walker_give_up(wave, number);
            continue;
        }
        const Aim *aim = &wave->aims[number];
        const GiNode *node = (const GiNode *)(const void *)aim->base[GI_CHILD_NODE] +
                             gi_child_index(wave->child[number]);
        F enter;
        unsigned bits = aim_boxes(aim, node->low, &enter);
        wave_push(wave, number, node->child, bits, enter);
    }
}

/* ---------------------------------------------------------------- leaves */

/* Returns the new count, which loops keep: vectors might be written over one in memory, for all
 * that the compiler knows. */
static inline int candidates_add(
    Candidates *candidates, int count, uint32_t number, const GiShapeRef shape[8], unsigned bits) {
    eight_fill(candidates->walker + count, number);
    return count + eight_append(candidates->shape + count, shape, bits);
}

/* Spheres whose interval on the line overlaps the ray's. A line that passes by has an interval of
 * no numbers. The growth of the radius, 2^-19 of the largest distance, is more than what the
 * distance of line and centre errs by, so no interval is too short; where its middle is errs by 10
 * roundings of the distance from the line's origin, which is below 4: hence the slack. */
static inline unsigned aim_spheres(const Aim *aim, const GiSphereBlock *block) {
    const float slack = 0x1p-18f;
    F x = f_load(block->center[0]) - f_of(aim->origin[0]);
    F y = f_load(block->center[1]) - f_of(aim->origin[1]);
    F z = f_load(block->center[2]) - f_of(aim->origin[2]);
    F dx = f_of(aim->direction[0]), dy = f_of(aim->direction[1]), dz = f_of(aim->direction[2]);
    F middle = f_fused(x, dx, f_fused(y, dy, z * dz));
    x = f_less_fused(middle, dx, x);
    y = f_less_fused(middle, dy, y);
    z = f_less_fused(middle, dz, z);
    F radius = f_load(block->radius), square = f_fused(x, x, f_fused(y, y, z * z));
    F half = f_sqrt(f_fused_less(radius, radius, square));
    return f_less_equal(middle - half, f_of(aim->to + slack)) &
           f_less_equal(f_of(aim->from - slack), middle + half);
}

static inline void wave_spheres(Wave *wave, const List *list) {
    int count = wave->candidates.count;
    for (int i = 0; i < list->count; i++) {
        uint32_t number = list->walker[i];
        const Aim *aim = &wave->aims[number];
        const GiSphereBlock *block =
            (const GiSphereBlock *)(const void *)aim->base[GI_CHILD_SPHERES] +
            gi_child_index(wave->child[number]);
        count =
            candidates_add(&wave->candidates, count, number, block->shape, aim_spheres(aim, block));
    }
    wave->candidates.count = count;
}

/* Instances are walked through like nodes. */
static inline void wave_boxes(Wave *wave, const List *list) {
    int count = wave->candidates.count;
    for (int i = 0; i < list->count; i++) {
        uint32_t number = list->walker[i];
        const Aim *aim = &wave->aims[number];
        const GiBoxBlock *block = (const GiBoxBlock *)(const void *)aim->base[GI_CHILD_BOXES] +
                                  gi_child_index(wave->child[number]);
        F enter;
        unsigned bits = aim_boxes(aim, block->low, &enter);
        unsigned instances =
            bits & eight_of_kind(gi_shape_ref(GI_SHAPE_INSTANCE, 0).bits, block->shape);
        if (instances != 0) {
            uint32_t child[8];
            for (int k = 0; k < 8; k++) child[k] = CHILD_INSTANCE | gi_shape_index(block->shape[k]);
            wave_push(wave, number, child, instances, enter);
        }
        count = candidates_add(&wave->candidates, count, number, block->shape, bits & ~instances);
    }
    wave->candidates.count = count;
}

/* Those of eight triangles that the line may meet (Moeller, Trumbore 1997): not beyond any edge,
 * nor behind the ray's origin, by more than the slack.
 *
 * Corner a is rounded twice, relative to the line's point, so it errs by 2^-23 of its largest
 * coordinate S and by the point's error; an edge by 2^-24 of its own, H. By way of the products, of
 * three roundings each, u, v and their difference from the determinant err by less than
 * 150 * 2^-24 (S + H) H and 16 times the point's error times H. The volume, which is t times the
 * determinant, errs by 60 * 2^-24 S H^2. The part of S in its slack is for triangles seen edge-on,
 * where the exact test too may find them at 2^-50 S too far away. */
static inline unsigned aim_triangles(
    const Aim *aim, const float (*positions)[3], const uint32_t rows[8][3]) {
    F a[3], e1[3], e2[3];
    {
        F corners[3][3];
        for (int corner = 0; corner < 3; corner++) {
            const float *points[8];
            for (int i = 0; i < 8; i++) points[i] = positions[rows[i][corner]];
            eight_coordinates(points, corners[corner]);
        }
        for (int axis = 0; axis < 3; axis++) {
            e1[axis] = corners[0][axis] - corners[1][axis];
            e2[axis] = corners[2][axis] - corners[0][axis];
            a[axis] = corners[0][axis] - f_of(aim->high[axis]) - f_of(aim->low[axis]);
        }
    }
    F dx = f_of(aim->direction[0]), dy = f_of(aim->direction[1]), dz = f_of(aim->direction[2]);
#define CROSS(a1, b2, a2, b1)       f_fused_less(a1, b2, (a2) * (b1))
#define DOT(ax, bx, ay, by, az, bz) f_fused(ax, bx, f_fused(ay, by, (az) * (bz)))
    F px = CROSS(dy, e2[2], dz, e2[1]), py = CROSS(dz, e2[0], dx, e2[2]),
      pz = CROSS(dx, e2[1], dy, e2[0]);
    F qx = CROSS(e1[1], a[2], e1[2], a[1]), qy = CROSS(e1[2], a[0], e1[0], a[2]),
      qz = CROSS(e1[0], a[1], e1[1], a[0]);
    F determinant = DOT(e1[0], px, e1[1], py, e1[2], pz);
    F u = DOT(a[0], px, a[1], py, a[2], pz);
    F v = DOT(dx, qx, dy, qy, dz, qz);
    F volume = DOT(e2[0], qx, e2[1], qy, e2[2], qz);
#undef CROSS
#undef DOT
    F w = determinant - u - v;
    F reach = f_larger_size(f_larger_size(a[0], a[1]), a[2]);
    F edge = f_larger_size(f_larger_size(f_larger_size(e1[0], e1[1]), f_larger_size(e1[2], e2[0])),
        f_larger_size(e2[1], e2[2]));
    F slack =
        f_fused(edge, f_fused(reach + edge, f_of(0x1p-16f), f_of(aim->error)), f_of(0x1p-120f));
    F least = f_min(u, f_min(v, w)), most = f_max(u, f_max(v, w));
    F sign = f_signed_by(f_of(1), determinant);
    F ahead = f_fused(f_fused(reach, f_of(0x1p-20f), edge), slack,
        f_fused(determinant * f_of(aim->behind), sign, volume * sign));
    return (f_less_equal(f_of(0), least + slack) | f_less_equal(most, slack)) &
           f_less_equal(f_of(0), ahead);
}

static inline void wave_triangles(Wave *wave, const List *list) {
    int count = wave->candidates.count;
    for (int i = 0; i < list->count; i++) {
        uint32_t number = list->walker[i];
        uint32_t child = wave->child[number], first = gi_child_first(child);
        uint32_t begin = first < wave->last_eight ? first : wave->last_eight;
        const float(*positions)[3] = wave->trace->shapes->triangles.positions;
        unsigned bits = aim_triangles(&wave->aims[number], positions, wave->corners + begin);
        bits &= ((1u << gi_child_count(child)) - 1) << (first - begin);
        eight_fill(wave->candidates.walker + count, number);
        count += eight_append_indices(
            wave->candidates.shape + count, gi_shape_ref(GI_SHAPE_TRIANGLE, begin).bits, bits);
    }
    wave->candidates.count = count;
}

/* ---------------------------------------------------------------- candidates */

/* One by one: of most leaves no shape is left, of few more than one. */
static inline void wave_candidates(Wave *wave) {
    const Candidates *candidates = &wave->candidates;
    const GiShapes *shapes = wave->trace->shapes;
    for (int i = 0; i < candidates->count; i++) {
        uint32_t number = candidates->walker[i];
        Walker *walker = &wave->walkers[number];
        GiShapeRef ref = {candidates->shape[i]};
        const gi_hit_Ray *ray = &walker->ray;
        double t_min = walker->t_min, t_max = walker->t_max, t = 0;
        if (ref.bits == walker->skip) continue;
        bool met;
        switch (gi_shape_kind(ref)) {
        case GI_SHAPE_SPHERE:
            met = gi_hit_sphere(&shapes->spheres[gi_shape_index(ref)], ray, t_min, t_max, &t);
            break;
        case GI_SHAPE_TRIANGLE:
            met = gi_hit_triangle(&shapes->triangles, gi_shape_index(ref), ray, t_min, t_max, &t);
            break;
        default: met = gi_hit_shape(shapes, ref, ray, t_min, t_max, &t);
        }
        const GiTraceHit hit = {t, ref, walker->instance};
        if (met && keep_hit(shapes, hit, &walker->best)) walker_shorten(wave, number);
    }
    wave->candidates.count = 0;
}

/* ---------------------------------------------------------------- the wave */

static inline void wave_init(Wave *wave, const GiTrace *trace, const GiTraceRay *rays, bool any) {
    const GiShapes *shapes = trace->shapes;
    wave->trace = trace;
    wave->rays = rays;
    wave->any = any;
    const GiTree *tree = trace->tree;
    wave->has_instances = shapes->instances != NULL;
    wave->has[GI_CHILD_NODE] = true;
    wave->has[GI_CHILD_TRIANGLES] = tree->has_triangles || wave->has_instances;
    wave->has[GI_CHILD_BOXES] = tree->box_block_count > 0 || wave->has_instances;
    wave->has[GI_CHILD_SPHERES] = tree->sphere_block_count > 0 || wave->has_instances;
    uint32_t triangle_count = 0;
    if (shapes->mesh_count > 0) {
        const GiMesh *last = &shapes->meshes[shapes->mesh_count - 1];
        triangle_count = last->first_triangle + last->triangle_count;
    }
    wave->corners = shapes->triangles.corners;
    wave->last_eight = triangle_count > 8 ? triangle_count - 8 : 0;
    if (triangle_count > 0 && triangle_count < 8) {
        for (uint32_t i = 0; i < 8; i++) {
            uint32_t k = i < triangle_count ? i : 0;
            memcpy(wave->few[i], shapes->triangles.corners[k], sizeof wave->few[i]);
        }
        wave->corners = (const uint32_t(*)[3])wave->few;
    }
    wave->candidates.count = 0;
    tree_bases(wave, trace->tree, wave->base);
    for (int i = 0; i < WALKER_COUNT; i++) {
        wave->child[i] = wave->stacks[i].child[0] = CHILD_END;
        wave->depth[i] = 0;
        wave->walkers[i].number = -1;
    }
}

/* Into instances and out of them, until there is a child again or the end. */
static void walker_cross(Wave *wave, uint32_t number) {
    uint32_t child;
    while ((child = wave->child[number]) >= CHILD_INSTANCE && child != CHILD_END) {
        if (child == CHILD_OUTSIDE) {
            walker_leave(wave, number);
        } else {
            walker_enter(wave, number, child & ~CHILD_INSTANCE);
        }
    }
}

/* The walkers whose child has these of the highest bits. */
static inline List wave_list(const Wave *wave, uint32_t mask, uint32_t value) {
    List list;
    list.count = places_where(list.walker, wave->child, WALKER_COUNT, mask, value);
    return list;
}

/* Those at a child of the tree. */
static inline List list_kind(const Wave *wave, GiChildKind kind) {
    /* With one bit more spheres are not what else looks like them. */
    const uint32_t mask = kind == GI_CHILD_SPHERES ? CHILD_INSTANCE : 0xc0000000u;
    List list;
    list.count = 0;
    return wave->has[kind] ? wave_list(wave, mask, gi_child(kind, 0)) : list;
}

static void wave_cross(Wave *wave) {
    const List list = wave_list(wave, CHILD_INSTANCE, CHILD_INSTANCE);
    for (int i = 0; i < list.count; i++) walker_cross(wave, list.walker[i]);
}

/* All walkers take a step. */
static inline void wave_round(Wave *wave) {
    const List nodes = list_kind(wave, GI_CHILD_NODE),
               triangles = list_kind(wave, GI_CHILD_TRIANGLES);
    const List boxes = list_kind(wave, GI_CHILD_BOXES), spheres = list_kind(wave, GI_CHILD_SPHERES);
    for (int i = 0; i < nodes.count; i++) {
        uint32_t number = nodes.walker[i];
        prefetch_lines(
            wave->aims[number].base[GI_CHILD_NODE] + (size_t)wave->child[number] * sizeof(GiNode),
            4);
    }
    for (int i = 0; i < triangles.count; i++) {
        prefetch_lines(
            (const char *)(wave->corners + gi_child_first(wave->child[triangles.walker[i]])), 2);
    }
    for (int i = 0; i < spheres.count; i++) {
        uint32_t number = spheres.walker[i];
        prefetch_lines(wave->aims[number].base[GI_CHILD_SPHERES] +
                           (size_t)gi_child_index(wave->child[number]) * sizeof(GiSphereBlock),
            3);
    }
    wave_nodes(wave, &nodes);
    wave_spheres(wave, &spheres);
    wave_boxes(wave, &boxes);
    wave_triangles(wave, &triangles);
    wave_candidates(wave);
    step_down(wave->child, wave->stacks[0].child, wave->depth,
        (int)(sizeof(Stack) / sizeof(uint32_t)), WALKER_COUNT);
    if (wave->has_instances) wave_cross(wave);
}

/* hits, or for `any` blocked. */
static inline void wave_run(const GiTrace *trace, const GiTraceRay *rays, int count, bool any,
    GiTraceHit *hits, bool *blocked) {
    Wave wave;
    wave_init(&wave, trace, rays, any);
    for (int started = 0;;) {
        /* Those at the end wait until they are enough to set out together. */
        List list = wave_list(&wave, UINT32_MAX, CHILD_END);
        if (list.count < (started < count ? 8 : WALKER_COUNT)) {
            wave_round(&wave);
            continue;
        }
        for (int i = 0; i < list.count; i++) {
            Walker *walker = &wave.walkers[list.walker[i]];
            if (walker->number < 0) continue;
            if (any) {
                blocked[walker->number] = walker->best.shape.bits != GI_SHAPE_NONE;
            } else {
                hits[walker->number] = walker->best;
            }
            walker->number = -1;
        }
        if (started == count) break;
        for (int i = 0; i + 8 <= list.count && started < count; i += 8) {
            int together = count - started < 8 ? count - started : 8;
            wave_begin(&wave, list.walker + i, started, together);
            started += together;
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
