/* SPDX-License-Identifier: MIT
 * The gate that every kernel has to pass: of every instruction set each way to trace a ray (alone,
 * among many, in a bundle; the closest shape and any) finds the same shape, instance and bits of t
 * as brute force. Scenes of each kind of shape, of many sizes and scales, with shapes that coincide
 * and shapes without extent; rays made to be difficult. */
#include "brute.h"
#include "meshes.h"
#include "nasty.h"
#include "test.h"

#include <stdio.h>
#include <string.h>

/* ---------------------------------------------------------------- scenes */

typedef enum Kind {
    SPHERES,
    BOXES,
    CONES,
    NAPPES, /* cones with both */
    CYLINDERS,
    DISCS,
    PLANES,
    RECTANGLES,
    TRIANGLES,
    PLACED,
    INSTANCES,
    MIXED,
    KIND_COUNT
} Kind;

static const char *const kind_names[] = {"spheres", "boxes", "cones", "double cones", "cylinders",
    "discs", "planes", "rectangles", "triangles", "placed", "instances", "mixed"};

/* Where a scene stands and how large it is: a cube of half side `size`. */
typedef struct Room {
    GiVec at;
    double size;
} Room;

typedef struct Builder {
    GiScene *scene;
    Random *random;
    Room room;
    size_t expected;          /* things that have to stand in the trees */
    GiShapeRef mesh, cluster; /* what instances are of; none as yet: GI_SHAPE_NONE */
} Builder;

enum { CLUSTER = 20, RINGS = 3, MESH_TRIANGLES = 4 * RINGS * (RINGS - 1) };

/* Sizes from that of the scene to a thousandth; sometimes none at all. */
static double any_size(Random *random, double size) {
    int k = random_below(random, 16);
    return k == 0 ? 0 : k == 1 ? size : size * 0.3 * pow(10, random_real(random, -2.5, 0));
}

/* Some stand in the middle of the room, some on the corners of a grid, where faces are shared. */
static GiVec any_place(const Builder *b) {
    GiVec p = random_vec(b->random, -1, 1);
    switch (random_below(b->random, 6)) {
    case 0: p = gi_vec(0, 0, 0); break;
    case 1: p = gi_vec(floor(4 * p.x) / 4, floor(4 * p.y) / 4, floor(4 * p.z) / 4); break;
    default: break;
    }
    return gi_along(b->room.at, p, b->room.size);
}

static void add_rectangle(const Builder *b, GiVec center, double width, double height) {
    bool aligned = random_below(b->random, 2) != 0;
    GiLight light = gi_light_default();
    light.type = GLINT_LIGHT_RECTANGLE;
    light.position = center;
    light.direction = aligned ? gi_vec(0, 0, -1) : random_vec(b->random, -1, 1);
    light.up = aligned ? gi_vec(0, 1, 0) : random_vec(b->random, -1, 1);
    light.width = width > 0 ? width : b->room.size;
    light.height = height > 0 ? height : b->room.size;
    CHECK(gi_array_push(b->scene->memory, &b->scene->lights, light));
}

/* A shape of a kind before TRIANGLES, which lights have of their own. */
static GiShapeRef make_shape(const Builder *b, Kind kind) {
    GiScene *scene = b->scene;
    Random *random = b->random;
    GiVec center = any_place(b);
    double radius = any_size(random, b->room.size), height = any_size(random, b->room.size);
    GiShapeRef ref = {GI_SHAPE_NONE};
    bool done = false;
    switch (kind) {
    case SPHERES: done = gi_scene_add_sphere(scene, center, radius, 0, &ref); break;
    case BOXES: {
        GiVec size = gi_vec(radius, height, any_size(random, b->room.size));
        if (random_below(random, 2)) size = gi_vec(0.25 * b->room.size, size.y, size.z);
        done = gi_scene_add_box(scene, center, gi_add(center, size), 0, &ref);
        break;
    }
    case CONES:
    case NAPPES: {
        /* The apex at an end or beyond it; in the middle part. */
        static const double tips[2][4] = {{0.5, -0.5, 0.7, -3}, {0.4, -0.1, 0.25, -0.499}};
        double part = tips[kind == NAPPES][random_below(random, 4)];
        double tip = center.z + (height > 0 ? height : b->room.size) * part;
        if (tip == center.z) tip = center.z + b->room.size;
        done = gi_scene_add_cone(scene, center, radius, height, tip, 0, &ref);
        break;
    }
    case CYLINDERS: done = gi_scene_add_cylinder(scene, center, radius, height, 0, &ref); break;
    case DISCS:
        done = gi_scene_add_disc(scene, center, nasty_direction(random), radius, 0, &ref);
        break;
    default: done = gi_scene_add_plane(scene, center, nasty_direction(random), 0, &ref);
    }
    CHECK(done);
    return ref;
}

/* A group of its own under a transform from the space around `from` into the room, which turns and
 * may mirror and flatten. */
static uint32_t add_moved_group(const Builder *b, GiVec from) {
    GiShapeRef group;
    CHECK(gi_scene_add_group(b->scene, &group));
    uint32_t index = gi_shape_index(group);
    Random *random = b->random;
    GiVec to = gi_along(b->room.at, random_vec(random, -1, 1), b->room.size);
    GiVec scale = gi_vec(random_real(random, 0.5, 2), -1, random_real(random, 0.05, 1.5));
    bool straight = random_below(random, 3) == 0;
    GiVec turn = straight ? gi_vec(90, 0, 180) : random_vec(random, -180, 180);
    CHECK(gi_scene_add_step(b->scene, index, GI_STEP_TRANSLATE, to));
    CHECK(gi_scene_add_step(b->scene, index, GI_STEP_ROTATE, turn));
    if (!straight) CHECK(gi_scene_add_step(b->scene, index, GI_STEP_SCALE, scale));
    CHECK(gi_scene_add_step(b->scene, index, GI_STEP_TRANSLATE, gi_negate(from)));
    CHECK(gi_scene_place(b->scene, GI_SHAPE_NONE, group));
    return index;
}

/* What is around the origin, and may be carried far away. */
static void make_inner(Builder *b) {
    const Room room = b->room;
    b->room.at = gi_vec(0, 0, 0);
    b->mesh = mesh_sphere(b->scene, b->room.at, room.size / 3, RINGS, 0.1, false, true, b->random);
    CHECK(gi_scene_add_group(b->scene, &b->cluster));
    for (int k = 0; k < CLUSTER; k++) {
        GiShapeRef ref = make_shape(b, (Kind)(k % RECTANGLES));
        CHECK(gi_scene_place(b->scene, gi_shape_index(b->cluster), ref));
    }
    b->room = room;
}

/* How often something is there: now and then twice, so that every hit is a tie. */
static int any_copies(Random *random) { return random_below(random, 4) == 0 ? 2 : 1; }

static void add_instance(Builder *b, int i) {
    if (b->mesh.bits == GI_SHAPE_NONE) make_inner(b);
    int copies = any_copies(b->random);
    Random before = *b->random;
    for (int copy = 0; copy < copies; copy++) {
        *b->random = before; /* the same numbers, the same transform */
        uint32_t group = add_moved_group(b, gi_vec(0, 0, 0));
        CHECK(gi_scene_place(b->scene, group, i % 2 ? b->cluster : b->mesh));
        b->expected += i % 2 ? CLUSTER : MESH_TRIANGLES;
    }
}

static void add_one(Builder *b, Kind kind, int i) {
    /* What is many things by itself comes first, and not too often for brute force. */
    if (kind == MIXED) kind = (Kind)random_below(b->random, i < 100 ? MIXED : TRIANGLES);
    if (kind == INSTANCES) {
        add_instance(b, i);
        return;
    }
    if (kind == RECTANGLES) {
        GiVec center = any_place(b);
        double width = any_size(b->random, b->room.size);
        add_rectangle(b, center, width, any_size(b->random, b->room.size));
        b->expected += b->scene->dialect == GLINT_DIALECT_2018B; /* earlier they are not seen */
        return;
    }
    if (kind == TRIANGLES) { /* some of them without area, which trees leave out */
        GiShapeRef ref = mesh_soup(b->scene, b->room.at, b->room.size, 1, b->random);
        CHECK(gi_scene_place(b->scene, GI_SHAPE_NONE, ref));
        return;
    }
    Kind plain = kind == PLACED ? (Kind)random_below(b->random, RECTANGLES) : kind;
    uint32_t group = kind == PLACED ? add_moved_group(b, b->room.at) : GI_SHAPE_NONE;
    int copies = any_copies(b->random);
    Random before = *b->random;
    for (int copy = 0; copy < copies; copy++) {
        *b->random = before; /* the same numbers, the same shape */
        CHECK(gi_scene_place(b->scene, group, make_shape(b, plain)));
        b->expected++;
    }
}

static void build(
    Fixture *fixture, Kind kind, int count, Room room, GlintDialect dialect, Random *random) {
    fixture_begin(fixture, dialect);
    Builder b = {&fixture->scene, random, room, 0, {GI_SHAPE_NONE}, {GI_SHAPE_NONE}};
    if (kind == TRIANGLES && count > 0) {
        /* Of one mesh, so that leaves are ranges of triangles. */
        GiShapeRef ref = mesh_soup(&fixture->scene, room.at, room.size, count, random);
        CHECK(gi_scene_place(&fixture->scene, GI_SHAPE_NONE, ref));
    } else {
        for (int i = 0; i < count; i++) add_one(&b, kind, i);
    }
    fixture_commit(fixture, gi_kernel_at(0));
    /* Brute force reads the trees' own lists: nothing may be missing there. */
    bool soup = fixture->scene.meshes.corners.count > 0 && kind != INSTANCES;
    if (!soup) CHECK_INT(fixture->things.count, b.expected);
    if (soup) CHECK(fixture->things.count >= b.expected);
}

/* ---------------------------------------------------------------- comparing */

static int wrong; /* of the current scene, to keep the report short */

static bool agree(const GiTraceHit *a, const GiTraceHit *b) {
    if (a->shape.bits != b->shape.bits) return false;
    return a->shape.bits == GI_SHAPE_NONE ||
           (a->instance == b->instance && memcmp(&a->t, &b->t, sizeof a->t) == 0);
}

static void report(const char *what, const GiKernel *kernel, const char *entry,
    const GiTraceRay *ray, const GiTraceHit *found, const GiTraceHit *expected) {
    if (wrong++ >= 3) return;
    test_fail(__FILE__, __LINE__,
        "%s, %s, %s: (%a %a %a) + t (%a %a %a), t in %a .. %a, spares %x in %x: "
        "%x in %x at %a, not %x in %x at %a",
        what, kernel->name, entry, ray->origin.x, ray->origin.y, ray->origin.z, ray->direction.x,
        ray->direction.y, ray->direction.z, ray->t_min, ray->t_max, ray->skip, ray->skip_instance,
        found->shape.bits, found->instance, found->t, expected->shape.bits, expected->instance,
        expected->t);
}

static const GiTraceHit something = {NAN, {0}, 0}, nothing = {NAN, {GI_SHAPE_NONE}, GI_SHAPE_NONE};

enum { RAY_LIMIT = 1500 };

/* Alone and among many, in parts of several sizes. */
static void check_rays(
    const Fixture *fixture, const GiTraceRay *rays, int count, const char *what) {
    static GiTraceHit expected[RAY_LIMIT], hits[RAY_LIMIT];
    static bool blocked[RAY_LIMIT];
    static const int parts[] = {1, 7, 8, 31, 32, 33, 500, RAY_LIMIT};
    const GiTrace *trace = &fixture->world.trace;
    for (int i = 0; i < count; i++) brute_force(fixture, &rays[i], &expected[i]);
    const GiKernel *kernel;
    for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
        for (int i = 0; i < count; i++) {
            GiTraceHit hit = nothing;
            bool found = kernel->closest(trace, &rays[i], &hit);
            if (!found) hit = nothing;
            if (!agree(&hit, &expected[i])) {
                report(what, kernel, "closest", &rays[i], &hit, &expected[i]);
            }
            bool meets = expected[i].shape.bits != GI_SHAPE_NONE;
            if (kernel->any(trace, &rays[i]) != meets) {
                report(what, kernel, "any", &rays[i], meets ? &nothing : &something, &expected[i]);
            }
        }
        for (int begin = 0, part = k; begin < count; part++) {
            int size = parts[part % (int)(sizeof parts / sizeof *parts)];
            if (size > count - begin) size = count - begin;
            kernel->many_closest(trace, rays + begin, size, hits + begin);
            kernel->many_any(trace, rays + begin, size, blocked + begin);
            begin += size;
        }
        for (int i = 0; i < count; i++) {
            if (!agree(&hits[i], &expected[i])) {
                report(what, kernel, "many closest", &rays[i], &hits[i], &expected[i]);
            }
            bool meets = expected[i].shape.bits != GI_SHAPE_NONE;
            if (blocked[i] != meets) {
                report(what, kernel, "many any", &rays[i], meets ? &nothing : &something,
                    &expected[i]);
            }
        }
    }
}

static void check_bundle(const Fixture *fixture, GiBundle *bundle, bool any, const char *what) {
    static GiTraceRay rays[GI_BUNDLE_SIZE];
    static GiTraceHit expected[GI_BUNDLE_SIZE];
    for (int i = 0; i < bundle->count; i++) {
        rays[i] = ray_of_bundle(bundle, any, i);
        brute_force(fixture, &rays[i], &expected[i]);
    }
    const GiKernel *kernel;
    for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
        for (int i = 0; i < bundle->count; i++) bundle->t[i] = rays[i].t_max;
        (any ? kernel->bundle_any : kernel->bundle_closest)(&fixture->world.trace, bundle);
        for (int i = 0; i < bundle->count; i++) {
            GiTraceHit hit = {bundle->t[i], {bundle->shape[i]}, bundle->instance[i]};
            bool meets = expected[i].shape.bits != GI_SHAPE_NONE;
            if (any ? (bundle->shape[i] != GI_SHAPE_NONE) == meets : agree(&hit, &expected[i])) {
                continue;
            }
            report(
                what, kernel, any ? "bundle any" : "bundle closest", &rays[i], &hit, &expected[i]);
        }
    }
}

/* ---------------------------------------------------------------- bundles */

typedef enum Spread {
    NARROW,   /* a point, nearly */
    PART,     /* some of the scene */
    LIMIT,    /* a cone about as wide as bundles may be, 66 degrees */
    HALF,     /* a half space */
    AROUND,   /* all directions */
    FEATURES, /* places on shapes, all around */
    SPREAD_COUNT
} Spread;

/* Where the rays of a bundle go to from the apex; direction and length. */
static GiVec bundle_ray(
    const Fixture *fixture, Spread spread, GiVec apex, GiVec axis, double size, Random *random) {
    GiVec d = random_vec(random, -1, 1);
    switch (spread) {
    case NARROW: return gi_along(axis, d, 1e-5 * gi_length(axis));
    case PART: return gi_along(axis, d, 0.3 * gi_length(axis));
    case LIMIT:
    case HALF: {
        GiVec w = gi_normalize(axis), u = gi_normalize(gi_cross(w, d));
        double limit = spread == HALF ? 1.57 : random_below(random, 300) ? 1.155 : 1.163;
        double angle = random_below(random, 2) ? limit : random_real(random, 0, limit);
        d = gi_add(gi_scale(w, cos(angle)), gi_scale(u, sin(angle)));
        return gi_scale(d, size * random_real(random, 0.01, 3));
    }
    case AROUND: return gi_scale(d, size * random_real(random, 0.1, 3));
    default:
        if (fixture->things.count == 0) return d;
        return gi_sub(nasty_point(fixture, nasty_thing(fixture, random), random), apex);
    }
}

/* In the midst, in a solid, on a surface, at a corner, outside, far away. */
static GiVec bundle_apex(const Fixture *fixture, Room room, Random *random) {
    GiVec p = gi_along(room.at, random_vec(random, -2, 2), room.size), q = room.at;
    if (fixture->things.count > 0) {
        Thing thing = nasty_thing(fixture, random);
        q = nasty_point(fixture, thing, random);
        p = nasty_point(fixture, thing, random);
    }
    switch (random_below(random, 6)) {
    case 0: return room.at;
    case 1: return gi_scale(gi_add(p, q), 0.5);
    case 2: return p;
    case 3: {
        double distance = room.size * pow(10, random_real(random, 1, 3.8));
        return gi_along(room.at, nasty_direction(random), distance);
    }
    default: return gi_along(room.at, random_vec(random, -2, 2), room.size);
    }
}

/* From the apex on, or up to it. */
static void set_closest(GiBundle *bundle, int i, GiVec d, double t_max) {
    bundle->dx[i] = d.x, bundle->dy[i] = d.y, bundle->dz[i] = d.z;
    bundle->t[i] = t_max;
}

static void set_any(GiBundle *bundle, int i, GiVec o, double t_min) {
    bundle->ox[i] = o.x, bundle->oy[i] = o.y, bundle->oz[i] = o.z;
    bundle->t_min[i] = t_min;
    bundle->skip[i] = bundle->skip_instance[i] = GI_SHAPE_NONE;
}

static void fill_bundle(
    const Fixture *fixture, GiBundle *bundle, Spread spread, Room room, bool any, Random *random) {
    static const double lengths[] = {1e-60, 1e-9, 1e9, 1e60};
    bundle->apex = bundle_apex(fixture, room, random);
    bundle->side = random_below(random, 2) ? gi_vec(0, 0, 0) : random_vec(random, -1, 1);
    GiVec axis = gi_sub(gi_along(room.at, random_vec(random, -1, 1), room.size), bundle->apex);
    if (random_below(random, 3) == 0) axis = gi_scale(nasty_direction(random), room.size);
    static const double starts[] = {0, 1e-9, 0.1};
    bundle->start = random_below(random, 2) ? 0 : starts[random_below(random, 3)];
    bundle->end = random_below(random, 4) ? 1 : random_real(random, 0, 1);
    bundle->own = false;
    bool varied = random_below(random, 4) == 0, sorted = random_below(random, 2) != 0;
    for (int i = 0; i < bundle->count; i++) {
        /* Sorted: sixteen in a row are neighbours. Otherwise in any order. */
        GiVec d = bundle_ray(fixture, spread, bundle->apex, axis, room.size, random);
        if (sorted && i % GI_PACKET_SIZE != 0) {
            int first = i / GI_PACKET_SIZE * GI_PACKET_SIZE;
            GiVec lead = ray_of_bundle(bundle, any, first).direction;
            if (any) lead = gi_negate(lead);
            d = gi_along(lead, random_vec(random, -1, 1), 0.01 * gi_length(lead));
        }
        if (gi_length(d) < 1e-200) d = gi_vec(0, 0, room.size);
        if (any) {
            GiVec o = gi_add(bundle->apex, d);
            d = gi_sub(bundle->apex, o);
            if (gi_vec_is_zero(d)) o = gi_add(o, d = gi_vec(-room.size, 0, 0));
            if (gi_vec_is_zero(gi_sub(bundle->apex, o))) o.x += room.size;
            set_any(bundle, i, o, random_below(random, 2) ? 0 : 1e-9);
            if (i % 5 == 0 && fixture->things.count > 0) {
                Thing thing = nasty_thing(fixture, random);
                bundle->skip[i] = thing.ref.bits;
                bundle->skip_instance[i] = thing.instance;
            }
        } else {
            double length = varied && !sorted ? lengths[random_below(random, 4)] : 1;
            double end = random_below(random, 8) ? INFINITY : random_real(random, 0, 2) / length;
            set_closest(bundle, i, gi_scale(d, length), end);
        }
        if (i % 11 != 0) continue;
        GiTraceRay ray = ray_of_bundle(bundle, any, i);
        nasty_limits(fixture, any, random, &ray);
        if (any) {
            bundle->t_min[i] = ray.t_min;
            bundle->skip[i] = ray.skip, bundle->skip_instance[i] = ray.skip_instance;
            if (i == 0 && ray.t_max <= 1 && random_below(random, 2)) bundle->end = ray.t_max;
        } else {
            bundle->t[i] = ray.t_max;
            if (i == 0) bundle->start = ray.t_min;
        }
    }
}

/* ---------------------------------------------------------------- parallel rays */

/* Rays in one direction through anything: places on shapes, the same place nearly, or all over the
 * scene; they begin on it, before it or behind it, and some very far away. */
static GiVec fill_parallel(
    const Fixture *fixture, GiBundle *bundle, int use, Room room, Random *random) {
    static const double lengths[] = {1, 1, 1e-9, 1e9};
    GiVec d = random_below(random, 2) ? nasty_direction(random) : random_unit(random);
    d = gi_scale(d, lengths[random_below(random, 4)]);
    double step = room.size / gi_length(d);
    bundle->side = random_below(random, 2) ? gi_vec(0, 0, 0) : random_vec(random, -1, 1);
    GiVec middle = gi_along(room.at, random_vec(random, -1, 1), room.size);
    for (int i = 0; i < bundle->count; i++) {
        GiVec p = gi_along(room.at, random_vec(random, -1, 1), 1.5 * room.size);
        if (use == 1) p = gi_along(middle, random_vec(random, -1, 1), 1e-5 * room.size);
        if (use == 2 && fixture->things.count > 0) {
            p = nasty_point(fixture, nasty_thing(fixture, random), random);
            p = gi_along(p, random_vec(random, -1, 1), room.size * fabs(random_tiny(random)));
        }
        double back = random_below(random, 3) ? random_real(random, -1, 4) : 0;
        if (random_below(random, 64) == 0) back *= pow(10, random_real(random, 1, 7));
        set_any(bundle, i, gi_along(p, d, -back * step), random_below(random, 2) ? 0 : 1e-9 * step);
        GiVec o = gi_vec(bundle->ox[i], bundle->oy[i], bundle->oz[i]);
        GiTraceRay ray = {o, d, bundle->t_min[i], INFINITY, GI_SHAPE_NONE, GI_SHAPE_NONE};
        if (i % 7 == 0) nasty_limits(fixture, true, random, &ray);
        if (i % 5 == 0 && fixture->things.count > 0) {
            Thing thing = nasty_thing(fixture, random);
            ray.skip = thing.ref.bits, ray.skip_instance = thing.instance;
        }
        bundle->t_min[i] = ray.t_min;
        bundle->skip[i] = ray.skip, bundle->skip_instance[i] = ray.skip_instance;
    }
    return d;
}

static void check_parallel(
    const Fixture *fixture, GiBundle *bundle, GiVec direction, const char *what) {
    static GiTraceRay rays[GI_BUNDLE_SIZE];
    static GiTraceHit expected[GI_BUNDLE_SIZE];
    for (int i = 0; i < bundle->count; i++) {
        rays[i] = (GiTraceRay){gi_vec(bundle->ox[i], bundle->oy[i], bundle->oz[i]), direction,
            bundle->t_min[i], INFINITY, bundle->skip[i], bundle->skip_instance[i]};
        brute_force(fixture, &rays[i], &expected[i]);
    }
    const GiKernel *kernel;
    for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
        kernel->bundle_parallel(&fixture->world.trace, bundle, direction);
        for (int i = 0; i < bundle->count; i++) {
            bool meets = expected[i].shape.bits != GI_SHAPE_NONE;
            if ((bundle->shape[i] != GI_SHAPE_NONE) == meets) continue;
            report(what, kernel, "bundle parallel", &rays[i], meets ? &nothing : &something,
                &expected[i]);
        }
    }
}

/* ---------------------------------------------------------------- tests */

static const Room rooms[] = {{{0, 0, 0}, 1}, {{0, 0, 0}, 1e-6}, {{0, 0, 0}, 1e6},
    {{1000, -2000, 3000}, 4}, {{1e6, -2e6, 3e6}, 3}, {{-3, 7, 2}, 8}};
enum { ROOM_COUNT = sizeof rooms / sizeof *rooms };

/* Every third where that would take minutes. */
static int room_step(void) { return test_slowness() > 1 ? 3 : 1; }

static void pass_gate(
    Kind kind, int count, Room room, GlintDialect dialect, int ray_count, int bundle_count) {
    static const int counts[] = {1, 7, 8, 15, 16, 17, 100, 1023, GI_BUNDLE_SIZE};
    static GiTraceRay rays[RAY_LIMIT];
    static GiBundle bundle;
    static char what[200];
    Fixture fixture;
    Random random = {(uint64_t)count * 64 + (uint64_t)kind};
    build(&fixture, kind, count, room, dialect, &random);
    snprintf(
        what, sizeof what, "%d %s, size %g at %g", count, kind_names[kind], room.size, room.at.x);
    wrong = 0;
    for (int i = 0; i < ray_count; i++) {
        rays[i] = nasty_ray(&fixture, room.at, room.size, &random);
        if (i % 3 == 0) nasty_limits(&fixture, true, &random, &rays[i]);
    }
    check_rays(&fixture, rays, ray_count, what);
    for (int i = 0; i < bundle_count; i++) {
        bool any = i % 2 == 1;
        bundle.count = counts[random_below(&random, 9)];
        fill_bundle(&fixture, &bundle, (Spread)(i / 2 % SPREAD_COUNT), room, any, &random);
        check_bundle(&fixture, &bundle, any, what);
    }
    for (int i = 0; i < bundle_count / 2; i++) {
        bundle.count = counts[random_below(&random, 9)];
        GiVec direction = fill_parallel(&fixture, &bundle, i % 3, room, &random);
        check_parallel(&fixture, &bundle, direction, what);
    }
    if (wrong > 3) test_fail(__FILE__, __LINE__, "%s: %d are wrong", what, wrong);
    fixture_end(&fixture);
}

static void few(Kind kind) {
    static const int counts[] = {0, 1, 2, 7, 8, 9};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        for (int r = 0; r < ROOM_COUNT; r += room_step()) {
            pass_gate(kind, counts[i], rooms[r], GLINT_DIALECT_2018B, 400, 2 * SPREAD_COUNT);
        }
    }
}

static void few_of_each_kind(void) {
    for (int kind = 0; kind < KIND_COUNT; kind++) few((Kind)kind);
}

static void hundred_of_each_kind(void) {
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        for (int r = 0; r < ROOM_COUNT; r += room_step()) {
            pass_gate((Kind)kind, 100, rooms[r], GLINT_DIALECT_2018B, RAY_LIMIT, 2 * SPREAD_COUNT);
        }
    }
}

static void thousands_of_each_kind(void) {
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        /* All planes are met by all rays, and an instance is many things. */
        if (kind == INSTANCES || kind == PLANES) continue;
        pass_gate(
            (Kind)kind, 3000, rooms[kind % ROOM_COUNT], GLINT_DIALECT_2018B, 600, 2 * SPREAD_COUNT);
    }
}

/* Boxes and cylinders without their exits. */
static void interior_rule(void) {
    for (int r = 0; r < ROOM_COUNT; r += room_step()) {
        pass_gate(MIXED, 9, rooms[r], GLINT_DIALECT_2012, 400, 2 * SPREAD_COUNT);
        pass_gate(MIXED, 100, rooms[r], GLINT_DIALECT_2012, RAY_LIMIT, 2 * SPREAD_COUNT);
    }
}

/* Rays that begin on a floor, or next to it, with the sun overhead: the floor's triangles have one
 * depth, which is the rays' own. */
static void sun_over_floors(void) {
    enum { SIDE = 6 };
    static GiBundle bundle;
    Random random = {41};
    for (int round = 0; round < 12; round++) {
        Fixture fixture;
        double height = round % 3 == 0 ? 0 : random_real(&random, -1, 1);
        fixture_begin(&fixture, GLINT_DIALECT_2018B);
        mesh_begin(&fixture.scene);
        for (int i = 0; i < (SIDE + 1) * (SIDE + 1); i++) {
            mesh_position(&fixture.scene,
                gi_vec(i % (SIDE + 1) / 3.0 - 1, (double)(i / (SIDE + 1)) / 3 - 1, height));
        }
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            uint32_t a = i / SIDE * (SIDE + 1) + i % SIDE, b = a + SIDE + 1;
            mesh_triangle(&fixture.scene, a, a + 1, b);
            mesh_triangle(&fixture.scene, a + 1, b + 1, b);
        }
        CHECK(gi_scene_place(&fixture.scene, GI_SHAPE_NONE, mesh_surface(&fixture.scene)));
        fixture_commit(&fixture, gi_kernel_at(0));
        GiVec direction = gi_vec(0, 0, round % 2 ? 1 : -2);
        if (round % 4 == 3) direction.x = random_tiny(&random);
        bundle.count = GI_BUNDLE_SIZE;
        bundle.side = gi_vec(0, 0, 0);
        for (int i = 0; i < bundle.count; i++) {
            GiVec o = random_vec(&random, -1.1, 1.1);
            o.z = (double)(float)height;
            if (i % 3 == 0) o.z += random_tiny(&random);
            if (i % 7 == 0) o.z += random_real(&random, -1, 1);
            set_any(&bundle, i, o, i % 2 ? 0 : fabs(random_tiny(&random)));
        }
        wrong = 0;
        check_parallel(&fixture, &bundle, direction, "sun over a floor");
        CHECK_INT(wrong, 0);
        fixture_end(&fixture);
    }
}

/* Of a bundle of parallel rays each goes through or by a sphere, from `least` to `most` away. */
static void aim_from_afar(const Fixture *fixture, GiBundle *bundle, GiVec direction, double least,
    double most, Random *random) {
    bundle->count = GI_BUNDLE_SIZE;
    for (int i = 0; i < bundle->count; i++) {
        GiVec p = nasty_point(fixture, nasty_thing(fixture, random), random);
        set_any(bundle, i, gi_along(p, direction, -random_real(random, least, most)), 0);
    }
}

static void add_sphere(Fixture *fixture, GiVec center, double radius) {
    GiShapeRef ref;
    CHECK(gi_scene_add_sphere(&fixture->scene, center, radius, 0, &ref));
    CHECK(gi_scene_place(&fixture->scene, GI_SHAPE_NONE, ref));
}

/* Packets are aligned with what is nearly the direction of the rays, which are long. */
static void sun_along_the_side(void) {
    static GiBundle bundle;
    Random random = {43};
    for (int digits = 3; digits < 14; digits++) {
        Fixture fixture;
        fixture_begin(&fixture, GLINT_DIALECT_2018B);
        for (int k = 0; k < 100; k++) add_sphere(&fixture, random_vec(&random, -1, 1), 0.01);
        fixture_commit(&fixture, gi_kernel_at(0));
        GiVec direction = random_unit(&random);
        bundle.side = gi_along(direction, random_vec(&random, -1, 1), pow(10, -digits));
        aim_from_afar(&fixture, &bundle, direction, 1e4, 3e4, &random);
        wrong = 0;
        check_parallel(&fixture, &bundle, direction, "sun along the side");
        CHECK_INT(wrong, 0);
        fixture_end(&fixture);
    }
}

/* A speck in the middle of the scene, where numbers are smallest, and rays that nearly touch it. */
static void sun_over_a_speck(void) {
    static GiBundle bundle;
    Random random = {44};
    for (int e = 22; e < 34; e++) {
        Fixture fixture;
        double radius = ldexp(1, -e);
        fixture_begin(&fixture, GLINT_DIALECT_2018B);
        add_sphere(&fixture, gi_vec(0, 0, 0), radius);
        for (int k = -1; k <= 1; k += 2) add_sphere(&fixture, gi_vec(0.9 * k, 0.9 * k, 0.9 * k), 0);
        fixture_commit(&fixture, gi_kernel_at(0));
        GiVec direction = random_unit(&random);
        bundle.count = GI_BUNDLE_SIZE;
        bundle.side = gi_vec(0, 0, 0);
        for (int i = 0; i < bundle.count; i++) {
            GiVec rim = gi_normalize(gi_cross(direction, random_unit(&random)));
            GiVec p = gi_scale(rim, radius * (1 + random_real(&random, -1e-4, 1e-4)));
            set_any(&bundle, i, gi_along(p, direction, -random_real(&random, 0, 0x1p14)), 0);
        }
        wrong = 0;
        check_parallel(&fixture, &bundle, direction, "sun over a speck");
        CHECK_INT(wrong, 0);
        fixture_end(&fixture);
    }
}

static int questions; /* whether to go on */

static bool count_question(const void *context) {
    (void)context;
    questions++;
    return false;
}

/* Where the unit of length is many times the scene, rays are traced together all the same: one by
 * one they would ask every now and then whether to go on. */
static void sun_over_a_tiny_scene(void) {
    static GiBundle bundle;
    Random random = {45};
    Fixture fixture;
    fixture_begin(&fixture, GLINT_DIALECT_2018B);
    for (int k = 0; k < 20; k++) add_sphere(&fixture, random_vec(&random, -1e-6, 1e-6), 1e-7);
    fixture_commit(&fixture, gi_kernel_at(0));
    bundle.side = gi_vec(0, 0, 0);
    bundle.stop = count_question;
    questions = 0;
    GiVec direction = random_unit(&random);
    aim_from_afar(&fixture, &bundle, direction, 0, 1e-6, &random);
    bundle.count = 1000; /* not a multiple of a packet's */
    wrong = 0;
    check_parallel(&fixture, &bundle, direction, "sun over a tiny scene");
    CHECK_INT(wrong, 0);
    CHECK_INT(questions, 0);
    fixture_end(&fixture);
}

const GiTest tests_gate[] = {TEST(few_of_each_kind), TEST(hundred_of_each_kind),
    TEST(thousands_of_each_kind), TEST(interior_rule), TEST(sun_over_floors),
    TEST(sun_along_the_side), TEST(sun_over_a_speck), TEST(sun_over_a_tiny_scene), TEST_END};
