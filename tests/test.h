/* SPDX-License-Identifier: MIT
 * The whole test harness: functions in lists, one list a file, and a few checks. A failing check
 * is reported and the test goes on, so that one run shows all that is wrong. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef struct GiTest {
    const char *name;
    void (*run)(void);
} GiTest;

/* test_<room>.c ends with: const GiTest tests_<room>[] = {TEST(name), ..., TEST_END}; */
#define TEST(function)                                                                             \
    { #function, function }
#define TEST_END                                                                                   \
    { NULL, NULL }

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void test_fail(const char *file, int line, const char *format, ...);

/* Marks the running test as skipped, with the reason; the test should return then. */
void test_skip(const char *reason);

/* About how many times longer this build takes than an optimised one without sanitizers. */
int test_slowness(void);

/* How many rays to trace where more are always better: what --rays says, else the usual number, or
 * less where the build is slow. */
long long test_rays(long long usual);

/* Folder of the project's sources, of ../shared (null when absent), and one for scratch files. */
const char *test_source_dir(void);
const char *test_shared_dir(void);
const char *test_scratch_dir(void);

#define CHECK(condition)                                                                           \
    do {                                                                                           \
        if (!(condition)) test_fail(__FILE__, __LINE__, "%s", #condition);                         \
    } while (0)

#define CHECK_INT(actual, expected)                                                                \
    do {                                                                                           \
        long long actual_ = (long long)(actual), expected_ = (long long)(expected);                \
        if (actual_ != expected_) {                                                                \
            test_fail(__FILE__, __LINE__, "%s is %lld, not %lld", #actual, actual_, expected_);    \
        }                                                                                          \
    } while (0)

#define CHECK_NEAR(actual, expected, tolerance)                                                    \
    do {                                                                                           \
        double actual_ = (actual), expected_ = (expected);                                         \
        if (!(actual_ - expected_ <= (tolerance) && expected_ - actual_ <= (tolerance))) {         \
            test_fail(__FILE__, __LINE__, "%s is %.17g, not %.17g", #actual, actual_, expected_);  \
        }                                                                                          \
    } while (0)

#define CHECK_TEXT(actual, expected) test_check_text(__FILE__, __LINE__, #actual, actual, expected)

void test_check_text(
    const char *file, int line, const char *what, const char *actual, const char *expected);
