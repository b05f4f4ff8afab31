/* SPDX-License-Identifier: MIT
 * The surfaces. Each draws from a random stream of its own, so they can be asked for in any
 * order.
 *
 *      z  4 +--------------------+    the slab of random surfaces, 20 x 20 x 4
 *           |  o  O    o   0  o  |
 *         0 +--------------------+--+
 *     -0.5  +-----------------------+  the ground, 22 x 22 */
#include "samples/sample.h"

#include <math.h>
#include <string.h>

static const double slab_half = 10, slab_height = 4;
enum { HELIX_SIZE = 64, GROUND_SHADER = SAMPLE_SHADER_COUNT - 1 };

/* ---------------------------------------------------------------- random numbers */

/* splitmix64 (Steele, Lea and Flood 2014). */
typedef struct Random {
    uint64_t state;
} Random;

static uint64_t next(Random *random) {
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Hashed once more, so that neighbours do not draw the same numbers shifted by one. */
static Random stream(uint64_t kind, uint64_t index) {
    Random random = {kind << 60 ^ index};
    random.state = next(&random);
    return random;
}

static double uniform(Random *random, double low, double high) {
    return low + (high - low) * ((double)(next(random) >> 11) * 0x1p-53);
}

static int below(Random *random, int count) {
    return (int)((next(random) >> 32) % (uint64_t)count);
}

static double millionth(double value) { return floor(value * 1e6 + 0.5) / 1e6; }

/* ---------------------------------------------------------------- slab */

/* Shrinks a little slower than what would keep the slab equally deep, so that a larger scene is
 * also a denser one. */
static double mean_radius(uint64_t count) { return 0.3 * pow(1000 / (double)count, 0.4); }

static void put_box(GlintSurfaceDesc *desc, const double center[3], double x, double y, double z) {
    const double half[3] = {x, y, z};
    desc->type = GLINT_SURFACE_BOX;
    for (int i = 0; i < 3; i++) {
        desc->point_a[i] = millionth(center[i] - half[i]);
        desc->point_b[i] = millionth(center[i] + half[i]);
    }
}

static void put_cone(GlintSurfaceDesc *desc, Random *random, double size) {
    desc->type = GLINT_SURFACE_CONE;
    desc->radius = millionth(size * uniform(random, 0.5, 0.9));
    double half = millionth(size * uniform(random, 0.5, 1.3));
    double apex = millionth(half * uniform(random, 1.1, 3.2));
    if (below(random, 4) == 0) apex = half;  /* a full cone */
    if (below(random, 5) == 0) apex = -apex; /* on its head */
    desc->height = 2 * half;
    desc->tip_z = millionth(desc->center[2] + apex);
}

static SampleSurface slab_surface(const Sample *sample, uint64_t index) {
    Random random = stream((uint64_t)sample->kind, index);
    double size = millionth(mean_radius(sample->count) * uniform(&random, 0.5, 1.5));
    double reach = sample->kind == SAMPLE_SOLIDS ? 1.5 * size : size;
    SampleSurface surface = {glint_surface_desc_default(GLINT_SURFACE_SPHERE), 0, -1};
    GlintSurfaceDesc *desc = &surface.desc;
    desc->radius = size;
    desc->center[0] = millionth(uniform(&random, -slab_half, slab_half));
    desc->center[1] = millionth(uniform(&random, -slab_half, slab_half));
    desc->center[2] = millionth(uniform(&random, reach, slab_height - reach));
    surface.shader_index = below(&random, GROUND_SHADER);
    if (sample->kind == SAMPLE_SPHERES) return surface;

    switch (below(&random, 4)) {
    case 0: break;
    case 1: {
        double x = uniform(&random, 0.5, 1.1);
        double y = uniform(&random, 0.5, 1.1);
        double z = uniform(&random, 0.5, 1.1);
        put_box(desc, desc->center, x * size, y * size, z * size);
        break;
    }
    case 2:
        desc->type = GLINT_SURFACE_CYLINDER;
        desc->radius = millionth(size * uniform(&random, 0.5, 0.9));
        desc->height = 2 * millionth(size * uniform(&random, 0.5, 1.3));
        break;
    default: put_cone(desc, &random, size); break;
    }
    return surface;
}

/* ---------------------------------------------------------------- helices */

/* Two strands round the z axis from -1 to 1, half a turn apart. */
static SampleSurface helix_surface(uint64_t index) {
    int atom = (int)(index % HELIX_SIZE), step = atom / 2;
    double turn = 0.6 * step + (atom % 2) * 3.0;
    SampleSurface surface = {
        glint_surface_desc_default(GLINT_SURFACE_SPHERE), 0, (int64_t)(index / HELIX_SIZE)};
    surface.desc.center[0] = millionth(0.4 * cos(turn));
    surface.desc.center[1] = millionth(0.4 * sin(turn));
    surface.desc.center[2] = millionth((2.0 * step + 1) / (HELIX_SIZE / 2) - 1);
    surface.desc.radius = atom % 2 ? 0.13 : 0.1;
    surface.shader_index = (int)((index / HELIX_SIZE + (uint64_t)(atom % 2)) % GROUND_SHADER);
    return surface;
}

uint64_t sample_group_count(const Sample *sample) {
    return sample->kind == SAMPLE_HELICES ? (sample->count + HELIX_SIZE - 1) / HELIX_SIZE : 0;
}

/* One helix a cell of a square lattice. */
SampleGroup sample_group(const Sample *sample, uint64_t index) {
    uint64_t side = (uint64_t)ceil(sqrt((double)sample_group_count(sample)));
    double cell = 2 * slab_half / (double)side, size = fmin(cell, 2);
    Random random = stream((uint64_t)sample->kind, index);
    SampleGroup group;
    for (int i = 0; i < 3; i++) {
        group.rotate[i] = below(&random, 360);
        group.scale[i] = millionth(size * uniform(&random, 0.4, 0.9));
    }
    group.translate[0] = millionth(cell * ((double)(index % side) + 0.5) - slab_half);
    group.translate[1] = millionth(cell * ((double)(index / side) + 0.5) - slab_half);
    group.translate[2] = millionth(uniform(&random, size, fmax(size, slab_height - size)));
    return group;
}

/* ---------------------------------------------------------------- tiny */

static SampleSurface tiny_surface(uint64_t index) {
    static const struct {
        GlintSurfaceType type;
        double center[3], radius, height, tip_z;
    } solids[] = {
        {GLINT_SURFACE_SPHERE, {-1.6, 0.2, 0.9}, 0.9, 1, 0},
        {GLINT_SURFACE_SPHERE, {0.3, -1.8, 0.4}, 0.4, 1, 0},
        {GLINT_SURFACE_BOX, {1.7, 1.2, 0.7}, 0.7, 1, 0},
        {GLINT_SURFACE_CYLINDER, {0.2, 1.4, 1.0}, 0.5, 2, 0},
        {GLINT_SURFACE_CONE, {1.5, -0.8, 0.6}, 0.45, 1.2, 2.1},
        {GLINT_SURFACE_CONE, {-0.9, -1.5, 0.5}, 0.3, 1, 1},
    };
    SampleSurface surface = {glint_surface_desc_default(solids[index].type), (int)index, -1};
    GlintSurfaceDesc *desc = &surface.desc;
    memcpy(desc->center, solids[index].center, sizeof desc->center);
    desc->radius = solids[index].radius;
    desc->height = solids[index].height;
    desc->tip_z = solids[index].tip_z;
    if (desc->type == GLINT_SURFACE_BOX) {
        put_box(desc, desc->center, desc->radius, desc->radius, desc->radius);
    }
    return surface;
}

/* ---------------------------------------------------------------- all */

static SampleSurface ground(const Sample *sample) {
    double half = sample->kind == SAMPLE_TINY ? 4 : slab_half + 1;
    SampleSurface surface = {glint_surface_desc_default(GLINT_SURFACE_BOX), GROUND_SHADER, -1};
    put_box(&surface.desc, (const double[3]){0, 0, -0.25}, half, half, 0.25);
    return surface;
}

uint64_t sample_surface_count(const Sample *sample) {
    return 1 + (sample->kind == SAMPLE_TINY ? 6 : sample->count);
}

SampleSurface sample_surface(const Sample *sample, uint64_t index) {
    if (index == 0) return ground(sample);
    switch (sample->kind) {
    case SAMPLE_HELICES: return helix_surface(index - 1);
    case SAMPLE_TINY: return tiny_surface(index - 1);
    default: return slab_surface(sample, index - 1);
    }
}
