/* SPDX-License-Identifier: MIT
 * Embree's rays of any width are arrays: field f of lane i is number f * width + i, and a single
 * ray has width 1. So one function sets out the rays of all modes. */
#define _POSIX_C_SOURCE 200809L
#include "rays_embree.h"

#include "message.h"
#include "rays_shapes.h"
#include "statistics.h"

#include <assert.h>
#include <embree3/rtcore.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <xmmintrin.h>

enum Field {
    ORIGIN = 0,
    T_NEAR = 3,
    DIRECTION = 4,
    TIME = 7,
    T_FAR = 8,
    MASK = 9,
    ID = 10,
    FLAGS = 11,
    RAY_FIELDS = 12,
    PRIMITIVE = RAY_FIELDS + 5,
    GEOMETRY,
    INSTANCE,
    RAY_HIT_FIELDS = 20
};

static_assert(sizeof(struct RTCRay) == 4 * RAY_FIELDS, "fields");
static_assert(sizeof(struct RTCRay16) == 64 * RAY_FIELDS, "fields");
static_assert(sizeof(struct RTCRayHit) == 4 * RAY_HIT_FIELDS, "fields");
static_assert(sizeof(struct RTCRayHit16) == 64 * RAY_HIT_FIELDS, "fields");

enum { STREAM = 1024, TREE_MAX = 4, BUILD_MAX = 5 };

typedef union Cell {
    float number;
    unsigned bits;
} Cell;

typedef struct Tree {
    const char *name;
    bool user, high; /* spheres as user geometry; quality */
    RTCScene scene;
    double seconds, bytes;
} Tree;

struct Embree {
    RTCDevice device;
    RaysShapes shapes;
    Tree trees[TREE_MAX];
    int tree_count;
    /* Rays set out. */
    int mode;
    bool any, coherent;
    size_t count, room;
    Cell *rays;
};

/* ---------------------------------------------------------------- modes */

typedef void (*CallFn)(RTCScene scene, struct RTCIntersectContext *context, void *rays);

static const _Alignas(64) int all[16] = {
    -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};

static void nothing(RTCScene scene, struct RTCIntersectContext *context, void *rays) {
    (void)scene, (void)context, (void)rays;
}
static void closest_1(RTCScene scene, struct RTCIntersectContext *context, void *rays) {
    rtcIntersect1(scene, context, rays);
}
static void any_1(RTCScene scene, struct RTCIntersectContext *context, void *rays) {
    rtcOccluded1(scene, context, rays);
}
static void closest_4(RTCScene scene, struct RTCIntersectContext *context, void *rays) {
    rtcIntersect4(all, scene, context, rays);
}
static void any_4(RTCScene scene, struct RTCIntersectContext *context, void *rays) {
    rtcOccluded4(all, scene, context, rays);
}
static void closest_8(RTCScene scene, struct RTCIntersectContext *context, void *rays) {
    rtcIntersect8(all, scene, context, rays);
}
static void any_8(RTCScene scene, struct RTCIntersectContext *context, void *rays) {
    rtcOccluded8(all, scene, context, rays);
}
static void closest_16(RTCScene scene, struct RTCIntersectContext *context, void *rays) {
    rtcIntersect16(all, scene, context, rays);
}
static void any_16(RTCScene scene, struct RTCIntersectContext *context, void *rays) {
    rtcOccluded16(all, scene, context, rays);
}
static void closest_1m(RTCScene scene, struct RTCIntersectContext *context, void *rays) {
    rtcIntersect1M(scene, context, rays, STREAM, sizeof(struct RTCRayHit));
}
static void any_1m(RTCScene scene, struct RTCIntersectContext *context, void *rays) {
    rtcOccluded1M(scene, context, rays, STREAM, sizeof(struct RTCRay));
}
static void closest_nm(RTCScene scene, struct RTCIntersectContext *context, void *rays) {
    rtcIntersectNM(scene, context, rays, 16, STREAM / 16, sizeof(struct RTCRayHit16));
}
static void any_nm(RTCScene scene, struct RTCIntersectContext *context, void *rays) {
    rtcOccludedNM(scene, context, rays, 16, STREAM / 16, sizeof(struct RTCRay16));
}

static const struct {
    const char *name;
    CallFn closest, any;
    size_t width, together; /* rays side by side, rays of a call */
} modes[] = {
    {"1", closest_1, any_1, 1, 1},
    {"4", closest_4, any_4, 4, 4},
    {"8", closest_8, any_8, 8, 8},
    {"16", closest_16, any_16, 16, 16},
    {"1M", closest_1m, any_1m, 1, STREAM},
    {"NM", closest_nm, any_nm, 16, STREAM},
};

int embree_mode_count(void) { return (int)(sizeof modes / sizeof modes[0]); }
const char *embree_mode_name(int mode) { return modes[mode].name; }

/* ---------------------------------------------------------------- spheres as user geometry */

/* Whoever wants speed compiles these for the machine: one lane after the other, shadow rays among
 * 1000 spheres take 1.5 times as long, and that would not be Embree's fault. */
#if defined(__x86_64__) && defined(__gnu_linux__)
#define CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLONES
#endif

static void sphere_bounds(const struct RTCBoundsFunctionArguments *arguments) {
    const float *s = ((const float(*)[4])arguments->geometryUserPtr)[arguments->primID];
    *arguments->bounds_o = (struct RTCBounds){.lower_x = s[0] - s[3],
        .lower_y = s[1] - s[3],
        .lower_z = s[2] - s[3],
        .upper_x = s[0] + s[3],
        .upper_y = s[1] + s[3],
        .upper_z = s[2] + s[3]};
}

/* Where the lanes that are valid meet the sphere, nearer than their ends; elsewhere infinity. Ray
 * directions are unit vectors. Loops without branches, for the compiler to make vectors of. */
static inline __attribute__((always_inline)) void sphere_lanes(
    const float s[4], const int *valid, const Cell *ray, unsigned n, float hit_t[16]) {
    for (unsigned i = 0; i < n; i++) {
        float x = s[0] - ray[ORIGIN * n + i].number;
        float y = s[1] - ray[(ORIGIN + 1) * n + i].number;
        float z = s[2] - ray[(ORIGIN + 2) * n + i].number;
        float dx = ray[DIRECTION * n + i].number;
        float dy = ray[(DIRECTION + 1) * n + i].number;
        float dz = ray[(DIRECTION + 2) * n + i].number;
        float near = ray[T_NEAR * n + i].number, far = ray[T_FAR * n + i].number;
        float b = x * dx + y * dy + z * dz;
        x -= b * dx, y -= b * dy, z -= b * dz;
        float square = s[3] * s[3] - (x * x + y * y + z * z);
        float half = __builtin_sqrtf(square > 0 ? square : 0);
        float t = b - half > near ? b - half : b + half;
        bool hit = (valid[i] != 0) & (square >= 0) & (t > near) & (t < far);
        hit_t[i] = hit ? t : INFINITY;
    }
}

static inline __attribute__((always_inline)) void sphere_closest(const float s[4], const int *valid,
    Cell *ray, unsigned n, unsigned primitive, unsigned geometry) {
    float t[16];
    sphere_lanes(s, valid, ray, n, t);
    for (unsigned i = 0; i < n; i++) {
        if (!(t[i] < INFINITY)) continue;
        ray[T_FAR * n + i].number = t[i];
        ray[PRIMITIVE * n + i].bits = primitive;
        ray[GEOMETRY * n + i].bits = geometry;
    }
}

static inline __attribute__((always_inline)) void sphere_any(
    const float s[4], const int *valid, Cell *ray, unsigned n) {
    float t[16];
    sphere_lanes(s, valid, ray, n, t);
    for (unsigned i = 0; i < n; i++) {
        if (t[i] < INFINITY) ray[T_FAR * n + i].number = -INFINITY;
    }
}

CLONES static void spheres_closest(const struct RTCIntersectFunctionNArguments *a) {
    const float *s = ((const float(*)[4])a->geometryUserPtr)[a->primID];
    Cell *ray = (Cell *)a->rayhit;
    switch (a->N) {
    case 1: sphere_closest(s, a->valid, ray, 1, a->primID, a->geomID); break;
    case 4: sphere_closest(s, a->valid, ray, 4, a->primID, a->geomID); break;
    case 8: sphere_closest(s, a->valid, ray, 8, a->primID, a->geomID); break;
    case 16: sphere_closest(s, a->valid, ray, 16, a->primID, a->geomID); break;
    default: message_fail("Embree: a packet of %u rays", a->N);
    }
}

CLONES static void spheres_any(const struct RTCOccludedFunctionNArguments *a) {
    const float *s = ((const float(*)[4])a->geometryUserPtr)[a->primID];
    Cell *ray = (Cell *)a->ray;
    switch (a->N) {
    case 1: sphere_any(s, a->valid, ray, 1); break;
    case 4: sphere_any(s, a->valid, ray, 4); break;
    case 8: sphere_any(s, a->valid, ray, 8); break;
    case 16: sphere_any(s, a->valid, ray, 16); break;
    default: message_fail("Embree: a packet of %u rays", a->N);
    }
}

/* ---------------------------------------------------------------- trees */

static void fail(void *user, enum RTCError code, const char *text) {
    (void)user;
    message_fail("Embree: error %d: %s", (int)code, text);
}

/* Counts what the device holds. */
static bool count_bytes(void *held, ssize_t bytes, bool post) {
    (void)post;
    __atomic_add_fetch((ssize_t *)held, bytes, __ATOMIC_RELAXED);
    return true;
}

static void attach(const Tree *tree, RTCGeometry geometry) {
    rtcSetGeometryBuildQuality(
        geometry, tree->high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(tree->scene, geometry);
    rtcReleaseGeometry(geometry);
}

static void add_triangles(RTCDevice device, const Tree *tree, const RaysTriangles *triangles) {
    if (triangles->count == 0) return;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
        triangles->positions, 0, 12, triangles->position_count);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
        triangles->corners, 0, 12, triangles->count);
    attach(tree, geometry);
}

static void add_spheres(RTCDevice device, const Tree *tree, const RaysShapes *shapes) {
    if (shapes->sphere_count == 0) return;
    RTCGeometry geometry = rtcNewGeometry(
        device, tree->user ? RTC_GEOMETRY_TYPE_USER : RTC_GEOMETRY_TYPE_SPHERE_POINT);
    if (tree->user) {
        rtcSetGeometryUserPrimitiveCount(geometry, (unsigned)shapes->sphere_count);
        rtcSetGeometryUserData(geometry, shapes->spheres);
        rtcSetGeometryBoundsFunction(geometry, sphere_bounds, NULL);
        rtcSetGeometryIntersectFunction(geometry, spheres_closest);
        rtcSetGeometryOccludedFunction(geometry, spheres_any);
    } else {
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
            shapes->spheres, 0, 16, shapes->sphere_count);
    }
    attach(tree, geometry);
}

/* Embree may leave work to threads of its own, so the whole process counts. */
static double process_cpu_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double build(Embree *embree, Tree *tree) {
    double start = process_cpu_seconds();
    tree->scene = rtcNewScene(embree->device);
    rtcSetSceneBuildQuality(
        tree->scene, tree->high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
    add_triangles(embree->device, tree, &embree->shapes.triangles);
    add_triangles(embree->device, tree, &embree->shapes.box_triangles);
    add_spheres(embree->device, tree, &embree->shapes);
    rtcCommitScene(tree->scene);
    return process_cpu_seconds() - start;
}

/* Small trees several times; the median counts. */
static void build_often(Embree *embree, Tree *tree) {
    double seconds[BUILD_MAX], sum = 0;
    int count = 0;
    ssize_t held = 0;
    rtcSetDeviceMemoryMonitorFunction(embree->device, count_bytes, &held);
    while (count < BUILD_MAX && sum < 1) {
        if (count > 0) rtcReleaseScene(tree->scene);
        sum += seconds[count++] = build(embree, tree);
    }
    rtcSetDeviceMemoryMonitorFunction(embree->device, NULL, NULL);
    tree->bytes = (double)held;
    tree->seconds = statistics_spread(seconds, count).median;
}

/* Embree's name of the instruction set of our kernels. */
static const char *isa_of(const GiKernel *kernel) {
    return strncmp(kernel->name, "avx", 3) == 0 ? kernel->name : "sse2";
}

Embree *embree_create(const GiWorld *world, const char **why) {
    Embree *embree = rays_allocate(1, sizeof *embree);
    *why = rays_shapes_of(world, &embree->shapes);
    if (*why != NULL) {
        embree_destroy(embree);
        return NULL;
    }
    char config[64];
    message_format(config, sizeof config, "threads=1,set_affinity=0,isa=%s", isa_of(world->kernel));
    embree->device = rtcNewDevice(config);
    if (embree->device == NULL) message_fail("Embree does not start");
    rtcSetDeviceErrorFunction(embree->device, fail, NULL);
    static const Tree trees[TREE_MAX] = {{.name = "medium"}, {.name = "high", .high = true},
        {.name = "user medium", .user = true}, {.name = "user high", .user = true, .high = true}};
    embree->tree_count = embree->shapes.sphere_count > 0 ? 4 : 2;
    for (int i = 0; i < embree->tree_count; i++) {
        embree->trees[i] = trees[i];
        build_often(embree, &embree->trees[i]);
    }
    return embree;
}

void embree_destroy(Embree *embree) {
    if (embree == NULL) return;
    for (int i = 0; i < embree->tree_count; i++) rtcReleaseScene(embree->trees[i].scene);
    if (embree->device != NULL) rtcReleaseDevice(embree->device);
    rays_shapes_free(&embree->shapes);
    free(embree->rays);
    free(embree);
}

int embree_tree_count(const Embree *embree) { return embree->tree_count; }
const char *embree_tree_name(const Embree *embree, int tree) { return embree->trees[tree].name; }
double embree_build_seconds(const Embree *embree, int tree) { return embree->trees[tree].seconds; }
double embree_tree_bytes(const Embree *embree, int tree) { return embree->trees[tree].bytes; }

const char *embree_version(void) { return "Embree " RTC_VERSION_STRING; }

/* ---------------------------------------------------------------- rays */

static size_t field_count(const Embree *embree) {
    return embree->any ? RAY_FIELDS : RAY_HIT_FIELDS;
}

/* Directions become unit vectors, which spares the spheres a division. ray null: a lane at rest. */
static void set_out(Cell *at, size_t width, bool any, const GiTraceRay *ray) {
    static const GiTraceRay rest = {.direction = {0, 0, 1}, .t_min = INFINITY, .t_max = 0};
    if (ray == NULL) ray = &rest;
    double length = gi_length(ray->direction);
    GiVec d = gi_scale(ray->direction, 1 / length);
    const double origin[3] = {ray->origin.x, ray->origin.y, ray->origin.z};
    const double direction[3] = {d.x, d.y, d.z};
    for (size_t axis = 0; axis < 3; axis++) {
        at[(ORIGIN + axis) * width].number = (float)origin[axis];
        at[(DIRECTION + axis) * width].number = (float)direction[axis];
    }
    at[T_NEAR * width].number = (float)(ray->t_min * length);
    at[T_FAR * width].number = (float)(ray->t_max * length);
    at[TIME * width].number = 0;
    at[MASK * width].bits = UINT32_MAX;
    at[ID * width].bits = at[FLAGS * width].bits = 0;
    if (any) return;
    at[GEOMETRY * width].bits = at[INSTANCE * width].bits = RTC_INVALID_GEOMETRY_ID;
}

void embree_load(Embree *embree, int mode, const RaySet *set) {
    size_t width = modes[mode].width;
    embree->mode = mode;
    embree->any = set->kind == RAYS_SHADOW;
    embree->coherent = set->kind != RAYS_BOUNCE;
    embree->count = (set->count + STREAM - 1) / STREAM * STREAM;
    size_t fields = field_count(embree), size = embree->count * fields * sizeof(Cell);
    if (size > embree->room) {
        free(embree->rays);
        embree->rays = aligned_alloc(64, size); /* STREAM rays are a multiple of 64 bytes */
        if (embree->rays == NULL) message_fail("not enough memory");
        embree->room = size;
    }
    for (size_t i = 0; i < embree->count; i++) {
        Cell *at = embree->rays + i / width * width * fields + i % width;
        set_out(at, width, embree->any, i < set->count ? &set->rays[i] : NULL);
    }
}

static inline size_t count_hits(const Cell *rays, size_t count, size_t width, bool any) {
    size_t hit_count = 0, fields = any ? RAY_FIELDS : RAY_HIT_FIELDS;
    for (size_t i = 0; i < count; i += width) {
        const Cell *at = rays + i * fields + (any ? T_FAR : GEOMETRY) * width;
        for (size_t k = 0; k < width; k++) {
            hit_count += any ? at[k].number < 0 : at[k].bits != RTC_INVALID_GEOMETRY_ID;
        }
    }
    return hit_count;
}

static inline __attribute__((always_inline)) size_t trace_all(
    const Embree *embree, RTCScene scene, CallFn call, size_t width, size_t together, bool any) {
    static _Alignas(64) Cell rays[STREAM * RAY_HIT_FIELDS];
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = embree->coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                     : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    size_t fields = any ? RAY_FIELDS : RAY_HIT_FIELDS, hit_count = 0;
    for (size_t i = 0; i < embree->count; i += together) {
        memcpy(rays, embree->rays + i * fields, together * fields * sizeof(Cell));
        call(scene, &context, rays);
        hit_count += count_hits(rays, together, width, any);
    }
    return hit_count;
}

/* With the numbers of the mode known to the compiler. */
static size_t trace_mode(const Embree *embree, RTCScene scene, CallFn call) {
#define CASE(mode, width, together)                                                                \
    case mode:                                                                                     \
        return embree->any ? trace_all(embree, scene, call, width, together, true)                 \
                           : trace_all(embree, scene, call, width, together, false)
    switch (embree->mode) {
        CASE(0, 1, 1);
        CASE(1, 4, 4);
        CASE(2, 8, 8);
        CASE(3, 16, 16);
        CASE(4, 1, STREAM);
    default: CASE(5, 16, STREAM);
    }
#undef CASE
}

RayPass embree_trace(Embree *embree, int tree, bool empty) {
    CallFn call = embree->any ? modes[embree->mode].any : modes[embree->mode].closest;
    unsigned state = _mm_getcsr();
    _mm_setcsr(state | 0x8040); /* denormals are zero, as Embree recommends */
    double start = rays_seconds();
    size_t hit_count = trace_mode(embree, embree->trees[tree].scene, empty ? nothing : call);
    RayPass pass = {rays_seconds() - start, hit_count};
    _mm_setcsr(state);
    return pass;
}
