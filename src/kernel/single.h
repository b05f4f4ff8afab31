/* SPDX-License-Identifier: MIT
 * One ray through the tree. Part of kernel.c.
 *
 * Staying below the error bound of layout.h: the ray's line is walked in kernel space from its
 * point of closest approach to the centre, so that no point x of the line is nearer to the centre
 * than the origin o'. Then |o'| <= |x|, and every rounding of o', of the direction and of the
 * parameter moves the computed place of a plane by at most a few times 2^-24 |x|, while the box
 * that holds x was grown by 2^-19 |x| or more. The test itself can therefore be the plain one. */
#pragma once

/* ---------------------------------------------------------------- triangles */

/* The corners of triangles as they are seen from a point: relative to it, scaled to kernel space.
 * The point is a sum of two floats. A corner minus the first is rounded once, and again with the
 * second, so that a corner r away errs by 2^-23 |r|, and by `error` for what is lost of the point
 * and what it is off in the first place. */
typedef struct SeenFrom {
    float high[3], low[3], scale, error;
} SeenFrom;

static inline void seen_from_init(SeenFrom *seen, GiVec point, double error, double scale) {
    const double p[3] = {point.x, point.y, point.z};
    for (int axis = 0; axis < 3; axis++) {
        seen->high[axis] = (float)p[axis];
        seen->low[axis] = (float)(p[axis] - (double)seen->high[axis]);
    }
    seen->scale = (float)scale;
    seen->error = (float)(error * scale + 0x1p-47 * gi_largest(point) * scale);
    /* From beyond the range of floats nothing is told apart. */
    if (!(gi_largest(point) < 1e37)) {
        for (int axis = 0; axis < 3; axis++) seen->high[axis] = seen->low[axis] = 0;
        seen->error = INFINITY;
    }
}

/* Corner by corner, coordinate by coordinate; lanes from count on repeat the last triangle. */
static inline void seen_corners(const SeenFrom *seen, const GiTriangles *triangles, uint32_t first,
    uint32_t count, float corners[3][3][8]) {
    for (int corner = 0; corner < 3; corner++) {
        const float *points[8];
        for (uint32_t i = 0; i < 8; i++) {
            uint32_t triangle = first + (i < count ? i : count - 1);
            points[i] = triangles->positions[triangles->corners[triangle][corner]];
        }
        eight_points(points, corners[corner]);
        for (int axis = 0; axis < 3; axis++) {
            F high = f_of(seen->high[axis]), low = f_of(seen->low[axis]);
            for (int i = 0; i < 8; i += GI_FLOATS) {
                F x = f_load(corners[corner][axis] + i);
                f_store(corners[corner][axis] + i, (x - high - low) * f_of(seen->scale));
            }
        }
    }
}

static inline F f_size(F a) { return f_max(a, f_of(0) - a); }

/* ---------------------------------------------------------------- the line */

typedef struct Line {
    const GiTree *tree;
    const GiShapes *shapes;
    uint32_t instance; /* whose tree this is, or GI_SHAPE_NONE */
    const GiTraceRay *given;
    gi_hit_Ray ray;
    /* in kernel space, with unit direction */
    float origin[3], direction[3], inverse[3];
    bool negative[3];
    double length, shift; /* parameter in kernel space = t * length - shift */
    SeenFrom seen;        /* from the same origin */
} Line;

/* looks: at triangles, with line_triangles. */
static inline Line line_of(const GiTree *tree, const GiShapes *shapes, uint32_t instance,
    const GiTraceRay *r, bool looks) {
    Line line = {.tree = tree, .shapes = shapes, .instance = instance, .given = r};
    line.ray = gi_hit_ray(
        r->origin.x, r->origin.y, r->origin.z, r->direction.x, r->direction.y, r->direction.z);
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
    if (looks && tree->has_triangles) {
        double lost = 0x1p-47 * gi_largest(tree->center) + 2 * GI_TREE_GROWTH_LEAST / tree->scale;
        seen_from_init(
            &line.seen, gi_add(gi_scale(o, 1 / tree->scale), tree->center), lost, tree->scale);
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

/* Bits of the triangles that the line may meet: not beyond any edge by more than the corners err.
 * Where they lie along the line is not looked at. */
static inline unsigned line_triangles(const Line *line, uint32_t first, uint32_t count) {
    float corners[3][3][8];
    seen_corners(&line->seen, &line->shapes->triangles, first, count, corners);
    /* Sheared along the direction's largest component z, which keeps the errors small. */
    const float *d = line->direction;
    int z = fabsf(d[0]) > fabsf(d[1]) ? 0 : 1;
    if (fabsf(d[2]) > fabsf(d[z])) z = 2;
    int x = (z + 1) % 3, y = (z + 2) % 3;
    float shear_x = d[x] / d[z], shear_y = d[y] / d[z];
    unsigned bits = 0;
    for (int i = 0; i < 8; i += GI_FLOATS) {
        F px[3], py[3], size = f_of(0);
        for (int k = 0; k < 3; k++) {
            F rx = f_load(corners[k][x] + i), ry = f_load(corners[k][y] + i),
              rz = f_load(corners[k][z] + i);
            px[k] = rx - f_of(shear_x) * rz;
            py[k] = ry - f_of(shear_y) * rz;
            size = f_max(size, f_max(f_size(rx), f_max(f_size(ry), f_size(rz))));
        }
        /* Each place is a handful of roundings of the corner's distance off. */
        F error = size * f_of(0x1p-20f) + f_of(line->seen.error);
        F extent = f_of(0), side[3];
        for (int k = 0; k < 3; k++) {
            extent = f_max(extent, f_max(f_size(px[k]), f_size(py[k])));
            int next = (k + 1) % 3;
            side[k] = px[k] * py[next] - py[k] * px[next];
        }
        F slack = f_of(8) * error * (extent + error);
        F least = f_min(side[0], f_min(side[1], side[2]));
        F most = f_max(side[0], f_max(side[1], side[2]));
        bits |= (f_less_equal(f_of(0) - slack, least) | f_less_equal(most, slack)) << i;
    }
    return bits & ((1u << count) - 1);
}

/* ---------------------------------------------------------------- the walk */

typedef struct StackEntry {
    uint32_t child;
    float enter;
} StackEntry;

enum { STACK_LIMIT = GI_TREE_DEPTH_LIMIT * (GI_TREE_WIDTH - 1) + 1 };

/* The bytes of a child are asked for when it is pushed, those of a shape when its box is met: both
 * are far away in large scenes. */
static inline void prefetch_child(const GiTree *tree, const GiShapes *shapes, uint32_t child) {
    uint32_t index = gi_child_index(child);
    GiChildKind kind = gi_child_kind(child);
    const char *from = (const char *)&tree->nodes[index];
    if (kind != GI_CHILD_NODE) {
        from = kind == GI_CHILD_SPHERES ? (const char *)&tree->sphere_blocks[index]
               : kind == GI_CHILD_BOXES
                   ? (const char *)&tree->box_blocks[index]
                   : (const char *)&shapes->triangles.corners[gi_child_first(child)];
    }
    prefetch(from);
    prefetch(from + 64);
    if (kind == GI_CHILD_TRIANGLES) { /* eight rows of twelve bytes */
        prefetch(from + 95);
        return;
    }
    prefetch(from + 128);
    prefetch(from + 192);
}

/* Pushes the children in bits so that the nearest is on top. */
static inline int push_children(const GiTree *tree, const GiShapes *shapes, StackEntry *stack,
    int count, const uint32_t child[8], unsigned bits, const float enter[8]) {
    int first = count;
    for (; bits != 0; bits &= bits - 1) {
        int i = lowest_bit(bits);
        StackEntry entry = {child[i], enter[i]};
        prefetch_child(tree, shapes, child[i]);
        int at = count++;
        for (; at > first && stack[at - 1].enter < entry.enter; at--) stack[at] = stack[at - 1];
        stack[at] = entry;
    }
    return count;
}

static bool line_instance(
    const GiShapes *shapes, uint32_t index, const GiTraceRay *ray, bool any, GiTraceHit *best);

/* Keeps the hit if it is the best so far. */
static inline bool keep_hit(const GiShapes *shapes, GiTraceHit hit, GiTraceHit *best) {
    if (hit.t > best->t) return false;
    if (hit.t == best->t && best->shape.bits != GI_SHAPE_NONE &&
        !gi_shape_before(shapes, hit.shape, hit.instance, best->shape, best->instance)) {
        return false;
    }
    *best = hit;
    return true;
}

/* Whether the ray meets the shape. Of hits that are not nearer than the best, none counts. */
static inline bool line_test(const Line *line, GiShapeRef ref, bool any, GiTraceHit *best) {
    double t;
    if (gi_shape_kind(ref) == GI_SHAPE_INSTANCE) {
        GiTraceHit inner = *best; /* a copy, so that the best one may stay in registers */
        if (!line_instance(line->shapes, gi_shape_index(ref), line->given, any, &inner)) {
            return false;
        }
        *best = inner;
        return true;
    }
    const GiTraceRay *given = line->given;
    if (ref.bits == given->skip && line->instance == given->skip_instance) return false;
    COUNT(shapes, 1);
    if (!gi_hit_shape(line->shapes, ref, &line->ray, given->t_min, given->t_max, &t)) return false;
    return keep_hit(line->shapes, (GiTraceHit){t, ref, line->instance}, best);
}

/* The same ray in the instance's space, where t is the same; gi_hit_to_object has the same
 * operations. */
static inline GiTraceRay ray_inside(const GiShapes *shapes, uint32_t index, const GiTraceRay *ray) {
    uint32_t transform = shapes->instances[index].transform;
    const GiAffine *to_object = &shapes->transforms[transform].to_object;
    GiTraceRay inner = *ray;
    inner.origin = gi_affine_point(to_object, ray->origin);
    inner.direction = gi_affine_vector(to_object, ray->direction);
    return inner;
}

/* Lowers *hit, or for `any` returns at the first hit. Returns whether there was one. */
static inline bool line_trace(const GiTree *tree, const GiShapes *shapes, uint32_t instance,
    const GiTraceRay *ray, bool any, GiTraceHit *hit) {
    const Line line = line_of(tree, shapes, instance, ray, true);
    GiTraceHit best = *hit;
    bool found = false;
    for (uint32_t i = 0; i < tree->unbounded_count; i++) {
        found |= line_test(&line, tree->unbounded[i], any, &best);
        if (any && found) {
            *hit = best;
            return true;
        }
    }
    StackEntry stack[STACK_LIMIT];
    int count = 0;
    float from = line_parameter(&line, ray->t_min), to = line_parameter(&line, best.t);
    if (tree->root != GI_CHILD_NONE) stack[count++] = (StackEntry){tree->root, from};
    while (count > 0) {
        StackEntry top = stack[--count];
        if (!(top.enter <= to)) continue;
        uint32_t index = gi_child_index(top.child), first = 0;
        GiChildKind kind = gi_child_kind(top.child);
        const GiShapeRef *refs = NULL;
        float enter[8];
        unsigned bits;
        if (kind == GI_CHILD_NODE) {
            const GiNode *node = &tree->nodes[index];
            bits = line_boxes(&line, node->low, node->high, from, to, enter);
            COUNT(nodes, 1);
            count = push_children(tree, shapes, stack, count, node->child, bits, enter);
            continue;
        }
        COUNT(leaves, 1);
        if (kind == GI_CHILD_SPHERES) {
            const GiSphereBlock *block = &tree->sphere_blocks[index];
            bits = line_spheres(&line, block, from, to);
            refs = block->shape;
        } else if (kind == GI_CHILD_BOXES) {
            const GiBoxBlock *block = &tree->box_blocks[index];
            bits = line_boxes(&line, block->low, block->high, from, to, enter);
            refs = block->shape;
        } else {
            first = gi_child_first(top.child);
            bits = line_triangles(&line, first, gi_child_count(top.child));
        }
        for (; bits != 0; bits &= bits - 1) {
            uint32_t i = (uint32_t)lowest_bit(bits);
            GiShapeRef ref = refs != NULL ? refs[i] : gi_shape_ref(GI_SHAPE_TRIANGLE, first + i);
            found |= line_test(&line, ref, any, &best);
            if (any && found) {
                *hit = best;
                return true;
            }
        }
        to = line_parameter(&line, best.t);
    }
    *hit = best;
    return found;
}

/* An instance holds no instances, so there is one step down at most. */
static bool line_instance(
    const GiShapes *shapes, uint32_t index, const GiTraceRay *ray, bool any, GiTraceHit *best) {
    const GiTree *tree = shapes->instances[index].tree;
    const GiTraceRay inner = ray_inside(shapes, index, ray);
    return any ? line_trace(tree, shapes, index, &inner, true, best)
               : line_trace(tree, shapes, index, &inner, false, best);
}

/* From hit->t on downward. */
static bool line_alone(const GiTrace *trace, const GiTraceRay *ray, bool any, GiTraceHit *hit) {
    return any ? line_trace(trace->tree, trace->shapes, GI_SHAPE_NONE, ray, true, hit)
               : line_trace(trace->tree, trace->shapes, GI_SHAPE_NONE, ray, false, hit);
}

static bool GI_KERNEL(closest)(const GiTrace *trace, const GiTraceRay *ray, GiTraceHit *hit) {
    *hit = (GiTraceHit){ray->t_max, {GI_SHAPE_NONE}, GI_SHAPE_NONE};
    return line_alone(trace, ray, false, hit);
}

static bool GI_KERNEL(any)(const GiTrace *trace, const GiTraceRay *ray) {
    GiTraceHit hit = {ray->t_max, {GI_SHAPE_NONE}, GI_SHAPE_NONE};
    return line_alone(trace, ray, true, &hit);
}
