/* SPDX-License-Identifier: MIT
 * The table for people. Numbers are rounded to what can be read at a glance; the exact ones are in
 * the JSON. */
#define _DEFAULT_SOURCE
#define _POSIX_C_SOURCE 200809L
#include "stats.h"

#include <inttypes.h>
#include <stdio.h>
#include <sys/resource.h>

uint64_t cli_stats_resident_peak(void) {
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#ifdef __APPLE__
    return (uint64_t)usage.ru_maxrss;
#else
    return (uint64_t)usage.ru_maxrss * 1024;
#endif
}

double cli_stats_rays_per_second(const CliStats *stats) {
    double rays = (double)(stats->library.camera_rays + stats->library.shadow_rays +
                           stats->library.other_rays);
    return stats->library.trace_seconds > 0 ? rays / stats->library.trace_seconds : 0;
}

/* 1234567 -> "1,234,567" */
static const char *grouped(uint64_t number, char *text, size_t size) {
    char digits[24];
    int count = snprintf(digits, sizeof digits, "%" PRIu64, number);
    size_t used = 0;
    for (int i = 0; i < count && used + 2 < size; i++) {
        if (i > 0 && (count - i) % 3 == 0) text[used++] = ',';
        text[used++] = digits[i];
    }
    text[used] = '\0';
    return text;
}

/* 1234567 -> "1.23 M"; three digits that count. */
static const char *scaled(double number, const char *unit, char *text, size_t size) {
    static const char *const prefixes[] = {"", "k", "M", "G", "T"};
    size_t i = 0;
    while (number >= 999.5 && i + 1 < sizeof prefixes / sizeof prefixes[0]) {
        number /= 1000;
        i++;
    }
    int digits = i == 0 || number >= 99.95 ? 0 : number >= 9.995 ? 1 : 2;
    snprintf(text, size, "%.*f %s%s", digits, number, prefixes[i], unit);
    return text;
}

static void print_phase(const char *name, double seconds, double total) {
    fprintf(stderr, "  %-10s %10.4f s %4.0f %%\n", name, seconds,
        total > 0 ? 100 * seconds / total : 0);
}

static void print_count(const char *name, uint64_t count) {
    char text[32];
    fprintf(stderr, "  %-10s %12s\n", name, grouped(count, text, sizeof text));
}

static void print_bytes(const char *name, uint64_t bytes) {
    char text[32];
    fprintf(stderr, "  %-10s %12s\n", name, scaled((double)bytes, "B", text, sizeof text));
}

void cli_stats_print_text(const CliStats *stats) {
    const GlintStats *library = &stats->library;
    char text[32];
    fprintf(stderr, "%s: %d x %d pixels, %d %s each, dialect %s, %s, %d %s\n",
        cli_job_name(stats->job), stats->crop_width, stats->crop_height, stats->scene.samples,
        stats->scene.samples == 1 ? "sample" : "samples", glint_dialect_name(stats->scene.dialect),
        library->isa, library->thread_count, library->thread_count == 1 ? "thread" : "threads");
    print_phase("read", library->read_seconds, stats->total_seconds);
    print_phase("build", library->build_seconds, stats->total_seconds);
    print_phase("trace", library->trace_seconds, stats->total_seconds);
    print_phase("write", stats->write_seconds, stats->total_seconds);
    print_phase("total", stats->total_seconds, stats->total_seconds);
    fputs(" rays\n", stderr);
    print_count("camera", library->camera_rays);
    print_count("shadow", library->shadow_rays);
    if (library->other_rays > 0) print_count("other", library->other_rays);
    fprintf(stderr, "  %-10s %12s\n", "per second",
        scaled(cli_stats_rays_per_second(stats), "", text, sizeof text));
    fputs(" tree\n", stderr);
    print_count("primitives", library->primitive_count);
    print_count("nodes", library->node_count);
    print_count("leaves", library->leaf_count);
    print_bytes("size", library->tree_bytes);
    fprintf(stderr, "  %-10s %12.2f\n", "SAH cost", library->sah_cost);
    fputs(" memory\n", stderr);
    print_bytes("allocated", library->memory_peak);
    print_bytes("resident", stats->resident_peak);
}
