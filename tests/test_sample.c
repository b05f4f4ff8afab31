/* SPDX-License-Identifier: MIT
 * The sampler: what a (0,2)-sequence promises, counted; independence and uniformity, measured. All
 * bounds on random quantities are wide, and the numbers are always the same. */
#include "test.h"

#include "sample/sampler.h"

#include <math.h>
#include <string.h>

/* ---------------------------------------------------------------- what it promises */

/* Whether samples [first, first + 2^m) have one point in each box 2^-k x 2^(k-m). */
static bool is_stratified(uint32_t x, uint32_t dimension, uint32_t first, int m, int k) {
    static unsigned char seen[1 << 12];
    memset(seen, 0, (size_t)1 << m);
    for (uint32_t i = 0; i < 1u << m; i++) {
        GiSampler sampler = gi_sampler(x, 5, first + i);
        double u[2];
        gi_sample_2d(&sampler, dimension, u);
        size_t column = (size_t)(u[0] * (double)(1 << k));
        size_t row = (size_t)(u[1] * (double)(1 << (m - k)));
        if (seen[row << k | column]++ != 0) return false;
    }
    return true;
}

static void sampler_strata(void) {
    for (uint32_t dimension = 0; dimension < 20; dimension++) {
        for (int m = 0; m <= 12; m += m < 6 ? 1 : 3) {
            for (int k = 0; k <= m; k++) {
                CHECK(is_stratified(dimension % 3, dimension, 0, m, k));
                CHECK(is_stratified(7, dimension * 1000, 3u << m, m, k));
            }
        }
    }
}

static void sampler_range(void) {
    for (uint32_t i = 0; i < 100000; i++) {
        GiSampler samplers[2] = {gi_sampler(i, ~i, i), gi_sampler_independent(i, ~i, i)};
        for (int kind = 0; kind < 2; kind++) {
            double u[2], single = gi_sample_1d(&samplers[kind], i % 9);
            gi_sample_2d(&samplers[kind], i % 9, u);
            CHECK(u[0] >= 0 && u[0] < 1 && u[1] >= 0 && u[1] < 1);
            CHECK(floor(u[0] * 0x1p32) == u[0] * 0x1p32 && floor(u[1] * 0x1p32) == u[1] * 0x1p32);
            CHECK(single == u[0]);
        }
    }
}

/* Known values: a change of the sampler changes every picture with noise. */
static void sampler_values(void) {
    GiSampler sampler = gi_sampler(3, 4, 5);
    double u[2];
    gi_sample_2d(&sampler, 6, u);
    CHECK_INT(u[0] * 0x1p32, 3080737968);
    CHECK_INT(u[1] * 0x1p32, 2418476368);
}

/* ---------------------------------------------------------------- what it should look like */

typedef GiSampler (*MakeFn)(uint32_t x, uint32_t y, uint32_t sample);

/* Chi-square, over the degrees of freedom, of pairs (a, b) in 16 x 16 boxes; 1 when uniform and
 * independent. */
typedef struct Boxes {
    int counts[256], total;
} Boxes;

static void count(Boxes *boxes, double a, double b) {
    boxes->counts[(int)(a * 16) * 16 + (int)(b * 16)]++;
    boxes->total++;
}

static double chi_square(const Boxes *boxes) {
    double expected = boxes->total / 256.0, sum = 0;
    for (int i = 0; i < 256; i++) {
        double off = boxes->counts[i] - expected;
        sum += off * off / expected;
    }
    return sum / 255;
}

/* Five standard deviations of the quotient above. */
static const double chi_limit = 1 + 5 * 0.0886;

/* The same sample of neighbouring pixels, neighbouring dimensions of one sample, and single numbers
 * of one dimension at one sample and the next. */
static void sampler_independence(void) {
    static const MakeFn make[] = {gi_sampler, gi_sampler_independent};
    for (int kind = 0; kind < 2; kind++) {
        for (uint32_t sample = 0; sample < 3; sample++) {
            Boxes pixels = {0}, dimensions = {0}, across = {0}, pair = {0};
            for (uint32_t y = 0; y < 300; y++) {
                for (uint32_t x = 0; x < 300; x++) {
                    GiSampler here = make[kind](x, y, sample);
                    GiSampler right = make[kind](x + 1, y, sample);
                    double u[2], v[2], w[2];
                    gi_sample_2d(&here, 1, u);
                    gi_sample_2d(&right, 1, v);
                    gi_sample_2d(&here, 2, w);
                    count(&pixels, u[0], v[0]);
                    count(&dimensions, u[0], w[0]);
                    count(&across, u[1], w[0]);
                    count(&pair, u[0], u[1]);
                }
            }
            CHECK(chi_square(&pixels) < chi_limit);
            CHECK(chi_square(&dimensions) < chi_limit);
            CHECK(chi_square(&across) < chi_limit);
            CHECK(chi_square(&pair) < chi_limit);
        }
    }
}

/* Within one pixel the samples of two dimensions must not march in step either. */
static void sampler_padding(void) {
    Boxes boxes = {0};
    for (uint32_t x = 0; x < 20; x++) {
        for (uint32_t i = 0; i < 4096; i++) {
            GiSampler sampler = gi_sampler(x, 0, i);
            double u = gi_sample_1d(&sampler, 0), v = gi_sample_1d(&sampler, 1);
            count(&boxes, u, v);
        }
    }
    CHECK(chi_square(&boxes) < chi_limit);
}

/* ---------------------------------------------------------------- what it is good for */

/* Root of the mean square error, over many pixels, of the mean of a function. */
static double mean_error(
    MakeFn make, double (*function)(double, double), double truth, int samples) {
    double sum = 0;
    enum { PIXELS = 400 };
    for (uint32_t x = 0; x < PIXELS; x++) {
        double mean = 0;
        for (int i = 0; i < samples; i++) {
            GiSampler sampler = make(x, 1, (uint32_t)i);
            double u[2];
            gi_sample_2d(&sampler, 3, u);
            mean += function(u[0], u[1]) / samples;
        }
        sum += (mean - truth) * (mean - truth);
    }
    return sqrt(sum / PIXELS);
}

static double smooth(double a, double b) { return a * b; }
static double disc(double a, double b) { return a * a + b * b < 1; }

static void sampler_error(void) {
    const double quarter = 0.78539816339744831;
    /* Independent: deviation / sqrt(n). Scrambled: n^-3/2 for what is smooth, n^-3/4 at an edge. */
    CHECK_NEAR(mean_error(gi_sampler_independent, smooth, 0.25, 256), 0.2205 / 16, 0.002);
    CHECK_NEAR(mean_error(gi_sampler_independent, disc, quarter, 256), 0.4105 / 16, 0.003);
    CHECK(mean_error(gi_sampler, smooth, 0.25, 256) < 0.2205 / 16 / 40);
    CHECK(mean_error(gi_sampler, disc, quarter, 256) < 0.4105 / 16 / 3);
    /* Also for numbers that are no powers of two, and few of them. */
    CHECK(mean_error(gi_sampler, smooth, 0.25, 100) < 0.2205 / 10 / 4);
    CHECK(mean_error(gi_sampler, smooth, 0.25, 9) < 0.2205 / 3 / 1.5);
    CHECK(mean_error(gi_sampler, disc, quarter, 9) < 0.4105 / 3 / 1.2);
}

const GiTest tests_sample[] = {TEST(sampler_strata), TEST(sampler_range), TEST(sampler_values),
    TEST(sampler_independence), TEST(sampler_padding), TEST(sampler_error), TEST_END};
