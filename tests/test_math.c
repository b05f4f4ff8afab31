/* SPDX-License-Identifier: MIT
 * The elementary functions against long double, and maps of space against what they mean. */
#include "test.h"

#include "math/affine.h"
#include "math/bytes.h"
#include "math/elementary.h"
#include "random.h"

#include <float.h>
#include <stdint.h>

static const long double degree = 0.017453292519943295769236907684886127L;

/* ---------------------------------------------------------------- powers */

static int wrong_count; /* of a test, to keep the report short */

static void check_power(double base, double exponent) {
    long double expected = powl((long double)base, (long double)exponent);
    double power = gi_pow(base, exponent);
    bool whole = exponent >= 0 && exponent <= 1024 && floor(exponent) == exponent;
    double promise = whole ? 2e-16 * exponent : 4e-15 * (1 + fabs(exponent * log2(base)) / 16);
    bool good;
    if (expected > (long double)DBL_MAX * (1 + promise)) {
        good = power == INFINITY;
    } else if (expected < (long double)DBL_MIN * 2) {
        /* Too small for a full set of digits. */
        good = power >= 0 && fabsl(power - expected) <= 2 * promise * DBL_MIN + 0x1p-1074;
    } else if (expected > (long double)DBL_MAX * (1 - promise)) {
        good = power > DBL_MAX * (1 - 2 * promise);
    } else {
        good = fabsl(power - expected) <= promise * expected;
    }
    if (!good && wrong_count++ < 5) {
        test_fail(__FILE__, __LINE__, "%.17g^%.17g is %.17g, not %.20Lg (error %.3Lg, promised %g)",
            base, exponent, power, expected, fabsl(power - expected) / expected, promise);
    }
}

static void power_random(void) {
    Random random = {1};
    wrong_count = 0;
    for (int i = 0; i < 200000; i++) {
        double base = random_real(&random, 0, 1); /* as the cosine of a highlight is */
        check_power(base, random_real(&random, 0, 200));
        check_power(base, random_below(&random, 1025));
        check_power(1 - base * 0x1p-20, random_real(&random, 0, 1e6));
        check_power(1 + base * 0x1p-20, random_real(&random, -1e6, 1e6));
        double wide = exp2(random_real(&random, -1074, 1024));
        check_power(wide, random_real(&random, -3, 3));
        check_power(wide, random_real(&random, -1e-3, 1e-3));
        check_power(wide, random_below(&random, 5));
        check_power(random_real(&random, 0, 100), random_real(&random, -50, 50));
    }
}

static void power_edges(void) {
    CHECK(gi_pow(0, 0) == 1);
    CHECK(gi_pow(0, 3) == 0);
    CHECK(gi_pow(0, 0.5) == 0);
    CHECK(gi_pow(0, 2000.5) == 0);
    CHECK(gi_pow(0, -1) == INFINITY);
    CHECK(gi_pow(5, 0) == 1);
    CHECK(gi_pow(1, 1e300) == 1);
    CHECK(gi_pow(1, -0.3) == 1);
    CHECK(gi_pow(7, 1) == 7);
    CHECK(gi_pow(2, 10) == 1024);
    CHECK(gi_pow(2, 1023) == 0x1p1023);
    CHECK(gi_pow(2, 1024) == INFINITY);
    CHECK(gi_pow(2, 5000) == INFINITY);
    CHECK(gi_pow(2, -5000) == 0);
    CHECK(gi_pow(0.5, 1e300) == 0);
    CHECK(gi_pow(0.5, -1e300) == INFINITY);
    CHECK(gi_pow(INFINITY, 2) == INFINITY);
    CHECK(gi_pow(INFINITY, 0.5) == INFINITY);
    CHECK(gi_pow(INFINITY, -0.5) == 0);
    CHECK(isnan(gi_pow(NAN, 2)));
    CHECK(isnan(gi_pow(NAN, 0.5)));
    CHECK(isnan(gi_pow(2, NAN)));
    CHECK_NEAR(gi_pow(0x1p-1074, 0.5), 0x1p-537, 0x1p-537 * 1e-12);
    CHECK_NEAR(gi_pow(0x1p-1060, -0.5), 0x1p530, 0x1p530 * 1e-12);
    CHECK_NEAR(gi_pow(DBL_MAX, 0.5), 0x1p512, 0x1p512 * 1e-12);
    CHECK_NEAR(gi_pow(2, 0.5), 1.4142135623730951, 1e-14);
    CHECK_NEAR(gi_pow(2, -1074) / 0x1p-1074, 1, 0);
}

/* ---------------------------------------------------------------- angles */

static void sine_and_cosine(void) {
    Random random = {2};
    double worst = 0, worst_at = 0;
    for (int i = 0; i < 200000; i++) {
        double angle = random_real(&random, -400, 400);
        if (i % 4 == 1) angle = random_real(&random, -1e6, 1e6);
        if (i % 4 == 2) angle = 45 * random_below(&random, 17) + random_real(&random, -1e-9, 1e-9);
        if (i % 4 == 3) angle = random_real(&random, -1, 1) * exp2(-random_below(&random, 1000));
        double sine, cosine;
        gi_sincos_degrees(angle, &sine, &cosine);
        long double reduced = fmodl(angle, 360) * degree;
        double error = (double)fmaxl(fabsl(sine - sinl(reduced)), fabsl(cosine - cosl(reduced)));
        if (error > worst) worst = error, worst_at = angle;
        if (fabs(angle) < 1e-3) CHECK_NEAR(sine / (angle * (double)degree), 1, 1e-6);
    }
    if (worst > 2e-16) {
        test_fail(__FILE__, __LINE__, "error %g at %.17g degrees", worst, worst_at);
    }
    static const double exact[][3] = {{0, 0, 1}, {90, 1, 0}, {180, 0, -1}, {270, -1, 0},
        {360, 0, 1}, {-90, -1, 0}, {-180, 0, -1}, {-270, 1, 0}, {3600090, 1, 0}, {-720, 0, 1}};
    for (size_t i = 0; i < sizeof exact / sizeof exact[0]; i++) {
        double sine, cosine;
        gi_sincos_degrees(exact[i][0], &sine, &cosine);
        CHECK(sine == exact[i][1] && cosine == exact[i][2]);
    }
}

/* ---------------------------------------------------------------- maps */

static GiAffine random_affine(Random *random, double size) {
    GiAffine a;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++) a.m[i][j] = size * random_real(random, -1, 1);
    }
    return a;
}

static void check_vec(GiVec actual, GiVec expected, double tolerance) {
    CHECK_NEAR(actual.x, expected.x, tolerance);
    CHECK_NEAR(actual.y, expected.y, tolerance);
    CHECK_NEAR(actual.z, expected.z, tolerance);
}

static void maps_multiply(void) {
    Random random = {3};
    for (int i = 0; i < 1000; i++) {
        GiAffine a = random_affine(&random, 2), b = random_affine(&random, 2);
        GiAffine both = gi_affine_multiply(&a, &b);
        GiVec p = random_vec(&random, -5, 5);
        check_vec(gi_affine_point(&both, p), gi_affine_point(&a, gi_affine_point(&b, p)), 1e-13);
        check_vec(gi_affine_vector(&both, p), gi_affine_vector(&a, gi_affine_vector(&b, p)), 1e-13);
        GiVec q = random_vec(&random, -5, 5);
        CHECK_NEAR(gi_dot(gi_affine_vector(&a, p), q),
            gi_dot(p, gi_affine_transposed_vector(&a, q)), 1e-13 * 100);
    }
    CHECK(gi_affine_is_identity(&gi_affine_identity));
    GiAffine a = gi_affine_identity;
    a.m[2][3] = 1e-300;
    CHECK(!gi_affine_is_identity(&a));
    check_vec(gi_affine_point(&gi_affine_identity, gi_vec(1, 2, 3)), gi_vec(1, 2, 3), 0);
    a = gi_affine_translate(gi_vec(1, 2, 3));
    check_vec(gi_affine_point(&a, gi_vec(10, 20, 30)), gi_vec(11, 22, 33), 0);
    check_vec(gi_affine_vector(&a, gi_vec(10, 20, 30)), gi_vec(10, 20, 30), 0);
    a = gi_affine_scale(gi_vec(-1, 2, 0.5));
    check_vec(gi_affine_point(&a, gi_vec(10, 20, 30)), gi_vec(-10, 40, 15), 0);
}

static void maps_invert(void) {
    Random random = {4};
    for (int i = 0; i < 3000; i++) {
        double size = exp2(random_real(&random, -300, 300));
        GiAffine a = random_affine(&random, size), inverse;
        if (!gi_affine_invert(&a, &inverse)) {
            test_fail(__FILE__, __LINE__, "matrix %d of size %g has no inverse", i, size);
            continue;
        }
        GiAffine one = gi_affine_multiply(&a, &inverse);
        /* What rounding may cost: the product of the sizes of the two. */
        double condition = 0;
        for (int j = 0; j < 9; j++) condition += fabs(inverse.m[j / 3][j % 3]) * size;
        for (int row = 0; row < 3; row++) {
            for (int column = 0; column < 4; column++) {
                double tolerance = 1e-14 * condition * (1 + condition);
                if (column == 3) tolerance *= size;
                CHECK_NEAR(one.m[row][column], row == column ? 1 : 0, tolerance);
            }
        }
    }
    /* Rows of very different sizes are no fault. */
    GiAffine a = gi_affine_scale(gi_vec(1e-100, 1e100, -3)), inverse;
    CHECK(gi_affine_invert(&a, &inverse));
    CHECK_NEAR(inverse.m[0][0] * 1e-100, 1, 1e-15);
    CHECK_NEAR(inverse.m[1][1] * 1e100, 1, 1e-15);
    CHECK_NEAR(inverse.m[2][2], -1 / 3.0, 1e-16);
}

static void maps_singular(void) {
    GiAffine untouched = gi_affine_scale(gi_vec(7, 7, 7)), inverse = untouched;
    GiAffine bad[12];
    for (int i = 0; i < 12; i++) bad[i] = gi_affine_rotate_degrees(gi_vec(20, 30, 40));
    for (int j = 0; j < 3; j++) {
        bad[0].m[1][j] = 0;              /* a row of zeros */
        bad[1].m[2][j] = bad[1].m[0][j]; /* two rows alike */
        bad[2].m[2][j] = bad[2].m[0][j] + bad[2].m[1][j];
        bad[3].m[j][1] = 0; /* a column of zeros */
        bad[4].m[j][2] = 3 * bad[4].m[j][0];
        bad[5].m[0][j] = 1e-320; /* an inverse out of range */
        bad[6].m[j][0] = bad[6].m[j][1] = bad[6].m[j][2] = 0;
        bad[7].m[2][j] = bad[7].m[0][j] * (1 + 1e-16);
    }
    bad[8].m[1][1] = NAN;
    bad[9].m[1][1] = INFINITY;
    bad[10].m[1][3] = NAN;
    bad[11].m[0][3] = -INFINITY;
    for (int i = 0; i < 12; i++) {
        if (gi_affine_invert(&bad[i], &inverse)) test_fail(__FILE__, __LINE__, "matrix %d", i);
    }
    for (int i = 0; i < 12; i++) CHECK(inverse.m[i / 4][i % 4] == untouched.m[i / 4][i % 4]);
}

/* One after the other, each about its axis, in long double. */
static GiVec turn(GiVec p, GiVec angles) {
    long double x = p.x, y = p.y, z = p.z, s, c, old;
    s = sinl(angles.x * degree), c = cosl(angles.x * degree);
    old = y, y = c * y - s * z, z = s * old + c * z;
    s = sinl(angles.y * degree), c = cosl(angles.y * degree);
    old = x, x = c * x + s * z, z = -s * old + c * z;
    s = sinl(angles.z * degree), c = cosl(angles.z * degree);
    old = x, x = c * x - s * y, y = s * old + c * y;
    return gi_vec((double)x, (double)y, (double)z);
}

static void maps_rotate(void) {
    Random random = {5};
    for (int i = 0; i < 2000; i++) {
        GiVec angles = random_vec(&random, -400, 400), p = random_vec(&random, -1, 1);
        GiAffine a = gi_affine_rotate_degrees(angles);
        check_vec(gi_affine_point(&a, p), turn(p, angles), 4e-15);
    }
    /* Quarter turns move axes onto axes without rounding. */
    static const struct {
        GiVec angles, from, to;
    } quarter[] = {{{90, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 90, 0}, {0, 0, 1}, {1, 0, 0}},
        {{0, 0, 90}, {1, 0, 0}, {0, 1, 0}}, {{90, 90, 0}, {0, 1, 0}, {1, 0, 0}},
        {{90, 0, 90}, {1, 0, 0}, {0, 1, 0}}, {{180, 0, 0}, {1, 2, 3}, {1, -2, -3}},
        {{-90, 0, 0}, {0, 1, 0}, {0, 0, -1}}, {{360, -720, 360}, {1, 2, 3}, {1, 2, 3}}};
    for (size_t i = 0; i < sizeof quarter / sizeof quarter[0]; i++) {
        GiAffine a = gi_affine_rotate_degrees(quarter[i].angles);
        check_vec(gi_affine_point(&a, quarter[i].from), quarter[i].to, 0);
    }
}

/* ---------------------------------------------------------------- vectors */

static void vectors_normalize(void) {
    Random random = {6};
    for (int i = 0; i < 20000; i++) {
        double size = exp2(random_real(&random, -1060, 1023));
        GiVec direction = random_vec(&random, -1, 1);
        if (i % 3 == 0) direction.y *= exp2(random_real(&random, -300, 0));
        if (i % 5 == 0) direction.x = 0;
        GiVec n = gi_normalize(gi_scale(direction, size));
        CHECK_NEAR(gi_length(n), 1, 5e-16);
        if (size > 1e-290) {
            long double length = sqrtl((long double)direction.x * direction.x +
                                       (long double)direction.y * direction.y +
                                       (long double)direction.z * direction.z);
            check_vec(n,
                gi_vec((double)(direction.x / length), (double)(direction.y / length),
                    (double)(direction.z / length)),
                4e-16);
        }
    }
    check_vec(gi_normalize(gi_vec(0, 0, 0)), gi_vec(0, 0, 0), 0);
    check_vec(gi_normalize(gi_vec(0, 0, 0x1p-1074)), gi_vec(0, 0, 1), 0);
    check_vec(gi_normalize(gi_vec(0, -DBL_MAX, 0)), gi_vec(0, -1, 0), 0);
    double third = 0.57735026918962584;
    check_vec(
        gi_normalize(gi_vec(DBL_MAX, DBL_MAX, -DBL_MAX)), gi_vec(third, third, -third), 2e-16);
    check_vec(gi_normalize(gi_vec(3, 0, -4)), gi_vec(0.6, 0, -0.8), 2e-16);
}

static void vectors_products(void) {
    Random random = {7};
    for (int i = 0; i < 1000; i++) {
        GiVec a = random_vec(&random, -1, 1), b = random_vec(&random, -1, 1);
        GiVec c = gi_cross(a, b);
        CHECK_NEAR(gi_dot(a, c), 0, 1e-15);
        CHECK_NEAR(gi_dot(b, c), 0, 1e-15);
        CHECK_NEAR(gi_dot(c, c), gi_dot(a, a) * gi_dot(b, b) - gi_dot(a, b) * gi_dot(a, b), 1e-14);
    }
    check_vec(gi_cross(gi_vec(1, 0, 0), gi_vec(0, 1, 0)), gi_vec(0, 0, 1), 0);
    check_vec(gi_along(gi_vec(1, 2, 3), gi_vec(2, 0, -1), 3), gi_vec(7, 2, 0), 0);
    check_vec(gi_multiply(gi_vec(1, 2, 3), gi_vec(4, 5, 6)), gi_vec(4, 10, 18), 0);
    check_vec(
        gi_sub(gi_add(gi_vec(1, 2, 3), gi_vec(4, 5, 6)), gi_vec(4, 5, 6)), gi_vec(1, 2, 3), 0);
}

/* ---------------------------------------------------------------- bytes */

static void bytes_at_random(void) {
    static const char likely[] = " \t\n\v\f\r\b\x0e\x1f!0/#\\\x80\x89\x8d\xa0\xff";
    Random random = {5};
    for (int round = 0; round < 2000; round++) {
        char text[GI_BYTES];
        uint64_t spaces = 0, zeros = 0, high = 0;
        for (int i = 0; i < GI_BYTES; i++) {
            uint64_t bits = random_bits(&random);
            text[i] = bits % 4 == 0 ? (char)(bits >> 8) : likely[(bits >> 8) % sizeof likely];
            bool space = text[i] == ' ' || (text[i] >= '\t' && text[i] <= '\r');
            spaces |= (uint64_t)space << i;
            zeros |= (uint64_t)(text[i] == '0') << i;
            high |= (uint64_t)(text[i] == '\x89') << i;
        }
        GiBytes bytes = gi_bytes_load(text);
        CHECK(gi_bytes_space(bytes) == spaces);
        CHECK(gi_bytes_equal(bytes, '0') == zeros);
        CHECK(gi_bytes_equal(bytes, '\x89') == high);
        int count = 0;
        for (uint64_t rest = spaces; rest != 0; rest &= rest - 1) count++;
        CHECK_INT(gi_bytes_count(spaces), count);
    }
    CHECK_INT(gi_bytes_count(UINT64_MAX), 64);
}

const GiTest tests_math[] = {TEST(power_random), TEST(power_edges), TEST(sine_and_cosine),
    TEST(maps_multiply), TEST(maps_invert), TEST(maps_singular), TEST(maps_rotate),
    TEST(vectors_normalize), TEST(vectors_products), TEST(bytes_at_random), TEST_END};
