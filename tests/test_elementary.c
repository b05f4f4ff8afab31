/* SPDX-License-Identifier: MIT
 * Exponential, logarithm, sines and arcs against the C library's long doubles: the errors that
 * elementary.h promises, and every special case. */
#include "test.h"

#include "math/elementary.h"
#include "random.h"

#include <float.h>

enum { TRIALS = 200000 };

/* The largest error that was seen, and where. */
typedef struct Worst {
    double error, at;
} Worst;

static void worsen(Worst *worst, long double error, double at) {
    /* Written so that NaN counts as infinite. */
    if (!(error <= worst->error)) *worst = (Worst){isnan(error) ? INFINITY : (double)error, at};
}

static void check_worst(const char *what, Worst worst, double promise) {
    if (!(worst.error <= promise)) {
        test_fail(__FILE__, __LINE__, "%s: error %.3g at %.17g, promised %g", what, worst.error,
            worst.at, promise);
    }
}

static long double relative(double actual, long double expected) {
    if (expected == 0) return actual == 0 ? 0 : INFINITY;
    return fabsl((actual - expected) / expected);
}

/* Of either sign, of all sizes from 2^-low to 2^high. */
static double any_size(Random *random, double low, double high) {
    double size = exp2(random_real(random, -low, high));
    return random_below(random, 2) ? size : -size;
}

static bool same(double a, double b) { return a == b && signbit(a) == signbit(b); }

/* ---------------------------------------------------------------- exponential and logarithm */

static void exponential(void) {
    Random random = {11};
    Worst worst = {0}, least = {0};
    for (int i = 0; i < TRIALS; i++) {
        double x = random_real(&random, -708, 709.7), y = any_size(&random, 70, 6);
        worsen(&worst, relative(gi_exp(x), expl(x)), x);
        worsen(&worst, relative(gi_exp(y), expl(y)), y);
        double z = random_real(&random, -745, -708.4); /* subnormal results */
        worsen(&least, fabsl(gi_exp(z) - expl(z)) / 0x1p-1074L, z);
    }
    check_worst("exp", worst, 4e-16);
    check_worst("exp, in smallest numbers", least, 1);
    CHECK(gi_exp(0) == 1 && gi_exp(-0.0) == 1);
    CHECK(gi_exp(709.78) < INFINITY && gi_exp(709.79) == INFINITY);
    CHECK(gi_exp(-745.13) == 0x1p-1074 && gi_exp(-745.14) == 0);
    CHECK(gi_exp(INFINITY) == INFINITY && gi_exp(-INFINITY) == 0);
    CHECK(gi_exp(DBL_MAX) == INFINITY && gi_exp(-DBL_MAX) == 0);
    CHECK(isnan(gi_exp(NAN)));
}

static void logarithm(void) {
    Random random = {12};
    Worst worst = {0};
    for (int i = 0; i < TRIALS; i++) {
        double x = exp2(random_real(&random, -1074, 1024));
        double y = 1 + any_size(&random, 52, -1);
        worsen(&worst, relative(gi_log(x), logl(x)), x);
        worsen(&worst, relative(gi_log(y), logl(y)), y);
    }
    check_worst("log", worst, 4e-16);
    CHECK(same(gi_log(1), 0));
    CHECK_NEAR(gi_log(0x1p-1074), -744.44007192138122, 2e-13);
    CHECK_NEAR(gi_log(DBL_MAX), 709.78271289338397, 2e-13);
    CHECK(gi_log(0) == -INFINITY && gi_log(-0.0) == -INFINITY);
    CHECK(gi_log(INFINITY) == INFINITY);
    CHECK(isnan(gi_log(-1)) && isnan(gi_log(-INFINITY)) && isnan(gi_log(NAN)));
}

/* ---------------------------------------------------------------- sine and cosine */

static long double sincos_error(double x) {
    double sine, cosine;
    gi_sincos(x, &sine, &cosine);
    return fmaxl(fabsl(sine - sinl(x)), fabsl(cosine - cosl(x)));
}

static void sine_of_radians(void) {
    Random random = {13};
    Worst turn = {0}, many = {0}, huge = {0}, tiny = {0};
    double sine, cosine;
    for (int i = 0; i < TRIALS; i++) {
        double x = random_real(&random, -7, 7), y = random_real(&random, -1e6, 1e6);
        worsen(&turn, sincos_error(x), x);
        worsen(&many, sincos_error(y), y);
        double near = random_below(&random, 1000) * 0.78539816339744831;
        near += any_size(&random, 60, -10);
        worsen(&many, sincos_error(near), near);
        double z = any_size(&random, -20, 50);
        worsen(&huge, sincos_error(z) / (2e-16 + 4e-17 * fabs(z)), z);
        double small = any_size(&random, 1000, -20);
        gi_sincos(small, &sine, &cosine);
        worsen(&tiny, relative(sine, sinl(small)), small);
    }
    check_worst("sine and cosine", turn, 2e-16);
    check_worst("sine and cosine of many turns", many, 2e-16);
    check_worst("sine and cosine, part of the promise", huge, 1);
    check_worst("sine of small angles", tiny, 2e-16);
    gi_sincos(-0.0, &sine, &cosine);
    CHECK(same(sine, 0) && cosine == 1);
    static const double none[] = {INFINITY, -INFINITY, NAN};
    for (int i = 0; i < 3; i++) {
        gi_sincos(none[i], &sine, &cosine);
        CHECK(isnan(sine) && isnan(cosine));
    }
    gi_sincos(DBL_MAX, &sine, &cosine);
    CHECK_NEAR(sine * sine + cosine * cosine, 1, 1e-15);
}

/* ---------------------------------------------------------------- arcs */

static void arc_tangent(void) {
    Random random = {14};
    Worst absolute = {0}, ratio = {0};
    for (int i = 0; i < TRIALS; i++) {
        double y = any_size(&random, 1000, 1023), x = any_size(&random, 1000, 1023);
        if (i % 2 == 0) x = random_real(&random, -2, 2) * y;
        if (isinf(x)) continue;
        long double expected = atan2l(y, x);
        if (fabsl(expected) < 0x1p-1000L) continue;
        worsen(&absolute, fabsl(gi_atan2(y, x) - expected), y / x);
        worsen(&ratio, relative(gi_atan2(y, x), expected), y / x);
    }
    check_worst("atan2", absolute, 5e-16);
    check_worst("atan2, relative", ratio, 1e-15);
    /* All the special cases that there are, by the C library. */
    static const double special[] = {
        0, 1, 2, 0x1p-1074, 3 * 0x1p-1074, 1e-310, DBL_MIN, DBL_MAX, 1e308, INFINITY};
    for (int i = 0; i < 40; i++) {
        for (int j = 0; j < 40; j++) {
            double y = special[i / 4] * (i % 2 ? -1 : 1), x = special[j / 4] * (j % 2 ? -1 : 1);
            double actual = gi_atan2(y, x), expected = atan2(y, x);
            if (!(fabs(actual - expected) <= 5e-16) || signbit(actual) != signbit(expected)) {
                test_fail(__FILE__, __LINE__, "atan2(%g, %g) is %.17g, not %.17g", y, x, actual,
                    expected);
            }
        }
    }
    CHECK(isnan(gi_atan2(NAN, 1)) && isnan(gi_atan2(1, NAN)) && isnan(gi_atan2(INFINITY, NAN)));
    CHECK(gi_atan2(1, 0) == 1.5707963267948966 && gi_atan2(0, -1) == 3.1415926535897931);
}

static void arc_sine_and_cosine(void) {
    Random random = {15};
    Worst absolute = {0}, ratio = {0};
    for (int i = 0; i < TRIALS; i++) {
        double x = random_real(&random, -1, 1);
        if (i % 3 == 1) x = any_size(&random, 1000, 0);
        if (i % 3 == 2) x = 1 - exp2(random_real(&random, -53, 0));
        if (random_below(&random, 2)) x = -x;
        worsen(&absolute, fabsl(gi_asin(x) - asinl(x)), x);
        worsen(&absolute, fabsl(gi_acos(x) - acosl(x)), x);
        worsen(&ratio, relative(gi_asin(x), asinl(x)), x);
        worsen(&ratio, relative(gi_acos(x), acosl(x)), x);
    }
    check_worst("asin and acos", absolute, 6e-16);
    check_worst("asin and acos, relative", ratio, 1e-15);
    CHECK(same(gi_asin(0), 0) && same(gi_asin(-0.0), -0.0));
    CHECK(gi_asin(1) == 1.5707963267948966 && gi_asin(-1) == -1.5707963267948966);
    CHECK(same(gi_acos(1), 0) && gi_acos(-1) == 3.1415926535897931);
    CHECK(isnan(gi_asin(1.0000000000000002)) && isnan(gi_acos(1.0000000000000002)));
    CHECK(isnan(gi_asin(-INFINITY)) && isnan(gi_acos(INFINITY)));
    CHECK(isnan(gi_asin(NAN)) && isnan(gi_acos(NAN)));
}

const GiTest tests_elementary[] = {TEST(exponential), TEST(logarithm), TEST(sine_of_radians),
    TEST(arc_tangent), TEST(arc_sine_and_cosine), TEST_END};
