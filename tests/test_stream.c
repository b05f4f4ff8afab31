/* SPDX-License-Identifier: MIT
 * What the kernels do to many rays and points at a time against the functions for one: the same
 * bits for every instruction set and every count. */
#include "kernel/kernel.h"
#include "random.h"
#include "shape/hit.h"
#include "test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT = 100, SHAPES = 40 };

typedef struct Streams {
    GiBundle bundle;
    GiPoints points;
    GiLit lit;
} Streams;

static bool same(GiVec a, GiVec b) { return memcmp(&a, &b, sizeof a) == 0; }

static GiVec vec_at(const double *x, const double *y, const double *z, int i) {
    return gi_vec(x[i], y[i], z[i]);
}

/* ---------------------------------------------------------------- camera rays */

static void check_view(const GiKernel *kernel, Streams *s, Random *random, bool parallel) {
    /* Now and then a window so small or large that squares leave the range of double. */
    const double sizes[] = {1, 1, 1, 1e-150, 1e150};
    double size = sizes[random_below(random, 5)], a[COUNT + 8], b[COUNT + 8];
    GiView view = {parallel, random_vec(random, -9, 9), gi_scale(random_vec(random, -1, 1), size),
        gi_scale(random_vec(random, -1, 1), size), gi_scale(random_vec(random, -1, 1), size)};
    GiBundle *bundle = &s->bundle;
    bundle->count = 1 + random_below(random, COUNT);
    for (int i = 0; i < COUNT; i++) {
        a[i] = random_real(random, 0, 1);
        b[i] = random_real(random, 0, 1);
    }
    kernel->view(&view, a, b, bundle);
    for (int i = 0; i < bundle->count; i++) {
        GiVec origin, direction;
        gi_view_ray(&view, a[i], b[i], &origin, &direction);
        if (parallel) CHECK(same(vec_at(bundle->ox, bundle->oy, bundle->oz, i), origin));
        CHECK(same(vec_at(bundle->dx, bundle->dy, bundle->dz, i), direction));
    }
}

/* ---------------------------------------------------------------- groups */

static void check_group(const GiKernel *kernel, Random *random) {
    uint32_t keys[GI_BUNDLE_ROOM], places[GI_BUNDLE_ROOM];
    int ends[GI_BUNDLE_SIZE];
    int count = 1 + random_below(random, GI_BUNDLE_SIZE);
    int kinds = 1 + random_below(random, random_below(random, 2) ? 8 : 3000);
    bool seen[GI_BUNDLE_SIZE] = {false};
    for (int i = 0; i < GI_BUNDLE_ROOM; i++) {
        uint32_t key = (uint32_t)random_below(random, kinds) * 512;
        keys[i] = random_below(random, 4) == 0 ? UINT32_MAX : key;
    }
    int groups = kernel->group(keys, count, places, ends), begin = 0;
    for (int g = 0; g < groups; begin = ends[g++]) {
        CHECK(ends[g] > begin);
        uint32_t key = keys[places[begin]];
        for (int k = 0; k < g; k++) CHECK(keys[places[ends[k] - 1]] != key);
        for (int i = begin; i < ends[g]; i++) {
            CHECK(places[i] < (uint32_t)count && keys[places[i]] == key && !seen[places[i]]);
            CHECK(i == begin || places[i - 1] < places[i]);
            seen[places[i]] = true;
        }
    }
    CHECK_INT(begin, count);
}

/* ---------------------------------------------------------------- points */

typedef struct Solids {
    GiSphere spheres[SHAPES];
    GiBox boxes[SHAPES];
    GiCone cones[SHAPES];
    GiMesh meshes[4];
    float positions[3 * SHAPES + 1][3], normals[3 * SHAPES + 1][3]; /* one more than there are */
    uint32_t corners[SHAPES][3], normal_corners[SHAPES][3];
    GiShapes shapes;
} Solids;

/* Triangles in meshes without normals, with a normal for each position, and with normals of their
 * own, which some have not. Many normals are zero. */
static void fill_meshes(Solids *solids, Random *random) {
    enum { EACH = SHAPES / 4 };
    for (int i = 0; i < 3 * SHAPES; i++) {
        GiVec p = random_vec(random, -5, 5), n = random_vec(random, -1, 1);
        double size = random_below(random, 2) == 0 ? 0 : 1;
        for (int axis = 0; axis < 3; axis++) {
            solids->positions[i][axis] = (float)(&p.x)[axis];
            solids->normals[i][axis] = (float)((&n.x)[axis] * size);
        }
    }
    for (uint32_t i = 0; i < SHAPES; i++) {
        bool bare = random_below(random, 4) == 0;
        for (uint32_t corner = 0; corner < 3; corner++) {
            uint32_t any = (uint32_t)random_below(random, 3 * SHAPES);
            solids->corners[i][corner] = 3 * i + corner;
            solids->normal_corners[i][corner] = bare ? GI_SHAPE_NONE : any;
        }
    }
    for (uint32_t i = 0; i < 4; i++) {
        solids->meshes[i] = (GiMesh){.first_triangle = i * EACH,
            .triangle_count = EACH,
            .first_position = 3 * i * EACH,
            .position_count = 3 * EACH,
            .first_normal = 3 * (3 - i) * EACH,
            .smooth = i > 0,
            .normal_corners = i == 2 ? solids->normal_corners + i * EACH : NULL};
    }
}

static void fill_solids(Solids *solids, Random *random) {
    for (int i = 0; i < SHAPES; i++) {
        GiVec c = random_vec(random, -5, 5), size = random_vec(random, 0.1, 3);
        solids->spheres[i] = (GiSphere){c, size.x};
        solids->boxes[i] = (GiBox){gi_sub(c, size), gi_add(c, size)};
        /* Cylinders, cones with their apex at an end, and with two nappes. */
        double slope = random_below(random, 3) ? random_real(random, -2, 2) : 0;
        double radius = random_below(random, 2) ? fabs(slope) * size.z : size.x;
        solids->cones[i] = (GiCone){c, radius, slope, size.z};
    }
    fill_meshes(solids, random);
    const GiTriangles triangles = {.positions = (const float(*)[3])solids->positions,
        .normals = (const float(*)[3])solids->normals,
        .corners = (const uint32_t(*)[3])solids->corners};
    solids->shapes = (GiShapes){.spheres = solids->spheres,
        .boxes = solids->boxes,
        .cones = solids->cones,
        .triangles = triangles,
        .meshes = solids->meshes,
        .mesh_count = 4};
}

/* A ray that meets the shape, in the bundle's place i. */
static void put_ray(GiBundle *bundle, Random *random, const Solids *solids, GiShapeRef ref, int i) {
    bool solid = gi_shape_kind(ref) != GI_SHAPE_TRIANGLE;
    uint32_t shape = gi_shape_index(ref);
    const float *corner = solids->positions[3 * shape];
    GiVec place = solid ? solids->cones[shape].center : gi_vec(corner[0], corner[1], corner[2]);
    for (;;) {
        GiVec o = random_vec(random, -9, 9), d = random_vec(random, -1, 1);
        if (!bundle->own) {
            o = bundle->apex;
            d = gi_sub(gi_along(place, d, random_real(random, 0, 4)), o);
        } else if (solid && random_below(random, 4) == 0) {
            /* Along an axis, through the middle of the solid. */
            o = place;
            o.z -= 9;
            d = gi_vec(0, 0, 1);
        }
        const gi_hit_Ray ray = gi_hit_ray(o.x, o.y, o.z, d.x, d.y, d.z);
        if (!gi_hit_shape(&solids->shapes, ref, &ray, 0, INFINITY, &bundle->t[i])) continue;
        bundle->ox[i] = o.x, bundle->oy[i] = o.y, bundle->oz[i] = o.z;
        bundle->dx[i] = d.x, bundle->dy[i] = d.y, bundle->dz[i] = d.z;
        bundle->shape[i] = ref.bits;
        bundle->pixel[i] = (uint32_t)random_below(random, 1000);
        return;
    }
}

static void check_points(
    const GiKernel *kernel, Streams *s, Random *random, GiShapeKind kind, bool spared) {
    Solids solids;
    fill_solids(&solids, random);
    GiBundle *bundle = &s->bundle;
    bundle->apex = random_vec(random, -9, 9);
    /* Some cones are so thin that only rays along their axis meet them. */
    bundle->own = kind == GI_SHAPE_CONE || random_below(random, 2);
    uint32_t rays[COUNT];
    int first = random_below(random, SHAPES),
        different = 1 + random_below(random, 2) * (SHAPES - first - 1);
    for (int i = 0; i < COUNT; i++) {
        GiShapeRef ref = gi_shape_ref(kind, (uint32_t)(first + random_below(random, different)));
        put_ray(bundle, random, &solids, ref, i);
        rays[i] = (uint32_t)random_below(random, COUNT);
    }
    if (random_below(random, 2)) { /* neighbours */
        for (int i = 0; i < COUNT; i++) rays[i] = (uint32_t)i;
    }
    int begin = random_below(random, 20), count = 1 + random_below(random, COUNT);
    bool geometric = random_below(random, 2) != 0;
    GiPoints *points = &s->points;
    points->count = begin;
    kernel->points(&solids.shapes, bundle, rays, count, spared, geometric, points);
    CHECK_INT(points->count, begin + count);
    for (int k = 0; k < count; k++) {
        int i = begin + k, ray = (int)rays[k];
        GiVec d = vec_at(bundle->dx, bundle->dy, bundle->dz, ray);
        GiSurfacePoint at = gi_shape_point(&solids.shapes, (GiShapeRef){bundle->shape[ray]},
            GI_SHAPE_NONE, gi_bundle_origin(bundle, ray), d, bundle->t[ray], geometric);
        CHECK(same(vec_at(points->px, points->py, points->pz, i), at.point));
        CHECK(same(vec_at(points->nx, points->ny, points->nz, i), at.normal));
        CHECK(same(vec_at(points->vx, points->vy, points->vz, i), gi_negate(d)));
        CHECK(same(vec_at(points->red, points->green, points->blue, i), gi_vec(0, 0, 0)));
        CHECK(points->error[i] == at.error);
        CHECK_INT(points->pixel[i], bundle->pixel[ray]);
        CHECK_INT(points->skip[i], spared ? bundle->shape[ray] : GI_SHAPE_NONE);
        CHECK_INT(points->skip_instance[i], GI_SHAPE_NONE);
    }
}

/* ---------------------------------------------------------------- light */

/* Points, and as many lit among them as wanted. */
static void fill_lit(Streams *s, Random *random) {
    GiPoints *points = &s->points;
    GiLit *lit = &s->lit;
    points->count = COUNT + random_below(random, COUNT);
    lit->count = 0;
    for (int i = 0; i < points->count; i++) {
        double *numbers[] = {points->px, points->py, points->pz, points->red, points->green,
            points->blue, lit->red, lit->green, lit->blue, lit->t_min};
        for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++) {
            numbers[k][i] = random_real(random, -5, 5);
        }
        lit->skip[i] = (uint32_t)random_bits(random);
        points->skip_instance[i] = (uint32_t)random_bits(random);
        lit->arrives[i] = (uint8_t)random_below(random, 2);
        if (random_below(random, 2) == 0) lit->point[lit->count++] = (uint32_t)i;
    }
}

static void check_shadows(const GiKernel *kernel, Streams *s, Random *random) {
    GiBundle *bundle = &s->bundle;
    const GiPoints *points = &s->points;
    const GiLit *lit = &s->lit;
    uint16_t order[2 * COUNT];
    if (lit->count == 0) return;
    bool sorted = random_below(random, 2);
    for (int i = 0; i < lit->count; i++) {
        order[i] = (uint16_t)(sorted ? i : random_below(random, lit->count));
    }
    bundle->count = 1 + random_below(random, lit->count);
    bundle->apex = random_vec(random, -9, 9);
    kernel->shadows(points, lit, order, bundle);
    for (int i = 0; i < bundle->count; i++) {
        int point = (int)lit->point[order[i]];
        CHECK_INT(bundle->pixel[i], point);
        GiVec p = vec_at(points->px, points->py, points->pz, point);
        CHECK(same(vec_at(bundle->ox, bundle->oy, bundle->oz, i), p));
        CHECK(bundle->t_min[i] == lit->t_min[point]);
        CHECK_INT(bundle->skip[i], lit->skip[point]);
        CHECK_INT(bundle->skip_instance[i], points->skip_instance[point]);
    }
}

static void check_add(const GiKernel *kernel, Streams *s) {
    GiPoints *points = &s->points;
    const GiLit *lit = &s->lit;
    GiVec expected[2 * COUNT];
    for (int i = 0; i < points->count; i++) {
        expected[i] = vec_at(points->red, points->green, points->blue, i);
        if (lit->arrives[i] == 0) continue;
        expected[i] = gi_add(expected[i], vec_at(lit->red, lit->green, lit->blue, i));
    }
    kernel->add(lit, points);
    for (int i = 0; i < points->count; i++) {
        CHECK(same(vec_at(points->red, points->green, points->blue, i), expected[i]));
    }
}

/* ---------------------------------------------------------------- own shadows */

/* Solids of all sizes, some far from where coordinates begin. */
static void fill_far_solids(Solids *solids, Random *random) {
    for (int i = 0; i < SHAPES; i++) {
        double scale = pow(10, random_real(random, -6, 3));
        GiVec c = gi_scale(random_vec(random, -1, 1), pow(10, random_real(random, -3, 3)));
        GiVec size = gi_scale(random_vec(random, 0.1, 3), scale);
        solids->spheres[i] = (GiSphere){c, size.x};
        solids->boxes[i] = (GiBox){gi_sub(c, size), gi_add(c, size)};
        double slope = random_below(random, 3) ? random_real(random, -2, 2) : 0;
        double radius = random_below(random, 2) ? fabs(slope) * size.z : size.x;
        solids->cones[i] = (GiCone){c, radius, slope, size.z};
    }
    solids->shapes =
        (GiShapes){.spheres = solids->spheres, .boxes = solids->boxes, .cones = solids->cones};
}

/* A ray from about the solid to near its centre. */
static void put_near_ray(GiBundle *bundle, Random *random, const Solids *solids, GiShapeRef ref) {
    GiBox box = gi_shape_bounds(&solids->shapes, ref, GI_SHAPE_NONE);
    GiVec c = gi_scale(gi_add(box.low, box.high), 0.5), half = gi_sub(box.high, c);
    int i = bundle->count;
    for (;;) {
        GiVec o = gi_add(c, gi_multiply(half, random_vec(random, -3, 3)));
        GiVec d = gi_normalize(gi_sub(gi_add(c, gi_multiply(half, random_vec(random, -1, 1))), o));
        const gi_hit_Ray ray = gi_hit_ray(o.x, o.y, o.z, d.x, d.y, d.z);
        if (!gi_hit_shape(&solids->shapes, ref, &ray, 0, INFINITY, &bundle->t[i])) continue;
        bundle->ox[i] = o.x, bundle->oy[i] = o.y, bundle->oz[i] = o.z;
        bundle->dx[i] = d.x, bundle->dy[i] = d.y, bundle->dz[i] = d.z;
        bundle->shape[i] = ref.bits;
        bundle->pixel[i] = 0;
        bundle->count++;
        return;
    }
}

/* A light that the point sees at a slant, down to where it is nearly behind the horizon. */
static GiVec slanting_light(Random *random, GiVec p, GiVec n, double error) {
    double cosine = pow(10, random_real(random, -6, 0));
    GiVec side = gi_normalize(gi_cross(n, random_vec(random, -1, 1)));
    GiVec l = gi_add(gi_scale(n, cosine), gi_scale(side, sqrt(1 - cosine * cosine)));
    return gi_along(p, l, error * pow(10, random_real(random, 3, 14)));
}

/* Points whose own shape a shadow ray need not be tested against: it does not meet it. Returns how
 * many there are. */
static int check_own(const GiKernel *kernel, Streams *s, Random *random, GiShapeKind kind) {
    Solids solids;
    fill_far_solids(&solids, random);
    GiBundle *bundle = &s->bundle;
    GiPoints *points = &s->points;
    uint32_t rays[COUNT];
    bundle->count = points->count = 0;
    bundle->own = true;
    for (int i = 0; i < COUNT; i++) {
        uint32_t index = (uint32_t)random_below(random, SHAPES);
        put_near_ray(bundle, random, &solids, gi_shape_ref(kind, index));
        rays[i] = (uint32_t)i;
    }
    kernel->points(&solids.shapes, bundle, rays, COUNT, GI_OWN_MET, false, points);
    int clear = 0;
    for (int i = 0; i < COUNT; i++) {
        GiVec p = vec_at(points->px, points->py, points->pz, i);
        GiVec n = vec_at(points->nx, points->ny, points->nz, i);
        const GiPointLight light = {.position = slanting_light(random, p, n, points->error[i]),
            .intensity = gi_vec(1, 1, 1)};
        const GiGloss gloss = {.diffuse = gi_vec(1, 1, 1),
            .diffuse_factor = 1,
            .away = random_below(random, 2) ? points->error[i] * pow(10, random_real(random, -6, 1))
                                            : 0};
        s->lit.count = 0;
        kernel->light(points, i, i + 1, &light, &gloss, &s->lit);
        CHECK_INT(points->own[i], bundle->shape[i]);
        if (s->lit.count == 0 || s->lit.skip[i] == GI_SHAPE_NONE) continue;
        CHECK_INT(s->lit.skip[i], bundle->shape[i]);
        GiVec d = gi_sub(light.position, p);
        const gi_hit_Ray ray = gi_hit_ray(p.x, p.y, p.z, d.x, d.y, d.z);
        double t;
        CHECK(!gi_hit_shape(
            &solids.shapes, (GiShapeRef){bundle->shape[i]}, &ray, s->lit.t_min[i], INFINITY, &t));
        clear++;
    }
    return clear;
}

static void own_shape_is_clear(void) {
    Streams *s = aligned_alloc(64, (sizeof *s + 63) / 64 * 64);
    CHECK(s != NULL);
    if (s == NULL) return;
    memset(s, 0, sizeof *s);
    const GiShapeKind kinds[] = {GI_SHAPE_SPHERE, GI_SHAPE_BOX, GI_SHAPE_CONE};
    const GiKernel *kernel;
    for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
        Random random = {32};
        int clear[3] = {0, 0, 0};
        for (int i = 0; i < 600; i++) clear[i % 3] += check_own(kernel, s, &random, kinds[i % 3]);
        for (int i = 0; i < 3; i++) CHECK(clear[i] > 200 * COUNT / 16);
    }
    free(s);
}

/* ---------------------------------------------------------------- colours */

static void check_colors(const GiKernel *kernel, Random *random) {
    static const int samples[] = {1, 4, 9, 16, 25, 64};
    GiVec sums[COUNT];
    float colors[3 * COUNT + 1];
    int count = 1 + random_below(random, COUNT), n = samples[random_below(random, 6)];
    double exposure = random_below(random, 2) ? 1 : random_real(random, 0, 3);
    for (int i = 0; i < count; i++) {
        sums[i] = random_below(random, 8) ? random_vec(random, -2, 9) : gi_vec(0, -0.0, 1e30);
    }
    colors[3 * count] = 7; /* another's */
    kernel->colors(sums, count, n, exposure, colors);
    for (int i = 0; i < 3 * count; i++) {
        float expected = (float)((&sums[0].x)[i] / n * exposure + 0.0);
        CHECK(memcmp(&colors[i], &expected, sizeof expected) == 0);
    }
    CHECK(colors[3 * count] == 7);
}

/* ---------------------------------------------------------------- all kernels */

static void kernels_agree(void) {
    Streams *s = aligned_alloc(64, (sizeof *s + 63) / 64 * 64);
    CHECK(s != NULL);
    if (s == NULL) return;
    memset(s, 0, sizeof *s);
    const GiShapeKind kinds[] = {GI_SHAPE_SPHERE, GI_SHAPE_BOX, GI_SHAPE_CONE, GI_SHAPE_TRIANGLE};
    const GiKernel *kernel;
    for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
        Random random = {31};
        for (int i = 0; i < 300; i++) {
            check_view(kernel, s, &random, i % 2 == 0);
            if (i % 8 == 0) check_group(kernel, &random);
            check_points(kernel, s, &random, kinds[i % 4], i % 2 == 0);
            fill_lit(s, &random);
            check_shadows(kernel, s, &random);
            check_add(kernel, s);
            check_colors(kernel, &random);
        }
    }
    free(s);
}

const GiTest tests_stream[] = {TEST(kernels_agree), TEST(own_shape_is_clear), TEST_END};
