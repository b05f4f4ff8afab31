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
enum {
    HELIX_SIZE = 64,
    TREE_SIZE = 200,
    GROUND_SHADER = 8,
    GLASS_SHADER = 9,
    RED_SHADER = 11,
    GREEN_SHADER = 12,
    WHITE_SHADER = 13
};

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

static SampleSurface slab_surface(SampleKind kind, uint64_t count, uint64_t index) {
    Random random = stream((uint64_t)kind, index);
    double size = millionth(mean_radius(count) * uniform(&random, 0.5, 1.5));
    double reach = kind == SAMPLE_SOLIDS ? 1.5 * size : size;
    SampleSurface surface = {glint_surface_desc_default(GLINT_SURFACE_SPHERE), 0, -1};
    GlintSurfaceDesc *desc = &surface.desc;
    desc->radius = size;
    desc->center[0] = millionth(uniform(&random, -slab_half, slab_half));
    desc->center[1] = millionth(uniform(&random, -slab_half, slab_half));
    desc->center[2] = millionth(uniform(&random, reach, slab_height - reach));
    surface.shader_index = below(&random, GROUND_SHADER);
    if (kind == SAMPLE_GLASS && index % 2 == 0) surface.shader_index = GLASS_SHADER;
    if (kind == SAMPLE_GLASS && index % 4 == 0) surface.shader_index = GLASS_SHADER + 1;
    if (kind != SAMPLE_SOLIDS) return surface;

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

/* One helix a cell of a square lattice. */
static SampleGroup helix_group(const Sample *sample, uint64_t index) {
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

/* ---------------------------------------------------------------- forest */

/* A tree of height 1: a trunk, and leaves and cones on a spiral round it. */
static SampleSurface tree_surface(uint64_t index) {
    SampleSurface surface = {glint_surface_desc_default(GLINT_SURFACE_CYLINDER), 5, 0};
    GlintSurfaceDesc *desc = &surface.desc;
    double share = (double)index / TREE_SIZE, turn = 2.399963 * (double)index;
    double reach = index == 0 ? 0 : 0.02 + 0.3 * (1 - share);
    desc->center[0] = millionth(reach * cos(turn));
    desc->center[1] = millionth(reach * sin(turn));
    desc->center[2] = millionth(index == 0 ? 0.45 : 0.2 + 0.75 * share);
    desc->radius = 0.03;
    desc->height = 0.9;
    if (index == 0) return surface;
    surface.shader_index = index % 3 == 0 ? 7 : 3;
    desc->type = index % 2 ? GLINT_SURFACE_SPHERE : GLINT_SURFACE_CONE;
    desc->height = 0.08;
    desc->tip_z = millionth(desc->center[2] + 0.04);
    return surface;
}

static double tree_height(const Sample *sample) {
    return millionth(1.6 * 2 * slab_half / ceil(sqrt((double)sample->count)));
}

static SampleGroup tree_copy(const Sample *sample, uint64_t index) {
    uint64_t side = (uint64_t)ceil(sqrt((double)sample->count));
    double cell = 2 * slab_half / (double)side;
    Random random = stream((uint64_t)sample->kind, index);
    SampleGroup copy = {{0}, {0}, {0}};
    copy.rotate[2] = below(&random, 360);
    double size = millionth(uniform(&random, 0.6, 1.3));
    for (int i = 0; i < 3; i++) copy.scale[i] = size;
    double x = uniform(&random, 0.2, 0.8);
    double y = uniform(&random, 0.2, 0.8);
    copy.translate[0] = millionth(cell * ((double)(index % side) + x) - slab_half);
    copy.translate[1] = millionth(cell * ((double)(index / side) + y) - slab_half);
    return copy;
}

/* ---------------------------------------------------------------- mixed */

/* First the mesh, which is a quarter, then half of the solids, an eighth of helices, and the tree,
 * copies of which are the rest. */
static Sample mixed_part(const Sample *sample, SampleKind kind) {
    uint64_t count = sample->count;
    Sample part = {kind, count / 2, sample->width, sample->height};
    if (kind == SAMPLE_HELICES) part.count = (count / 8 / HELIX_SIZE + 1) * HELIX_SIZE;
    if (kind == SAMPLE_FOREST) part.count = count / 8 / TREE_SIZE + 2;
    return part;
}

static SampleSurface mixed_surface(const Sample *sample, uint64_t index) {
    Sample solids = mixed_part(sample, SAMPLE_SOLIDS);
    Sample helices = mixed_part(sample, SAMPLE_HELICES);
    if (index-- == 0) {
        return (SampleSurface){glint_surface_desc_default(GLINT_SURFACE_MESH), 2, -1};
    }
    if (index < solids.count) return slab_surface(SAMPLE_SOLIDS, solids.count, index);
    index -= solids.count;
    if (index < helices.count) return helix_surface(index);
    SampleSurface surface = tree_surface(index - helices.count);
    surface.group_index = (int64_t)sample_group_count(&helices);
    return surface;
}

static uint64_t mixed_surface_count(const Sample *sample) {
    return 2 + mixed_part(sample, SAMPLE_SOLIDS).count + mixed_part(sample, SAMPLE_HELICES).count +
           TREE_SIZE;
}

/* ---------------------------------------------------------------- tiny and room */

typedef struct Solid {
    GlintSurfaceType type;
    double center[3], radius, height, tip_z;
} Solid;

static SampleSurface solid_surface(const Solid *solid, int shader) {
    SampleSurface surface = {glint_surface_desc_default(solid->type), shader, -1};
    GlintSurfaceDesc *desc = &surface.desc;
    memcpy(desc->center, solid->center, sizeof desc->center);
    desc->radius = solid->radius;
    desc->height = solid->height;
    desc->tip_z = solid->tip_z;
    if (desc->type == GLINT_SURFACE_BOX) {
        put_box(desc, desc->center, desc->radius, desc->radius, desc->radius);
    }
    return surface;
}

static const Solid tiny_solids[] = {
    {GLINT_SURFACE_SPHERE, {-1.6, 0.2, 0.9}, 0.9, 1, 0},
    {GLINT_SURFACE_SPHERE, {0.3, -1.8, 0.4}, 0.4, 1, 0},
    {GLINT_SURFACE_BOX, {1.7, 1.2, 0.7}, 0.7, 1, 0},
    {GLINT_SURFACE_CYLINDER, {0.2, 1.4, 1.0}, 0.5, 2, 0},
    {GLINT_SURFACE_CONE, {1.5, -0.8, 0.6}, 0.45, 1.2, 2.1},
    {GLINT_SURFACE_CONE, {-0.9, -1.5, 0.5}, 0.3, 1, 1},
};
enum { TINY_SIZE = sizeof tiny_solids / sizeof tiny_solids[0] };

/* The inside is 4 x 4 x 4, open towards the camera; the floor is the ground. Two blocks, turned,
 * and a ball. */
static const double room_walls[][6] = {
    {-2.1, -2, 4, 2.1, 2.1, 4.1},
    {-2.1, 2, 0, 2.1, 2.1, 4},
    {-2.1, -2, 0, -2, 2, 4},
    {2, -2, 0, 2.1, 2, 4},
    {-0.6, -0.6, 0, 0.6, 0.6, 2.4},
    {-0.55, -0.55, 0, 0.55, 0.55, 1.1},
};
static const int room_shaders[] = {
    WHITE_SHADER, WHITE_SHADER, RED_SHADER, GREEN_SHADER, WHITE_SHADER, WHITE_SHADER};
static const SampleGroup room_groups[] = {
    {{-0.75, 0.7, 0}, {0, 0, -17}, {1, 1, 1}},
    {{0.8, -0.5, 0}, {0, 0, 16}, {1, 1, 1}},
};
enum { WALL_COUNT = 4, ROOM_SIZE = sizeof room_walls / sizeof room_walls[0] };

static SampleSurface room_surface(uint64_t index) {
    SampleSurface surface = {
        glint_surface_desc_default(GLINT_SURFACE_BOX), room_shaders[index], -1};
    memcpy(surface.desc.point_a, &room_walls[index][0], sizeof surface.desc.point_a);
    memcpy(surface.desc.point_b, &room_walls[index][3], sizeof surface.desc.point_b);
    if (index >= WALL_COUNT) surface.group_index = (int64_t)index - WALL_COUNT;
    return surface;
}

/* ---------------------------------------------------------------- all */

static SampleSurface ground(const Sample *sample) {
    SampleSurface surface = {glint_surface_desc_default(GLINT_SURFACE_BOX), GROUND_SHADER, -1};
    double half = slab_half + 1;
    if (sample->kind == SAMPLE_TINY) half = 4;
    if (sample->kind == SAMPLE_SHADOW || sample->kind == SAMPLE_SKY) half = 4;
    if (sample->kind == SAMPLE_ROOM) half = 2.1;
    put_box(&surface.desc, (const double[3]){0, 0, -0.25}, half, half, 0.25);
    return surface;
}

uint64_t sample_surface_count(const Sample *sample) {
    switch (sample->kind) {
    case SAMPLE_TINY:
    case SAMPLE_SHADOW:
    case SAMPLE_SKY: return 1 + TINY_SIZE;
    case SAMPLE_TORUS: return 2;
    case SAMPLE_FOREST: return 1 + TREE_SIZE;
    case SAMPLE_LIGHTS: return 1 + 10000;
    case SAMPLE_MIXED: return mixed_surface_count(sample);
    case SAMPLE_ROOM: return 1 + ROOM_SIZE;
    default: return 1 + sample->count;
    }
}

uint64_t sample_drawn_count(const Sample *sample) {
    uint64_t count = sample_surface_count(sample) + TREE_SIZE * sample_copy_count(sample);
    uint64_t triangle_count = sample_triangle_count(sample);
    return triangle_count > 0 ? count - 1 + triangle_count : count;
}

SampleSurface sample_surface(const Sample *sample, uint64_t index) {
    if (index == 0) return ground(sample);
    index--;
    switch (sample->kind) {
    case SAMPLE_HELICES: return helix_surface(index);
    case SAMPLE_TINY:
    case SAMPLE_SHADOW:
    case SAMPLE_SKY: return solid_surface(&tiny_solids[index], (int)index);
    case SAMPLE_TORUS:
        return (SampleSurface){glint_surface_desc_default(GLINT_SURFACE_MESH), 2, -1};
    case SAMPLE_FOREST: return tree_surface(index);
    case SAMPLE_LIGHTS: return slab_surface(SAMPLE_SOLIDS, 10000, index);
    case SAMPLE_MIXED: return mixed_surface(sample, index);
    case SAMPLE_ROOM: return room_surface(index);
    default: return slab_surface(sample->kind, sample->count, index);
    }
}

uint64_t sample_group_count(const Sample *sample) {
    Sample part;
    switch (sample->kind) {
    case SAMPLE_HELICES: return (sample->count + HELIX_SIZE - 1) / HELIX_SIZE;
    case SAMPLE_FOREST: return 1;
    case SAMPLE_MIXED:
        part = mixed_part(sample, SAMPLE_HELICES);
        return part.count / HELIX_SIZE + 1;
    case SAMPLE_ROOM: return ROOM_SIZE - WALL_COUNT;
    default: return 0;
    }
}

static SampleGroup tree_group(const Sample *sample, double tallest) {
    double height = fmin(tree_height(sample), tallest);
    return (SampleGroup){{0, 0, 0}, {0, 0, 0}, {height, height, height}};
}

SampleGroup sample_group(const Sample *sample, uint64_t index) {
    Sample helices = mixed_part(sample, SAMPLE_HELICES);
    Sample forest = mixed_part(sample, SAMPLE_FOREST);
    switch (sample->kind) {
    case SAMPLE_HELICES: return helix_group(sample, index);
    case SAMPLE_ROOM: return room_groups[index];
    case SAMPLE_MIXED:
        return index < sample_group_count(&helices) ? helix_group(&helices, index)
                                                    : tree_group(&forest, 2);
    default: return tree_group(sample, INFINITY);
    }
}

/* The group itself is the first of the forest's trees. */
uint64_t sample_copy_count(const Sample *sample) {
    Sample forest = mixed_part(sample, SAMPLE_FOREST);
    if (sample->kind == SAMPLE_MIXED) return forest.count - 1;
    return sample->kind == SAMPLE_FOREST ? sample->count - 1 : 0;
}

SampleGroup sample_copy(const Sample *sample, uint64_t index) {
    Sample forest = mixed_part(sample, SAMPLE_FOREST);
    return tree_copy(sample->kind == SAMPLE_MIXED ? &forest : sample, index);
}
