/* SPDX-License-Identifier: MIT
 * One ray through the tree. Part of kernel.c.
 *
 * Staying below the error bound of layout.h: the ray's line is walked in kernel space from its
 * point of closest approach to the centre, so that no point x of the line is nearer to the centre
 * than the origin o'. Then |o'| <= |x|, and every rounding of o', of the direction and of the
 * parameter moves the computed place of a plane by at most a few times 2^-24 |x|, while the box
 * that holds x was grown by 2^-19 |x| or more. The test itself can therefore be the plain one. */
#pragma once

typedef struct Line {
    const GiTrace *trace;
    gi_hit_Ray ray;
    double t_min, t_max;
    uint32_t skip;
    /* in kernel space, with unit direction */
    float origin[3], direction[3], inverse[3];
    bool negative[3];
    double length, shift; /* parameter in kernel space = t * length - shift */
} Line;

static inline Line line_of(const GiTrace *trace, const GiTraceRay *r) {
    Line line = {.trace = trace, .t_min = r->t_min, .t_max = r->t_max, .skip = r->skip};
    line.ray = gi_hit_ray(
        r->origin.x, r->origin.y, r->origin.z, r->direction.x, r->direction.y, r->direction.z);
    const GiTree *tree = trace->tree;
    GiVec o = gi_scale(gi_sub(r->origin, tree->center), tree->scale);
    double length = gi_length(r->direction);
    GiVec d = gi_scale(r->direction, 1 / length);
    line.shift = -gi_dot(o, d);
    o = gi_along(o, d, line.shift);
    line.shift = -line.shift;
    line.length = length * tree->scale;
    const double origin[3] = {o.x, o.y, o.z}, direction[3] = {d.x, d.y, d.z};
    for (int axis = 0; axis < 3; axis++) {
        line.origin[axis] = (float)origin[axis];
        line.direction[axis] = (float)direction[axis];
        /* A component so small stands for a ray that never leaves the slab it is in. */
        line.inverse[axis] = fabs(direction[axis]) < 1e-30 ? 1e30f : (float)(1 / direction[axis]);
        line.negative[axis] = line.inverse[axis] < 0;
    }
    return line;
}

static inline float line_parameter(const Line *line, double t) {
    return (float)(t * line->length + line->shift);
}

/* Bits of the children, or boxes of a block, that the line meets between the parameters; where it
 * enters them goes to enter[8]. */
static inline unsigned line_boxes(const Line *line, const float low[3][8], const float high[3][8],
    float from, float to, float enter[8]) {
    unsigned bits = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        F near = f_of(from), far = f_of(to);
        for (int axis = 0; axis < 3; axis++) {
            bool negative = line->negative[axis];
            F first = f_load((negative ? high : low)[axis] + i);
            F last = f_load((negative ? low : high)[axis] + i);
            F origin = f_of(line->origin[axis]), inverse = f_of(line->inverse[axis]);
            near = f_max((first - origin) * inverse, near);
            far = f_min((last - origin) * inverse, far);
        }
        f_store(enter + i, near);
        bits |= f_less_equal(near, far) << i;
    }
    return bits;
}

/* The same for spheres: those whose distance from the line is not above their radius. Their
 * interval is not looked at beyond that; the exact test does it. */
static inline unsigned line_spheres(
    const Line *line, const GiSphereBlock *block, float from, float to) {
    unsigned bits = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        F x = f_load(block->center[0] + i) - f_of(line->origin[0]);
        F y = f_load(block->center[1] + i) - f_of(line->origin[1]);
        F z = f_load(block->center[2] + i) - f_of(line->origin[2]);
        F dx = f_of(line->direction[0]), dy = f_of(line->direction[1]),
          dz = f_of(line->direction[2]);
        F nearest = x * dx + y * dy + z * dz;
        x = x - nearest * dx;
        y = y - nearest * dy;
        z = z - nearest * dz;
        F radius = f_load(block->radius + i);
        bits |= (f_less_equal(x * x + y * y + z * z, radius * radius) &
                    f_less_equal(nearest - radius, f_of(to)) &
                    f_less_equal(f_of(from), nearest + radius))
                << i;
    }
    return bits;
}

typedef struct StackEntry {
    uint32_t child;
    float enter;
} StackEntry;

enum { STACK_LIMIT = GI_TREE_DEPTH_LIMIT * (GI_TREE_WIDTH - 1) + 1 };

/* The bytes of a child are asked for when it is pushed, those of a shape when its box is met: both
 * are far away in large scenes. */
static inline void prefetch_child(const GiTree *tree, uint32_t child) {
    uint32_t index = child & GI_CHILD_INDEX;
    const char *from = (const char *)&tree->nodes[index];
    size_t size = sizeof(GiNode);
    if (child & GI_CHILD_BLOCK) {
        bool spheres = child & GI_CHILD_SPHERES;
        from = spheres ? (const char *)&tree->sphere_blocks[index]
                       : (const char *)&tree->box_blocks[index];
        size = spheres ? sizeof(GiSphereBlock) : sizeof(GiBoxBlock);
    }
    for (size_t i = 0; i < size; i += 64) prefetch(from + i);
}

static inline void prefetch_shape(const GiShapes *shapes, GiShapeRef ref) {
    uint32_t i = gi_shape_index(ref);
    switch (gi_shape_kind(ref)) {
    case GI_SHAPE_SPHERE: prefetch(&shapes->spheres[i]); break;
    case GI_SHAPE_BOX: prefetch(&shapes->boxes[i]); break;
    case GI_SHAPE_CONE: prefetch(&shapes->cones[i]); break;
    case GI_SHAPE_PLACED: prefetch(&shapes->placements[i]); break;
    default: break;
    }
}

/* Pushes the children in bits so that the nearest is on top. */
static inline int push_children(const GiTree *tree, StackEntry *stack, int count,
    const uint32_t child[8], unsigned bits, const float enter[8]) {
    int first = count;
    for (; bits != 0; bits &= bits - 1) {
        int i = lowest_bit(bits);
        StackEntry entry = {child[i], enter[i]};
        prefetch_child(tree, child[i]);
        int at = count++;
        for (; at > first && stack[at - 1].enter < entry.enter; at--) stack[at] = stack[at - 1];
        stack[at] = entry;
    }
    return count;
}

static inline void line_test(const Line *line, GiShapeRef ref, GiTraceHit *best) {
    double t;
    if (ref.bits == line->skip) return;
    if (!gi_hit_shape(line->trace->shapes, ref, &line->ray, line->t_min, line->t_max, &t)) return;
    if (t > best->t) return;
    if (t == best->t && best->shape.bits != GI_SHAPE_NONE &&
        !gi_shape_before(line->trace->shapes, ref, GI_SHAPE_NONE, best->shape, best->instance)) {
        return;
    }
    best->t = t;
    best->shape = ref;
}

static inline bool line_trace(
    const GiTrace *trace, const GiTraceRay *r, bool any, GiTraceHit *hit) {
    const GiTree *tree = trace->tree;
    Line line = line_of(trace, r);
    GiTraceHit best = {r->t_max, {GI_SHAPE_NONE}, GI_SHAPE_NONE};
    for (uint32_t i = 0; i < tree->unbounded_count; i++) {
        line_test(&line, tree->unbounded[i], &best);
        if (any && best.shape.bits != GI_SHAPE_NONE) return true;
    }
    StackEntry stack[STACK_LIMIT];
    int count = 0;
    float from = line_parameter(&line, r->t_min), to = line_parameter(&line, best.t);
    if (tree->root != GI_CHILD_NONE) stack[count++] = (StackEntry){tree->root, from};
    while (count > 0) {
        StackEntry top = stack[--count];
        if (!(top.enter <= to)) continue;
        uint32_t index = top.child & GI_CHILD_INDEX;
        float enter[8];
        if (!(top.child & GI_CHILD_BLOCK)) {
            const GiNode *node = &tree->nodes[index];
            unsigned bits = line_boxes(&line, node->low, node->high, from, to, enter);
            count = push_children(tree, stack, count, node->child, bits, enter);
            continue;
        }
        const GiShapeRef *shapes;
        unsigned bits;
        if (top.child & GI_CHILD_SPHERES) {
            const GiSphereBlock *block = &tree->sphere_blocks[index];
            bits = line_spheres(&line, block, from, to);
            shapes = block->shape;
        } else {
            const GiBoxBlock *block = &tree->box_blocks[index];
            bits = line_boxes(&line, block->low, block->high, from, to, enter);
            shapes = block->shape;
        }
        for (; bits != 0; bits &= bits - 1) {
            line_test(&line, shapes[lowest_bit(bits)], &best);
            if (any && best.shape.bits != GI_SHAPE_NONE) return true;
        }
        to = line_parameter(&line, best.t);
    }
    *hit = best;
    return best.shape.bits != GI_SHAPE_NONE;
}

static bool GI_KERNEL(closest)(const GiTrace *trace, const GiTraceRay *ray, GiTraceHit *hit) {
    return line_trace(trace, ray, false, hit);
}

static bool GI_KERNEL(any)(const GiTrace *trace, const GiTraceRay *ray) {
    GiTraceHit hit;
    return line_trace(trace, ray, true, &hit);
}
