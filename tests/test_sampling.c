/* SPDX-License-Identifier: MIT
 * What gi_bsdf_sample draws: the density it returns is that of gi_bsdf_density, integrates to one,
 * is that of what is drawn, and both ways of integration find the same light. */
#include "shadings.h"
#include "test.h"

#include <string.h>

/* A surface to draw from. */
typedef struct Case {
    const char *what;
    GlintShaderType type;
    GlintDialect year;
    double diffuse, specular, parameter, index; /* parameter: exponent or roughness */
    double degrees;                             /* of the viewer */
} Case;

static const Case cases[] = {
    {"Lambert", GLINT_SHADER_LAMBERTIAN, GLINT_DIALECT_GLINT, 0.7, 0, 1, 1, 30},
    {"Lambert from behind", GLINT_SHADER_LAMBERTIAN, GLINT_DIALECT_GLINT, 0.7, 0, 1, 1, 130},
    {"Phong", GLINT_SHADER_PHONG, GLINT_DIALECT_GLINT, 0.5, 0.5, 20, 1, 45},
    {"Phong, grazing", GLINT_SHADER_PHONG, GLINT_DIALECT_2019, 0.2, 0.8, 50, 1, 80},
    {"Phong below the horizon", GLINT_SHADER_PHONG, GLINT_DIALECT_2013, 0.3, 0.7, 3, 1, 85},
    {"Phong from behind", GLINT_SHADER_PHONG, GLINT_DIALECT_2013, 0.3, 0.7, 3, 1, 110},
    {"Phong, only a highlight", GLINT_SHADER_PHONG, GLINT_DIALECT_GLINT, 0, 1, 0.5, 1, 20},
    {"Beckmann", GLINT_SHADER_BECKMANN, GLINT_DIALECT_GLINT, 0.4, 0.9, 0.3, 1.5, 50},
    {"Beckmann, metal", GLINT_SHADER_BECKMANN, GLINT_DIALECT_2018, 0, 1, 0.5, 9, 20},
    {"Beckmann, grazing", GLINT_SHADER_BECKMANN, GLINT_DIALECT_2019, 0.1, 1, 0.4, 3, 85},
    {"GGX", GLINT_SHADER_GGX, GLINT_DIALECT_GLINT, 0.4, 0.9, 0.3, 1.5, 50},
    {"GGX, from above", GLINT_SHADER_GGX, GLINT_DIALECT_GLINT, 0, 1, 0.4, 1.5, 0},
    {"GGX, metal", GLINT_SHADER_GGX, GLINT_DIALECT_2018, 0, 1, 0.5, 9, 20},
    {"GGX, grazing", GLINT_SHADER_GGX, GLINT_DIALECT_2019, 0.1, 1, 0.4, 3, 85},
    {"GGX, very rough", GLINT_SHADER_GGX, GLINT_DIALECT_2018B, 0.1, 1, 2, 3, 70},
    {"Cook and Torrance", GLINT_SHADER_COOK_TORRANCE, GLINT_DIALECT_2017B, 0.3, 1, 0.3, 2, 40},
    {"Cook and Torrance, metal", GLINT_SHADER_COOK_TORRANCE, GLINT_DIALECT_2017B, 0, 1, 0.5, 9, 75},
    {"Cook and Torrance from behind", GLINT_SHADER_COOK_TORRANCE, GLINT_DIALECT_2017B, 0.3, 1, 0.3,
        2, 120}};
enum { CASES = sizeof cases / sizeof cases[0], DRAWS = 200000 };

static GiShader shader_of(const Case *a_case) {
    double d = a_case->diffuse, s = a_case->specular;
    return (GiShader){.type = a_case->type,
        .diffuse = {d, d, d},
        .specular = {s, s, s},
        .exponent = a_case->parameter,
        .roughness = a_case->parameter,
        .index = a_case->index,
        .texture = GI_NONE,
        .substrate = GI_NONE};
}

static double draw(Random *random, const GiShading *at, GiVec *l) {
    double u[3];
    for (int i = 0; i < 3; i++) u[i] = random_real(random, 0, 1);
    return gi_bsdf_sample(at, u, l);
}

/* ---------------------------------------------------------------- integrals */

/* The density integrates to the part of draws that give a direction, and the estimate of reflected
 * light meets the integral of what is reflected. */
static void check_integrals(const Case *a_case, uint64_t seed) {
    GiShader shader = shader_of(a_case);
    GiShading at = shading_of(&shader, a_case->year, shading_slant(a_case->degrees));
    Random random = {seed};
    double drawn = 0, sum = 0, square = 0;
    for (int i = 0; i < DRAWS; i++) {
        GiVec l;
        double density = draw(&random, &at, &l);
        if (density == 0) continue;
        if (density != gi_bsdf_density(&at, l)) test_fail(__FILE__, __LINE__, "%s", a_case->what);
        double light = gi_bsdf_evaluate(&at, l).x / density;
        drawn++;
        sum += light;
        square += light * light;
    }
    double part = drawn / DRAWS, mean = sum / DRAWS;
    double deviation = sqrt(fmax(0, square / DRAWS - mean * mean) / DRAWS);
    double integral = shading_integral(&at, shading_density, 150);
    double light = shading_integral(&at, shading_evaluate_red, 150);
    double tolerance = 5 * sqrt(part * (1 - part) / DRAWS) + 1e-3;
    if (!(fabs(integral - part) <= tolerance)) {
        test_fail(__FILE__, __LINE__, "%s: the density's integral is %g, %g are drawn",
            a_case->what, integral, part);
    }
    if (!(fabs(mean - light) <= 5 * deviation + 1e-3 * light)) {
        test_fail(__FILE__, __LINE__, "%s: the estimate is %g (+- %g), not %g", a_case->what, mean,
            deviation, light);
    }
    /* The noise of one draw; the estimate of a good lobe hardly varies. */
    if (deviation * sqrt(DRAWS) > 3 * mean) {
        test_fail(__FILE__, __LINE__, "%s: noise %g", a_case->what, deviation * sqrt(DRAWS));
    }
}

static void integrals(void) {
    for (int i = 0; i < CASES; i++) check_integrals(&cases[i], 31 + (uint64_t)i);
}

/* The cosine lobe loses nothing; of GGX seen from above what leans by more than 45 degrees sends
 * rays below the horizon, alpha^2 / (1 + alpha^2) of all. */
static void what_is_lost(void) {
    for (int i = 0; i < 2; i++) {
        GiShader shader = shader_of(&cases[i]);
        GiShading at = shading_of(&shader, GLINT_DIALECT_GLINT, shading_slant(cases[i].degrees));
        CHECK_NEAR(shading_integral(&at, shading_density, 200), 1, 1e-4);
    }
    GiShader metal = {.type = GLINT_SHADER_GGX, .specular = {1, 1, 1}, .index = 3};
    for (metal.roughness = 0.2; metal.roughness < 2; metal.roughness *= 2) {
        GiShading at = shading_of(&metal, GLINT_DIALECT_GLINT, shading_slant(0));
        double alpha_square = metal.roughness * metal.roughness;
        CHECK_NEAR(shading_integral(&at, shading_density, 200), 1 / (1 + alpha_square), 1e-4);
    }
}

/* ---------------------------------------------------------------- directions */

enum { ROWS = 12, COLUMNS = 16, BINS = ROWS * COLUMNS };

static int bin_of(GiVec l) {
    int row = (int)(acos(l.z) / 3.1415926535897931 * ROWS);
    int column = (int)((atan2(l.y, l.x) / 6.2831853071795862 + 1) * COLUMNS) % COLUMNS;
    return (row < ROWS ? row : ROWS - 1) * COLUMNS + column;
}

/* Pearson's chi square of counts against expectations: its mean is the number of bins, its
 * deviation the root of twice that. Bins with few draws are thrown together. */
static double excess(const double *count, const double *expected, int bins) {
    double sum = 0, used = 0, few_count = 0, few_expected = 0;
    for (int i = 0; i < bins; i++) {
        if (expected[i] < 25) {
            few_count += count[i];
            few_expected += expected[i];
            continue;
        }
        double off = count[i] - expected[i];
        sum += off * off / expected[i];
        used++;
    }
    if (few_expected > 25) {
        double off = few_count - few_expected;
        sum += off * off / few_expected;
        used++;
    } else if (few_count > few_expected + 40) {
        return INFINITY;
    }
    return (sum - used) / sqrt(2 * used);
}

static void check_directions(const Case *a_case, uint64_t seed) {
    GiShader shader = shader_of(a_case);
    GiShading at = shading_of(&shader, a_case->year, shading_slant(a_case->degrees));
    Random random = {seed};
    double count[BINS + 1] = {0}, expected[BINS + 1], rest = DRAWS;
    for (int i = 0; i < DRAWS; i++) {
        GiVec l;
        count[draw(&random, &at, &l) > 0 ? bin_of(l) : BINS]++;
    }
    for (int i = 0; i < BINS; i++) {
        double row[2] = {(double)(i / COLUMNS) / ROWS, (double)(i / COLUMNS + 1) / ROWS};
        double column[2] = {(double)(i % COLUMNS) / COLUMNS, (double)(i % COLUMNS + 1) / COLUMNS};
        expected[i] = DRAWS * shading_integral_part(&at, shading_density, row, column, 24);
        rest -= expected[i];
    }
    expected[BINS] = rest > 0 ? rest : 0; /* draws that give none */
    double off = excess(count, expected, BINS + 1);
    if (!(off < 5)) {
        test_fail(__FILE__, __LINE__, "%s: chi square is off by %g deviations", a_case->what, off);
    }
}

static void directions(void) {
    for (int i = 0; i < CASES; i++) check_directions(&cases[i], 61 + (uint64_t)i);
}

/* The same numbers give the same direction, and each lobe is reached. */
static void lobes(void) {
    GiShader shader = shader_of(&cases[10]);
    GiShading at = shading_of(&shader, GLINT_DIALECT_GLINT, shading_slant(50));
    const double first[3] = {0, 0.3, 0.6}, second[3] = {1 - 0x1p-53, 0.3, 0.6};
    GiVec a, b, c;
    CHECK(gi_bsdf_sample(&at, first, &a) == gi_bsdf_sample(&at, first, &b));
    CHECK(gi_bsdf_sample(&at, second, &c) > 0);
    CHECK(a.x == b.x && a.y == b.y && a.z == b.z && a.z == sqrt(0.7) && c.x < 0);
}

/* ---------------------------------------------------------------- bits */

static void mix(uint64_t *hash, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    *hash = (*hash ^ bits) * 0x100000001b3u;
    *hash ^= *hash >> 32;
}

static void mix_vec(uint64_t *hash, GiVec v) {
    mix(hash, v.x);
    mix(hash, v.y);
    mix(hash, v.z);
}

/* One number stands for all bits of many draws; it is the same for every compiler and library. What
 * goes in must not come from the C library either. */
static void same_bits_everywhere(void) {
    Random random = {91};
    uint64_t hash = 0xcbf29ce484222325u;
    for (int i = 0; i < 50000; i++) {
        GiShader shader = shader_of(&cases[i % CASES]);
        shader.exponent = random_real(&random, 0, 100);
        shader.roughness = random_real(&random, 0.01, 2);
        shader.index = random_real(&random, 0.5, 3);
        GiVec v = gi_normalize(random_vec(&random, -1, 1)), l;
        GiShading at = shading_of(&shader, cases[i % CASES].year, v);
        mix(&hash, draw(&random, &at, &l));
        mix_vec(&hash, l);
        mix_vec(&hash, gi_bsdf_evaluate(&at, l));
        GiArrival arrival = {.level = 1, .weight = 1};
        GiScatter scatter;
        shader.type = GLINT_SHADER_GLASS;
        gi_bsdf_scatter(&at, &arrival, &scatter, NULL);
        for (int j = 0; j < scatter.count; j++) {
            mix_vec(&hash, scatter.branch[j].direction);
            mix_vec(&hash, scatter.branch[j].factor);
        }
    }
    CHECK_INT(hash >> 1, 3845306365684308947);
}

const GiTest tests_sampling[] = {TEST(integrals), TEST(what_is_lost), TEST(directions), TEST(lobes),
    TEST(same_bits_everywhere), TEST_END};
