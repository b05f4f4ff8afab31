/* SPDX-License-Identifier: MIT
 * No ray slips between two triangles that share an edge: closed meshes are traced from inside, in
 * all directions and through corners and points of edges, and every ray has to meet something, by
 * every kernel and in every way. Ten million rays, or as many as --rays says. */
#include "meshes.h"
#include "nasty.h"
#include "test.h"

#include <string.h>

/* ---------------------------------------------------------------- closed meshes */

typedef struct Closed {
    const char *name;
    GiVec at;
    double size;  /* half of its largest extent, about */
    double inner; /* half the side of a cube round `at` that is inside */
    double core;  /* a torus: the radius of the circle that is inside; otherwise 0 */
    double moved; /* an instance under a transform, so far away; 0: not one */
    Fixture fixture;
    GiAffine to_world;
} Closed;

/* Two fans of `around` triangles each over one ring, with their tips `length` away. */
static GiShapeRef mesh_spindle(GiScene *scene, GiVec at, double radius, double length, int around) {
    mesh_begin(scene);
    mesh_position(scene, gi_add(at, gi_vec(0, 0, length)));
    mesh_position(scene, gi_add(at, gi_vec(0, 0, -length)));
    for (int i = 0; i < around; i++) {
        double angle = 6.283185307179586 * i / around;
        mesh_position(scene, gi_add(at, gi_vec(radius * cos(angle), radius * sin(angle), 0)));
    }
    for (uint32_t i = 0; i < (uint32_t)around; i++) {
        uint32_t a = 2 + i, b = 2 + (i + 1) % (uint32_t)around;
        mesh_triangle(scene, 0, a, b);
        mesh_triangle(scene, b, a, 1);
    }
    return mesh_surface(scene);
}

static GiShapeRef mesh_torus(
    GiScene *scene, GiVec at, double core, double tube, int around, int across) {
    mesh_begin(scene);
    for (int i = 0; i < around * across; i++) {
        double a = 6.283185307179586 * (i / across) / around;
        double b = 6.283185307179586 * (i % across) / across;
        double radius = core + tube * cos(b);
        mesh_position(scene, gi_add(at, gi_vec(radius * cos(a), radius * sin(a), tube * sin(b))));
    }
    for (int i = 0; i < around; i++) {
        for (int k = 0; k < across; k++) {
            uint32_t row = (uint32_t)(i * across), next = (uint32_t)((i + 1) % around * across);
            uint32_t p = (uint32_t)k, q = (uint32_t)((k + 1) % across);
            mesh_triangle(scene, row + p, next + p, next + q);
            mesh_triangle(scene, row + p, next + q, row + q);
        }
    }
    return mesh_surface(scene);
}

/* Two triangles a side, of which so many are there. */
static GiShapeRef mesh_cube(GiScene *scene, GiVec at, double half, int triangles) {
    static const uint32_t faces[6][4] = {
        {0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    mesh_begin(scene);
    for (int i = 0; i < 8; i++) {
        GiVec corner = gi_vec(i & 4 ? half : -half, i & 2 ? half : -half, i & 1 ? half : -half);
        mesh_position(scene, gi_add(at, corner));
    }
    for (int i = 0; i < triangles; i++) {
        const uint32_t *face = faces[i / 2];
        mesh_triangle(scene, face[0], face[1 + i % 2], face[2 + i % 2]);
    }
    return mesh_surface(scene);
}

static void place(Closed *closed, GiShapeRef ref) {
    GiScene *scene = &closed->fixture.scene;
    closed->to_world = gi_affine_identity;
    if (closed->moved > 0) {
        GiShapeRef group;
        CHECK(gi_scene_add_group(scene, &group));
        uint32_t index = gi_shape_index(group);
        GiVec move = gi_vec(closed->moved, 2, -3);
        CHECK(gi_scene_add_step(scene, index, GI_STEP_TRANSLATE, move));
        CHECK(gi_scene_add_step(scene, index, GI_STEP_ROTATE, gi_vec(20, 30, 40)));
        CHECK(gi_scene_add_step(scene, index, GI_STEP_SCALE, gi_vec(0.5, -2, 1)));
        CHECK(gi_scene_place(scene, index, ref));
        ref = group;
    }
    CHECK(gi_scene_place(scene, GI_SHAPE_NONE, ref));
    fixture_commit(&closed->fixture, gi_kernel_at(0));
    if (!(closed->moved > 0)) return;
    const GiShapes *shapes = &closed->fixture.world.shapes;
    closed->to_world = shapes->transforms[shapes->instances[0].transform].to_world;
}

enum { MESHES = 15 };

static void make_meshes(Closed *meshes) {
    const GiVec zero = {0, 0, 0}, far = {1000, -2000, 3000}, farther = {1e6, -2e6, 3e6};
    const Closed table[MESHES] = {
        {.name = "sphere", .at = zero, .size = 1, .inner = 0.4},
        {.name = "rough sphere", .at = zero, .size = 1.3, .inner = 0},
        {.name = "tiny rough sphere", .at = zero, .size = 1.3e-12, .inner = 0},
        {.name = "huge sphere", .at = zero, .size = 1e12, .inner = 4e11},
        {.name = "far sphere", .at = far, .size = 1, .inner = 0.4},
        {.name = "sphere as an instance", .at = zero, .size = 1, .inner = 0.4, .moved = 1000},
        {.name = "cube", .at = zero, .size = 1, .inner = 0.9},
        {.name = "small cube beside the grid", .at = {0.1, 0.2, 0.3}, .size = 1e-3, .inner = 9e-4},
        {.name = "farther cube", .at = farther, .size = 50, .inner = 45},
        {.name = "fans", .at = zero, .size = 1, .inner = 0.15},
        {.name = "needles", .at = zero, .size = 1000, .inner = 0.15},
        {.name = "torus", .at = zero, .size = 1.3, .core = 1},
        {.name = "thin torus", .at = zero, .size = 1.01, .core = 1},
        {.name = "far torus as an instance", .at = far, .size = 13, .core = 10, .moved = 1000},
        {.name = "cube as a far instance", .at = zero, .size = 1, .inner = 0.9, .moved = 3e6},
    };
    Random random = {21};
    for (int i = 0; i < MESHES; i++) {
        Closed *closed = &meshes[i];
        *closed = table[i];
        fixture_begin(&closed->fixture, GLINT_DIALECT_GLINT);
        GiScene *scene = &closed->fixture.scene;
        GiVec at = closed->at;
        double size = closed->size, core = closed->core;
        GiShapeRef ref;
        if (i < 6) {
            bool rough = i == 1 || i == 2;
            ref = mesh_sphere(scene, at, rough ? size / 1.3 : size, i == 0 ? 100 : 24,
                rough ? 0.3 : 0, false, true, &random);
        } else if (i < 9 || i == 14) {
            ref = mesh_cube(scene, at, size, 12);
        } else if (i < 11) {
            ref = mesh_spindle(scene, at, 1, size, i == 9 ? 300 : 150);
        } else {
            ref = mesh_torus(scene, at, core, size - core, 80, i == 12 ? 8 : 24);
        }
        place(closed, ref);
    }
}

/* ---------------------------------------------------------------- rays */

/* A place inside, with room around it; the centre and places on a grid are the worst. */
static GiVec place_inside(const Closed *closed, Random *random) {
    GiVec p = closed->at;
    if (closed->core > 0) {
        double angle = 6.283185307179586 / 80 * random_below(random, 80);
        p = gi_along(p, gi_vec(cos(angle), sin(angle), 0), closed->core);
    } else {
        GiVec part = random_vec(random, -1, 1);
        if (random_below(random, 2)) {
            part = gi_vec(floor(4 * part.x) / 4, floor(4 * part.y) / 4, floor(4 * part.z) / 4);
        }
        if (random_below(random, 3) != 0) p = gi_along(p, part, closed->inner);
    }
    return gi_affine_point(&closed->to_world, p);
}

/* Beyond the surface, seen from inside; d goes that way. */
static GiVec place_outside(const Closed *closed, GiVec inside, GiVec d, Random *random) {
    /* The transform above stretches to the double at most. */
    double least = 4 * 1.5 * closed->size / gi_length(d);
    return gi_along(inside, d, least * exp2(random_real(random, 0, 6)));
}

/* From inside through a triangle's corner, edge or middle, or any way at all. Of the triangles
 * `window` many in a row, neighbours in space, are looked at. */
static GiVec direction_out(
    const Closed *closed, GiVec inside, int first, int window, Random *random) {
    const Fixture *fixture = &closed->fixture;
    if (window == 0) return nasty_direction(random);
    int index = (first + random_below(random, window)) % (int)fixture->things.count;
    GiVec target = nasty_point(fixture, fixture->things.data[index], random);
    GiVec d = gi_sub(target, inside);
    switch (random_below(random, 8)) {
    case 0: d = gi_scale(d, 1e-3); break;
    case 1: d = gi_scale(d, 1e6); break;
    case 2: d = gi_scale(d, 1 / gi_length(d)); break;
    default: break;
    }
    return d;
}

static GiTraceRay ray_of(GiVec o, GiVec d, double t_max) {
    return (GiTraceRay){o, d, 0, t_max, GI_SHAPE_NONE, GI_SHAPE_NONE};
}

enum { BLOCK = GI_BUNDLE_SIZE };

typedef enum Way { CLOSEST, ANY, MANY_CLOSEST, MANY_ANY, BUNDLE_CLOSEST, BUNDLE_ANY, WAYS } Way;

static const char *const way_names[] = {
    "closest", "any", "many closest", "many any", "bundle closest", "bundle any"};

/* A worker's own. */
typedef struct Worker {
    GiBundle bundle;
    GiTraceRay rays[BLOCK];
    GiTraceHit hits[BLOCK];
    bool met[BLOCK];
    uint64_t traced, lost;
    GiTraceRay first_lost; /* and how */
    const GiKernel *kernel;
    const char *mesh, *way;
} Worker;

typedef struct Leak {
    Closed *meshes;
    Worker *workers;
    int kernel_count;
} Leak;

/* Out of the mesh, or on the way in as far as to a place inside. */
static void fill_rays(Worker *worker, const Closed *closed, Random *random) {
    int triangles = (int)closed->fixture.things.count;
    for (int i = 0; i < BLOCK; i++) {
        GiVec inside = place_inside(closed, random);
        GiVec d = direction_out(closed, inside, 0, i % 8 ? triangles : 0, random);
        worker->rays[i] = ray_of(inside, d, INFINITY);
        if (random_below(random, 3) != 0) continue;
        GiVec o = place_outside(closed, inside, d, random);
        worker->rays[i] = ray_of(o, gi_sub(inside, o), 1);
    }
}

static void fill_bundle(Worker *worker, const Closed *closed, bool any, Random *random) {
    static const int windows[] = {0, 1, 3, 16, 100, 1000};
    GiBundle *bundle = &worker->bundle;
    int triangles = (int)closed->fixture.things.count;
    int first = random_below(random, triangles), window = windows[random_below(random, 6)];
    if (window > triangles) window = triangles;
    bundle->count = BLOCK;
    bundle->apex = place_inside(closed, random);
    bundle->side = gi_vec(0, 0, 0);
    bundle->end = 1;
    bundle->own = false;
    for (int i = 0; i < BLOCK; i++) {
        GiVec d = direction_out(closed, bundle->apex, first, window, random), o = bundle->apex;
        if (any) {
            o = place_outside(closed, bundle->apex, d, random);
            d = gi_sub(bundle->apex, o);
        }
        worker->rays[i] = ray_of(o, d, any ? 1 : INFINITY);
        bundle_put_ray(bundle, i, o, d, 0);
    }
}

static void trace_block(Worker *worker, const GiKernel *kernel, const GiTrace *trace, Way way) {
    switch (way) {
    case CLOSEST:
        for (int i = 0; i < BLOCK; i++) {
            worker->met[i] = kernel->closest(trace, &worker->rays[i], &worker->hits[i]);
        }
        return;
    case ANY:
        for (int i = 0; i < BLOCK; i++) worker->met[i] = kernel->any(trace, &worker->rays[i]);
        return;
    case MANY_CLOSEST:
        kernel->many_closest(trace, worker->rays, BLOCK, worker->hits);
        for (int i = 0; i < BLOCK; i++)
            worker->met[i] = worker->hits[i].shape.bits != GI_SHAPE_NONE;
        return;
    case MANY_ANY: kernel->many_any(trace, worker->rays, BLOCK, worker->met); return;
    case BUNDLE_CLOSEST: kernel->bundle_closest(trace, &worker->bundle); break;
    default: kernel->bundle_any(trace, &worker->bundle);
    }
    for (int i = 0; i < BLOCK; i++) worker->met[i] = worker->bundle.shape[i] != GI_SHAPE_NONE;
}

/* A block's number decides what it is, so that the rays are the same for any number of workers. */
static void leak_block(const Leak *leak, Worker *worker, size_t block) {
    Random random = {block};
    const GiKernel *kernel = gi_kernel_at((int)(block % (size_t)leak->kernel_count));
    block /= (size_t)leak->kernel_count;
    Way way = (Way)(block % WAYS);
    const Closed *closed = &leak->meshes[block / WAYS % MESHES];
    if (way < BUNDLE_CLOSEST) {
        fill_rays(worker, closed, &random);
    } else {
        fill_bundle(worker, closed, way == BUNDLE_ANY, &random);
    }
    trace_block(worker, kernel, &closed->fixture.world.trace, way);
    worker->traced += BLOCK;
    for (int i = 0; i < BLOCK; i++) {
        if (worker->met[i] || worker->lost++ > 0) continue;
        worker->first_lost = worker->rays[i];
        worker->kernel = kernel;
        worker->mesh = closed->name;
        worker->way = way_names[way];
    }
}

static void leak_blocks(void *context, size_t begin, size_t end, int index) {
    const Leak *leak = context;
    for (size_t i = begin; i < end; i++) leak_block(leak, &leak->workers[index], i);
}

/* ---------------------------------------------------------------- tests */

static void report_lost(const Worker *worker) {
    if (worker->lost == 0) return;
    const GiTraceRay *ray = &worker->first_lost;
    test_fail(__FILE__, __LINE__,
        "%llu of %llu rays are lost, the first in the %s, %s, %s: (%a %a %a) + t (%a %a %a)",
        (unsigned long long)worker->lost, (unsigned long long)worker->traced, worker->mesh,
        worker->kernel->name, worker->way, ray->origin.x, ray->origin.y, ray->origin.z,
        ray->direction.x, ray->direction.y, ray->direction.z);
}

static void closed_to_all_rays(void) {
    static Closed meshes[MESHES];
    GiMemory memory;
    GiPool *pool = NULL;
    gi_memory_init(&memory, NULL, 0);
    CHECK_INT(gi_pool_create(&memory, 0, &pool), GLINT_OK);
    if (pool == NULL) return;
    size_t workers = (size_t)gi_pool_worker_count(pool);
    Leak leak = {.meshes = meshes};
    leak.workers = gi_memory_allocate_lines(&memory, workers, sizeof *leak.workers);
    CHECK(leak.workers != NULL);
    if (leak.workers != NULL) {
        memset(leak.workers, 0, workers * sizeof *leak.workers);
        make_meshes(meshes);
        while (gi_kernel_at(leak.kernel_count) != NULL) leak.kernel_count++;
        size_t blocks = (size_t)(test_rays(10000000) / BLOCK) + 1;
        gi_parallel_for(pool, blocks, 1, leak_blocks, &leak);
        uint64_t traced = 0;
        for (size_t i = 0; i < workers; i++) {
            report_lost(&leak.workers[i]);
            traced += leak.workers[i].traced;
        }
        CHECK_INT(traced, blocks * BLOCK);
        for (int i = 0; i < MESHES; i++) fixture_end(&meshes[i].fixture);
        gi_memory_free_lines(&memory, leak.workers, workers, sizeof *leak.workers);
    }
    gi_pool_destroy(pool);
}

/* The test would notice: with one triangle away, rays are lost. */
static void notices_a_hole(void) {
    Closed closed = {.name = "open cube", .size = 1, .inner = 0.9};
    fixture_begin(&closed.fixture, GLINT_DIALECT_GLINT);
    GiShapeRef ref = mesh_cube(&closed.fixture.scene, closed.at, closed.size, 11);
    place(&closed, ref);
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    Worker *worker = gi_memory_allocate_lines(&memory, 1, sizeof *worker);
    CHECK(worker != NULL);
    if (worker != NULL) memset(worker, 0, sizeof *worker);
    const GiKernel *kernel;
    for (int k = 0; worker != NULL && (kernel = gi_kernel_at(k)) != NULL; k++) {
        for (int way = 0; way < WAYS; way++) {
            Random random = {22};
            int lost = 0;
            for (int block = 0; block < 12; block++) {
                fill_rays(worker, &closed, &random);
                if (way >= BUNDLE_CLOSEST) {
                    fill_bundle(worker, &closed, way == BUNDLE_ANY, &random);
                }
                trace_block(worker, kernel, &closed.fixture.world.trace, (Way)way);
                for (int i = 0; i < BLOCK; i++) lost += !worker->met[i];
            }
            CHECK(lost > 100);
        }
    }
    gi_memory_free_lines(&memory, worker, 1, sizeof *worker);
    fixture_end(&closed.fixture);
}

const GiTest tests_leak[] = {TEST(closed_to_all_rays), TEST(notices_a_hole), TEST_END};
