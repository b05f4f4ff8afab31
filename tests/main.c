/* SPDX-License-Identifier: MIT
 * Runs all tests, or those whose name contains one of the arguments.
 *   glint-tests [--source DIR] [--list] [--update-golden] [--rays COUNT] [NAME...]
 * --update-golden writes tests/golden/hashes.txt instead of comparing with it; --rays says how many
 * rays leak.closed_to_all_rays sends. */
#define _XOPEN_SOURCE 700
#include "scenes.h"
#include "test.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* clang-format off */
#define ROOMS(X) \
    X(base) \
    X(math) \
    X(elementary) \
    X(sample) \
    X(samples) \
    X(mesh) \
    X(obj) \
    X(ply) \
    X(reader) \
    X(recipe) \
    X(malformed) \
    X(scan) \
    X(hit) \
    X(shape) \
    X(accel) \
    X(kernel) \
    X(bundle) \
    X(gate) \
    X(leak) \
    X(stream) \
    X(image) \
    X(file) \
    X(light) \
    X(texture) \
    X(radiance) \
    X(bsdf) \
    X(sampling) \
    X(scatter) \
    X(render) \
    X(transport) \
    X(outputs) \
    X(save) \
    X(flight) \
    X(camera) \
    X(golden) \
    X(explain) \
    X(facets) \
    X(tiles) \
    X(api) \
    X(mistake) \
    X(compare) \
    X(grade) \
    X(load) \
    X(life) \
    X(exr) \
    X(check) \
    X(show) \
    X(elements) \
    X(files) \
    X(format) \
    X(triangle) \
    X(upgrade) \
    X(watch) \
    X(watch_camera) \
    X(watch_screen)
/* clang-format on */

#define DECLARE(room) extern const GiTest tests_##room[];
ROOMS(DECLARE)

static const struct {
    const char *room;
    const GiTest *tests;
} rooms[] = {
#define ENTRY(room) {#room, tests_##room},
    ROOMS(ENTRY)};

static const char *source_dir = ".";
static char scratch_dir[] = "/tmp/glint-tests-XXXXXX";
static bool update_golden;
static long long wanted_rays; /* 0: as many as usual */
static int failure_count;
static const char *skip_reason;

void test_fail(const char *file, int line, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    if (failure_count++ < 20) {
        printf("  %s:%d: ", file, line);
        vprintf(format, arguments);
        printf("\n");
    }
    va_end(arguments);
}

void test_skip(const char *reason) { skip_reason = reason; }

void test_check_text(
    const char *file, int line, const char *what, const char *actual, const char *expected) {
    if (actual == NULL || strcmp(actual, expected) != 0) {
        test_fail(
            file, line, "%s is \"%s\", not \"%s\"", what, actual ? actual : "(null)", expected);
    }
}

bool test_update_golden(void) { return update_golden; }

/* Sanitizers and builds without optimisation take ten to fifty times as long. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__OPTIMIZE__)
enum { SLOWER = 20 };
#else
enum { SLOWER = 1 };
#endif

int test_slowness(void) { return SLOWER; }

long long test_rays(long long usual) { return wanted_rays > 0 ? wanted_rays : usual / SLOWER; }

const char *test_source_dir(void) { return source_dir; }

const char *test_scratch_dir(void) { return scratch_dir; }

const char *test_shared_dir(void) {
    static char path[4096];
    struct stat info;
    snprintf(path, sizeof path, "%s/../shared", source_dir);
    return stat(path, &info) == 0 ? path : NULL;
}

static bool wanted(const char *name, int count, char **patterns) {
    for (int i = 0; i < count; i++) {
        if (strstr(name, patterns[i]) != NULL) return true;
    }
    return count == 0;
}

int main(int argc, char **argv) {
    int first = 1;
    bool list = false;
    for (; first < argc && strncmp(argv[first], "--", 2) == 0; first++) {
        if (strcmp(argv[first], "--source") == 0 && first + 1 < argc) source_dir = argv[++first];
        if (strcmp(argv[first], "--rays") == 0 && first + 1 < argc) {
            wanted_rays = atoll(argv[++first]);
        }
        if (strcmp(argv[first], "--list") == 0) list = true;
        if (strcmp(argv[first], "--update-golden") == 0) update_golden = true;
    }
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (mkdtemp(scratch_dir) == NULL) {
        perror(scratch_dir);
        return 3;
    }
    int passed = 0, failed = 0, skipped = 0;
    for (size_t r = 0; r < sizeof rooms / sizeof rooms[0]; r++) {
        for (const GiTest *test = rooms[r].tests; test->name != NULL; test++) {
            char name[256];
            snprintf(name, sizeof name, "%s.%s", rooms[r].room, test->name);
            if (!wanted(name, argc - first, argv + first)) continue;
            if (list) {
                puts(name);
                continue;
            }
            failure_count = 0;
            skip_reason = NULL;
            test->run();
            if (failure_count > 0) {
                failed++;
                printf("FAIL %s\n", name);
            } else if (skip_reason != NULL) {
                skipped++;
                printf("skip %s: %s\n", name, skip_reason);
            } else {
                passed++;
                printf("ok   %s\n", name);
            }
        }
    }
    char command[64];
    snprintf(command, sizeof command, "rm -rf %s", scratch_dir);
    if (system(command) != 0) perror(command);
    if (!list) printf("%d passed, %d failed, %d skipped\n", passed, failed, skipped);
    return failed > 0;
}
