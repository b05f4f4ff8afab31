/* SPDX-License-Identifier: MIT
 * The numbers for programs: JSON Lines, one object a picture. Keys are only ever added. */
#include "json.h"
#include "stats.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* JSON has no infinity. */
static void print_real(const char *key, double value, const char *after) {
    if (isfinite(value)) {
        printf("\"%s\": %.9g%s", key, value, after);
    } else {
        printf("\"%s\": null%s", key, after);
    }
}

static void print_count(const char *key, uint64_t value, const char *after) {
    printf("\"%s\": %" PRIu64 "%s", key, value, after);
}

void cli_stats_print_json(const CliStats *stats) {
    const GlintStats *library = &stats->library;
    printf("{\"scene\": ");
    cli_json_print_text(cli_job_name(stats->job));
    printf(", \"picture\": ");
    cli_json_print_text(stats->job->picture);
    printf(", \"dialect\": \"%s\", \"isa\": \"%s\", \"threads\": %d",
        glint_dialect_name(stats->scene.dialect), library->isa, library->thread_count);
    printf(", \"size\": [%d, %d], \"crop\": [%d, %d, %d, %d], \"samples\": %d", stats->width,
        stats->height, stats->crop_x, stats->crop_y, stats->crop_width, stats->crop_height,
        stats->scene.samples);
    printf(", \"seconds\": {");
    print_real("read", library->read_seconds, ", ");
    print_real("build", library->build_seconds, ", ");
    print_real("trace", library->trace_seconds, ", ");
    print_real("write", stats->write_seconds, ", ");
    print_real("total", stats->total_seconds, "}, \"rays\": {");
    print_count("camera", library->camera_rays, ", ");
    print_count("shadow", library->shadow_rays, ", ");
    print_count("other", library->other_rays, ", ");
    print_real("per_second", cli_stats_rays_per_second(stats), "}, \"scene_counts\": {");
    print_count("surfaces", stats->scene.surface_count, ", ");
    print_count("lights", stats->scene.light_count, ", ");
    print_count("shaders", stats->scene.shader_count, ", ");
    print_count("bytes", library->read_bytes, "}, \"tree\": {");
    print_count("primitives", library->primitive_count, ", ");
    print_count("nodes", library->node_count, ", ");
    print_count("leaves", library->leaf_count, ", ");
    print_count("bytes", library->tree_bytes, ", ");
    print_real("sah_cost", library->sah_cost, "}, \"memory\": {");
    print_count("allocated_peak", library->memory_peak, ", ");
    print_count("resident_peak", stats->resident_peak, "}}\n");
}
