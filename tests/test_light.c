/* SPDX-License-Identifier: MIT
 * Cube maps: reading, lookup against the table of the format, sampling against integrals and
 * counts. Rectangles of light against the solid angle they fill. */
#include "kernel/kernel.h"
#include "light/environment.h"
#include "light/rectangle.h"
#include "pictures.h"
#include "random.h"
#include "sample/sampler.h"
#include "test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* ---------------------------------------------------------------- maps to work with */

/* Every texel other; the unused squares are full of NaN, and parts are black. */
static GiEnvironment make_map(int face, uint64_t seed) {
    size_t count = 12 * (size_t)face * (size_t)face;
    GiEnvironment map = {.face = face, .scale = 1.5};
    Random random = {seed};
    map.pixels = malloc(3 * count * sizeof(float));
    for (size_t i = 0; i < count; i++) {
        size_t column = i % (3 * (size_t)face) / (size_t)face;
        size_t row = i / (3 * (size_t)face) / (size_t)face;
        bool used = column == 1 || row == 2, black = random_below(&random, 4) == 0;
        double size = random_below(&random, 10) == 0 ? 20 : 1;
        for (size_t k = 0; k < 3; k++) {
            double value = random_real(&random, 0, size);
            map.pixels[3 * i + k] = used ? black ? 0 : (float)value : NAN;
        }
    }
    return map;
}

static GiEnvironment make_constant(int face, float value) {
    GiEnvironment map = {.face = face, .scale = 1};
    size_t count = 36 * (size_t)face * (size_t)face;
    map.pixels = malloc(count * sizeof(float));
    for (size_t i = 0; i < count; i++) map.pixels[i] = value;
    return map;
}

static GiVec random_direction(Random *random) {
    for (;;) {
        GiVec d = random_vec(random, -1, 1);
        if (gi_length(d) > 0.1 && gi_length(d) < 1) return gi_normalize(d);
    }
}

/* ---------------------------------------------------------------- lookup */

/* The table of the format, written down a second time. */
static GiVec look_up(const GiEnvironment *map, GiVec d) {
    double ax = fabs(d.x), ay = fabs(d.y), az = fabs(d.z), u, v;
    int column, row, b = map->face;
    if (ax > ay && ax > az) {
        u = d.z / d.x, v = d.y / ax, column = d.x > 0 ? 2 : 0, row = 2;
    } else if (ay > az) {
        u = d.x / ay, v = d.z / d.y, column = 1, row = d.y > 0 ? 3 : 1;
    } else {
        u = d.x / az, v = -d.y / d.z, column = 1, row = d.z > 0 ? 0 : 2;
    }
    int x = (int)(b * (u + 1) / 2), y = (int)(b * (v + 1) / 2);
    x = column * b + (x < b ? x : b - 1);
    y = row * b + (y < b ? y : b - 1);
    const float *rgb = map->pixels + 3 * (y * 3 * b + x);
    return gi_vec(
        map->scale * (double)rgb[0], map->scale * (double)rgb[1], map->scale * (double)rgb[2]);
}

static bool same(GiVec a, GiVec b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

static void environment_lookup(void) {
    static const int sizes[] = {1, 2, 7, 64};
    for (int i = 0; i < 4; i++) {
        GiEnvironment map = make_map(sizes[i], 3);
        Random random = {5};
        for (int k = 0; k < 100000; k++) {
            GiVec d = gi_scale(random_direction(&random), random_real(&random, 0.1, 10));
            CHECK(same(gi_environment_radiance(&map, d), look_up(&map, d)));
        }
        /* Axes, edges and corners: somewhere on the cube, and never outside of it. */
        for (int k = 0; k < 27; k++) {
            GiVec d = gi_vec(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            if (gi_vec_is_zero(d)) continue;
            CHECK(same(gi_environment_radiance(&map, d), look_up(&map, d)));
            CHECK(isfinite(gi_environment_radiance(&map, d).x));
        }
        free(map.pixels);
    }
}

/* ---------------------------------------------------------------- sampling */

/* The integral of f over the sphere: the rule of midpoints in height and angle. */
typedef double (*OnSphereFn)(const GiEnvironmentSampler *sampler, GiVec direction);

static double integrate(const GiEnvironmentSampler *sampler, OnSphereFn f) {
    enum { COUNT = 1500 };
    double sum = 0;
    for (int i = 0; i < COUNT; i++) {
        double z = (2.0 * i + 1) / COUNT - 1, radius = sqrt(1 - z * z);
        for (int k = 0; k < COUNT; k++) {
            double angle = 2 * pi * (k + 0.5) / COUNT;
            sum += f(sampler, gi_vec(radius * cos(angle), radius * sin(angle), z));
        }
    }
    return sum * 4 * pi / COUNT / COUNT;
}

static double density(const GiEnvironmentSampler *sampler, GiVec d) {
    return gi_environment_density(sampler, d);
}
/* Radiance times something that is not even over a texel. */
static double slope(GiVec d) { return 1.5 + d.x - 0.5 * d.y * d.z; }
static double sloped_light(const GiEnvironmentSampler *sampler, GiVec d) {
    return gi_environment_radiance(sampler->environment, d).y * slope(d);
}

static void environment_density(void) {
    static const int sizes[] = {1, 2, 5};
    for (int i = 0; i < 3; i++) {
        GiMemory memory;
        gi_memory_init(&memory, NULL, 0);
        GiEnvironment map = make_map(sizes[i], 10);
        GiEnvironmentSampler sampler;
        CHECK(gi_environment_sampler_init(&sampler, &memory, &map));
        CHECK_NEAR(integrate(&sampler, density), 1, 1e-3);
        double truth = integrate(&sampler, sloped_light), mean = 0;
        enum { COUNT = 1 << 16 };
        for (uint32_t k = 0; k < COUNT; k++) {
            GiSampler numbers = gi_sampler(1, 1, k);
            double u[2];
            gi_sample_2d(&numbers, 0, u);
            GiVec direction, radiance;
            double p = gi_environment_sample(&sampler, u, &direction, &radiance);
            CHECK(p > 0);
            CHECK_NEAR(gi_length(direction), 1, 1e-15);
            mean += radiance.y * slope(direction) / p / COUNT;
            /* Next to an edge the direction, rounded, may look up the neighbour. */
            if (same(radiance, gi_environment_radiance(&map, direction))) {
                CHECK_NEAR(gi_environment_density(&sampler, direction) / p, 1, 1e-12);
            }
        }
        CHECK_NEAR(mean / truth, 1, 2e-3);
        gi_environment_sampler_reset(&sampler, &memory);
        CHECK_INT(memory.used, 0);
        free(map.pixels);
    }
}

/* Directions fall into texels as often as the density, integrated over the texel, says. */
static void environment_counts(void) {
    enum { FACE = 3, COUNT = 200000, FINE = 20, TEXELS = 12 * FACE * FACE };
    static int counts[TEXELS];
    static double expected[TEXELS];
    memset(counts, 0, sizeof counts);
    memset(expected, 0, sizeof expected);
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    GiEnvironment map = make_map(FACE, 22), places = make_constant(FACE, 0);
    for (int i = 0; i < 3 * TEXELS; i++) places.pixels[i] = (float)(i / 3);
    GiEnvironmentSampler sampler;
    CHECK(gi_environment_sampler_init(&sampler, &memory, &map));
    for (uint32_t i = 0; i < COUNT; i++) {
        GiSampler numbers = gi_sampler_independent(i, 0, 0);
        double u[2];
        gi_sample_2d(&numbers, 0, u);
        GiVec direction, radiance;
        gi_environment_sample(&sampler, u, &direction, &radiance);
        counts[(int)gi_environment_radiance(&places, direction).x]++;
    }
    enum { GRID = 900 };
    for (int i = 0; i < GRID; i++) {
        double z = (2.0 * i + 1) / GRID - 1, radius = sqrt(1 - z * z);
        for (int k = 0; k < GRID; k++) {
            double angle = 2 * pi * (k + 0.5) / GRID;
            GiVec d = gi_vec(radius * cos(angle), radius * sin(angle), z);
            expected[(int)gi_environment_radiance(&places, d).x] +=
                gi_environment_density(&sampler, d) * 4 * pi / GRID / GRID;
        }
    }
    double sum = 0;
    int used = 0;
    for (int i = 0; i < TEXELS; i++) {
        double off = counts[i] - expected[i] * COUNT;
        if (expected[i] == 0) {
            CHECK_INT(counts[i], 0);
        } else {
            sum += off * off / (expected[i] * COUNT);
            used++;
        }
    }
    CHECK(used > 30);
    CHECK(sum / (used - 1) < 1 + 6 * sqrt(2.0 / (used - 1)));
    gi_environment_sampler_reset(&sampler, &memory);
    free(map.pixels);
    free(places.pixels);
}

/* The last part that begins with no more than the fraction u of the whole. */
static size_t search(const double *sums, size_t count, double u) {
    size_t part = 0;
    for (size_t i = 1; i < count; i++) part = sums[i] <= u * sums[count] ? i : part;
    return part;
}

/* Next to the sums' own steps, too, the texel is the one that a plain search finds. */
static void environment_choice(void) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    Random random = {31};
    for (int face = 1; face <= 40; face += 13) {
        GiEnvironment map = make_map(face, 77);
        /* Most of it from one texel of the third face, below rows that are black. */
        size_t wide = 3 * (size_t)face, side = (size_t)face;
        map.pixels[3 * (3 * side * wide + side)] = 1e5f;
        for (size_t i = 0; i < side * wide * 3; i++) map.pixels[2 * side * wide * 3 + i] = 0;
        GiEnvironmentSampler sampler;
        CHECK(gi_environment_sampler_init(&sampler, &memory, &map));
        for (int k = 0; k < 20000; k++) {
            double u[2] = {random_real(&random, 0, 1), random_real(&random, 0, 1)};
            size_t row = search(sampler.rows, 6 * side, u[0]);
            const double *sums = sampler.columns + row * (side + 1);
            if (k % 3 == 0) u[0] = sampler.rows[row] / sampler.rows[6 * side];
            if (k % 5 == 0) u[1] = sums[random_below(&random, face)] / sums[side];
            for (int i = 0; i < 2; i++) u[i] = floor(u[i] * 0x1p32) * 0x1p-32;
            if (u[0] == 1 || u[1] == 1) continue;
            row = search(sampler.rows, 6 * side, u[0]);
            sums = sampler.columns + row * (side + 1);
            size_t column = search(sums, side, u[1]);
            GiVec direction, radiance;
            double p = gi_environment_sample(&sampler, u, &direction, &radiance);
            static const size_t columns[] = {2, 0, 1, 1, 1, 1}, rows[] = {2, 2, 3, 1, 0, 2};
            size_t x = columns[row / side] * side + column;
            size_t y = rows[row / side] * side + row % side;
            const float *rgb = map.pixels + 3 * (y * wide + x);
            CHECK(p > 0);
            CHECK(radiance.x == map.scale * (double)rgb[0]);
            CHECK(radiance.y == map.scale * (double)rgb[1]);
        }
        gi_environment_sampler_reset(&sampler, &memory);
        free(map.pixels);
    }
    CHECK_INT(memory.used, 0);
}

static void environment_constant_and_black(void) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    for (int face = 1; face <= 16; face *= 4) {
        GiEnvironment map = make_constant(face, 2), black = make_constant(face, 0);
        GiEnvironmentSampler sampler;
        CHECK(gi_environment_sampler_init(&sampler, &memory, &map));
        double u[2] = {0.3, 1 - 0x1p-32};
        GiVec direction, radiance;
        double p = gi_environment_sample(&sampler, u, &direction, &radiance);
        CHECK(p > 0 && radiance.x == 2);
        if (face == 16) CHECK_NEAR(p, 1 / (4 * pi), 0.01); /* nearly even, with small texels */
        gi_environment_sampler_reset(&sampler, &memory);
        CHECK(gi_environment_sampler_init(&sampler, &memory, &black));
        CHECK(gi_environment_sample(&sampler, u, &direction, &radiance) == 0);
        CHECK(gi_environment_density(&sampler, gi_vec(0.6, 0.8, 0)) == 0);
        gi_environment_sampler_reset(&sampler, &memory);
        free(map.pixels);
        free(black.pixels);
    }
    GiEnvironment big = make_constant(8, 1);
    gi_memory_init(&memory, NULL, 1000);
    GiEnvironmentSampler sampler;
    CHECK(!gi_environment_sampler_init(&sampler, &memory, &big));
    CHECK_INT(memory.used, 0);
    free(big.pixels);
}

/* ---------------------------------------------------------------- reading */

static const char *write_map(const char *head, const void *data, size_t size) {
    static char path[600];
    snprintf(path, sizeof path, "%s/map.pfm", test_scratch_dir());
    FILE *file = fopen(path, "wb");
    fwrite(head, 1, strlen(head), file);
    fwrite(data, 1, size, file);
    fclose(file);
    return path;
}

static void check_refused(const char *head, const void *data, size_t size, const char *reason) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    GiEnvironment map;
    GlintError error = {0};
    const char *path = write_map(head, data, size);
    CHECK_INT(gi_environment_load(&map, &memory, path, 1, &error), GLINT_ERROR_FILE);
    if (strstr(error.message, reason) == NULL) CHECK_TEXT(error.message, reason);
    CHECK_TEXT(error.path, path);
    CHECK_INT(map.face, 0);
    CHECK_INT(memory.used, 0);
    CHECK(memory.peak <= size + 1000);
}

static void environment_load(void) {
    static const char *const heads[] = {"PF\n6 8\n-1.0\n", "PF\n6 8\n1.000000\n",
        "PF\r\n6 8\r\n1\r\n", "PF 6 8 -1.0\n", "PF\n 6\t8 \n nonsense\n"};
    GiEnvironment map = make_map(2, 4);
    size_t size = 36 * 4 * sizeof(float);
    for (int i = 0; i < 5; i++) {
        GiMemory memory;
        gi_memory_init(&memory, NULL, 0);
        GiEnvironment loaded;
        GlintError error = {0};
        const char *path = write_map(heads[i], map.pixels, size);
        CHECK_INT(gi_environment_load(&loaded, &memory, path, 2.5, &error), GLINT_OK);
        CHECK_INT(loaded.face, 2);
        CHECK(loaded.scale == 2.5);
        CHECK(loaded.face == 2 && memcmp(loaded.pixels, map.pixels, size) == 0);
        gi_environment_free(&loaded, &memory);
        CHECK_INT(memory.used, 0);
        gi_memory_init(&memory, NULL, 100);
        CHECK_INT(gi_environment_load(&loaded, &memory, path, 1, &error), GLINT_ERROR_MEMORY);
        CHECK_INT(memory.used, 0);
    }
    free(map.pixels);
}

static void environment_refused(void) {
    GiEnvironment map = make_map(2, 4);
    size_t size = 36 * 4 * sizeof(float);
    check_refused("Pf\n6 8\n-1.0\n", map.pixels, size, "no colour");
    check_refused("P6\n6 8\n255\n", map.pixels, size, "not a PFM");
    check_refused("P", "", 0, "too early");
    check_refused("PF\n", "", 0, "too early");
    check_refused("PF\n6 8\n-1.0\n", map.pixels, size - 1, "too early");
    check_refused("PF\n6 8\n-1.0", "", 0, "too early");
    check_refused("PF\n6 six\n-1.0\n", map.pixels, size, "not a number");
    check_refused("PF\n-6 8\n-1.0\n", map.pixels, size, "not a number");
    check_refused("PF\n6 0\n-1.0\n", map.pixels, size, "zero");
    check_refused("PF\n30000 40000\n-1.0\n", map.pixels, size, "2^28");
    check_refused("PF\n99999999999999999999999999 1\n-1.0\n", map.pixels, size, "2^28");
    check_refused("PF\n12000 16000\n-1.0\n", map.pixels, size, "too early");
    check_refused("PF\n12 4\n-1.0\n", map.pixels, size, "cross");
    check_refused("PF\n4 12\n-1.0\n", map.pixels, size, "cross");
    check_refused("PF\n7 6\n-1.0\n", map.pixels, size, "cross");
    char longer[300];
    memset(longer, '1', sizeof longer);
    memcpy(longer, "PF\n6 8\n", 7);
    longer[sizeof longer - 1] = '\0';
    check_refused(longer, "", 0, "header");
    map.pixels[3 * (2 * 6 * 2 + 1)] = INFINITY; /* second pixel of the third square's row */
    check_refused("PF\n6 8\n-1.0\n", map.pixels, size, "not finite");
    free(map.pixels);
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    GlintError error = {0};
    CHECK_INT(gi_environment_load(&map, &memory, "/nowhere/map.pfm", 1, &error), GLINT_ERROR_FILE);
    CHECK_TEXT(error.path, "/nowhere/map.pfm");
    CHECK_INT(gi_environment_load(&map, &memory, "/", 1, &error), GLINT_ERROR_FILE);
}

/* ---------------------------------------------------------------- rectangles */

static void rectangle_frame(void) {
    GiLightRectangle r;
    CHECK(gi_rectangle_init(
        &r, gi_vec(1, 2, 3), gi_vec(0, 0, -2), gi_vec(0, 5, 1), 4, 6)); /* up leans */
    CHECK(same(r.front, gi_vec(0, 0, -1)));
    CHECK_NEAR(gi_length(gi_sub(r.across, gi_vec(-4, 0, 0))), 0, 1e-15);
    CHECK_NEAR(gi_length(gi_sub(r.upward, gi_vec(0, 6, 0))), 0, 2e-15);
    CHECK(r.area == 24);
    GiVec point;
    double weight = gi_rectangle_sample(&r, gi_vec(1, 2, 1), (double[]){0.5, 0.5}, &point);
    CHECK(same(point, r.center));
    CHECK_NEAR(weight, 6, 1e-15);
    gi_rectangle_sample(&r, gi_vec(1, 2, 1), (double[]){0, 0.75}, &point);
    CHECK_NEAR(gi_length(gi_sub(point, gi_vec(3, 3.5, 3))), 0, 2e-15);
    CHECK(gi_rectangle_sample(&r, gi_vec(1, 2, 4), (double[]){0.5, 0.5}, &point) == 0);
    CHECK(gi_rectangle_density(&r, gi_vec(0, 0, 2)) == 1 / 6.0);
    CHECK(gi_rectangle_density(&r, gi_vec(0, 0, -2)) == 0);
    CHECK(!gi_rectangle_init(&r, gi_vec(0, 0, 0), gi_vec(0, 1, 0), gi_vec(0, -3, 0), 1, 1));
    CHECK(!gi_rectangle_init(&r, gi_vec(0, 0, 0), gi_vec(0, 0, 0), gi_vec(0, 1, 0), 1, 1));
}

/* The factors average to the solid angle; seen from the axis that is 4 asin(...). */
static void rectangle_solid_angle(void) {
    GiLightRectangle r;
    CHECK(gi_rectangle_init(&r, gi_vec(0, 0, 1.5), gi_vec(0, 0, -1), gi_vec(1, 2, 0), 2.4, 0.6));
    enum { COUNT = 1 << 16 };
    double mean = 0, a = 1.2, b = 0.3, d = 1.5;
    for (uint32_t i = 0; i < COUNT; i++) {
        GiSampler numbers = gi_sampler(9, 9, i);
        double u[2];
        gi_sample_2d(&numbers, 2, u);
        GiVec point;
        mean += gi_rectangle_sample(&r, gi_vec(0, 0, 0), u, &point) / COUNT;
    }
    CHECK_NEAR(mean, 4 * asin(a * b / sqrt((a * a + d * d) * (b * b + d * d))), 1e-6);
}

/* The solid angle of a part of the rectangle: the rule of midpoints by area. */
static double part_angle(const GiLightRectangle *r, GiVec from, double s, double t, double size) {
    enum { FINE = 100 };
    double sum = 0;
    for (int i = 0; i < FINE * FINE; i++) {
        GiVec point;
        double u[2] = {
            s + size * (i % FINE + 0.5) / FINE, t + size * ((double)(i / FINE) + 0.5) / FINE};
        sum += gi_rectangle_sample(r, from, u, &point);
    }
    return sum * size * size / FINE / FINE;
}

/* Points by solid angle: as many in each of 8 x 8 parts as its solid angle says. */
static void check_by_angle(const GiLightRectangle *r, GiVec from) {
    enum { SIDE = 8, COUNT = 50000 };
    int counts[SIDE * SIDE] = {0};
    double factor = 0, sum = 0, whole = 0, width = gi_length(r->across);
    double height = gi_length(r->upward);
    for (uint32_t i = 0; i < COUNT; i++) {
        GiSampler numbers = gi_sampler_independent(i, 1, 2);
        double u[2];
        GiVec point;
        gi_sample_2d(&numbers, 2, u);
        factor = gi_rectangle_sample_angle(r, from, u, &point);
        GiVec offset = gi_sub(point, r->center);
        double s = gi_dot(offset, r->across) / (width * width) + 0.5;
        double t = gi_dot(offset, r->upward) / (height * height) + 0.5;
        CHECK_NEAR(gi_dot(offset, r->front), 0, 1e-14 * (gi_length(from) + width + height));
        CHECK(s > -1e-12 && s < 1 + 1e-12 && t > -1e-12 && t < 1 + 1e-12);
        int column = s > 0 ? (int)(s * SIDE) : 0, row = t > 0 ? (int)(t * SIDE) : 0;
        counts[(row < SIDE ? row : SIDE - 1) * SIDE + (column < SIDE ? column : SIDE - 1)]++;
        CHECK_NEAR(gi_rectangle_density_angle(r, from, point) * factor, 1, 1e-9);
    }
    for (int i = 0; i < SIDE * SIDE; i++) {
        double s = i % SIDE / (double)SIDE, t = (double)(i / SIDE) / SIDE;
        double angle = part_angle(r, from, s, t, 1.0 / SIDE), expected = angle / factor * COUNT;
        whole += angle;
        sum += (counts[i] - expected) * (counts[i] - expected) / (expected + 1e-3);
    }
    CHECK_NEAR(factor / whole, 1, 2e-3);
    if (!(sum / 63 < 1 + 6 * sqrt(2.0 / 63))) {
        test_fail(
            __FILE__, __LINE__, "from %g %g %g: chi-square %g", from.x, from.y, from.z, sum / 63);
    }
}

/* A place to look from: near and far, before it and behind, in its plane, at an edge. */
static GiVec random_place(Random *random, const GiLightRectangle *r) {
    double s = random_real(random, -2, 2), t = random_real(random, -2, 2);
    double away = random_real(random, -1, 3);
    if (random_below(random, 4) == 0) s = random_below(random, 3) * 0.5 - 0.5;
    if (random_below(random, 4) == 0) t = random_below(random, 3) * 0.5 - 0.5;
    if (random_below(random, 4) == 0) away = random_tiny(random);
    if (random_below(random, 16) == 0) away = 0;
    if (random_below(random, 8) == 0) away *= 100;
    GiVec place = gi_along(gi_along(r->center, r->across, s), r->upward, t);
    return gi_along(place, r->front, away);
}

static bool equal(double a, double b) { return a == b || (isnan(a) && isnan(b)); }

/* What every kernel draws for points that stand side by side is, to the bit, what is drawn for each
 * of them alone. */
static void rectangle_kernels(void) {
    GiPoints *points = malloc(sizeof *points);
    memset(points, 0, sizeof *points);
    const GiKernel *kernel;
    Random random = {9};
    int by_angle = 0, by_area = 0, unseen = 0;
    for (int round = 0; round < 300; round++) {
        GiLightRectangle r;
        double size = pow(10, random_real(&random, -3, 3));
        CHECK(gi_rectangle_init(&r, random_vec(&random, -3, 3), random_direction(&random),
            random_direction(&random), size, size * random_real(&random, 0.01, 1)));
        GiPairs pairs = {.u = {0}};
        int begin = random_below(&random, 100), count = 1 + random_below(&random, GI_AREA_TOGETHER);
        for (int i = 0; i < count; i++) {
            GiVec from = random_place(&random, &r);
            points->px[begin + i] = from.x, points->py[begin + i] = from.y;
            points->pz[begin + i] = from.z;
            static const double ends[] = {0, 1 - 0x1p-32, 0.5};
            bool end = random_below(&random, 4) == 0;
            pairs.u[i] = end ? ends[random_below(&random, 3)] : random_real(&random, 0, 1);
            pairs.v[i] = end ? ends[random_below(&random, 3)] : random_real(&random, 0, 1);
        }
        for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
            GiAreaBeams to;
            kernel->area(&r, points, begin, count, &pairs, &to);
            for (int i = 0; i < count; i++) {
                GiVec point, from = gi_vec(points->px[begin + i], points->py[begin + i],
                                 points->pz[begin + i]);
                double u[2] = {pairs.u[i], pairs.v[i]};
                double factor = gi_rectangle_sample_angle(&r, from, u, &point);
                GiVec offset = gi_sub(point, from);
                double distance = gi_length(offset);
                GiVec direction = gi_scale(offset, 1 / distance);
                CHECK(equal(to.factor[i], factor) && equal(to.distance[i], distance));
                CHECK(equal(to.dx[i], direction.x) && equal(to.dy[i], direction.y) &&
                      equal(to.dz[i], direction.z));
                CHECK(equal(
                    to.t_max[i], distance - (gi_largest(point) + distance) * GI_SURFACE_ERROR));
                GiVec evenly;
                double other = gi_rectangle_sample(&r, from, u, &evenly);
                *(factor == 0 ? &unseen : factor == other ? &by_area : &by_angle) += 1;
            }
        }
    }
    CHECK(by_angle > 1000 && by_area > 1000 && unseen > 1000);
    free(points);
}

static void rectangle_by_solid_angle(void) {
    static const GiVec places[] = {{0.5, 1, 0}, {3, -2, 1}, {0, 0, 4.9}, {1.9, 2.9, 4.5},
        {-4, 0.1, 4.5}, {0.2, 6, 2}, {7, 7, 4.99}};
    GiLightRectangle r;
    CHECK(gi_rectangle_init(&r, gi_vec(0.5, 1, 5), gi_vec(0, 0, -1), gi_vec(1, 3, 0), 3, 4));
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        if (places[i].z < 4.8) check_by_angle(&r, places[i]);
        GiVec point;
        double u[2] = {0.25, 0.75};
        CHECK(gi_rectangle_sample_angle(&r, places[i], u, &point) > 0);
    }
    GiVec point;
    double edges[][2] = {{0, 0}, {1 - 0x1p-32, 1 - 0x1p-32}, {0, 1 - 0x1p-32}, {0.5, 0}};
    for (int i = 0; i < 4; i++) {
        /* Behind, in the plane, at the middle and at a corner of the rectangle, and far away. */
        CHECK(gi_rectangle_sample_angle(&r, gi_vec(0, 0, 6), edges[i], &point) == 0);
        CHECK(gi_rectangle_sample_angle(&r, gi_vec(9, 9, 5), edges[i], &point) == 0);
        CHECK_NEAR(gi_rectangle_sample_angle(&r, gi_vec(0.5, 1, 5 - 1e-9), edges[i], &point),
            2 * pi, 1e-6);
        CHECK(isfinite(gi_length(point)));
        GiVec corner = gi_along(gi_along(r.center, r.across, 0.5), r.upward, 0.5);
        gi_rectangle_sample_angle(&r, gi_along(corner, r.front, 1e-9), edges[i], &point);
        CHECK(isfinite(gi_length(point)));
        GiVec far = gi_vec(100, 200, -3e4);
        double by_area = gi_rectangle_sample(&r, far, edges[i], &point);
        CHECK(gi_rectangle_sample_angle(&r, far, edges[i], &point) == by_area);
    }
}

const GiTest tests_light[] = {TEST(environment_lookup), TEST(environment_density),
    TEST(environment_counts), TEST(environment_choice), TEST(environment_constant_and_black),
    TEST(environment_load), TEST(environment_refused), TEST(rectangle_frame),
    TEST(rectangle_solid_angle), TEST(rectangle_kernels), TEST(rectangle_by_solid_angle), TEST_END};
