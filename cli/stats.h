/* SPDX-License-Identifier: MIT
 * The numbers of one picture, for people and for programs. */
#pragma once

#include "glint/glint.h"

#include "inputs.h"

typedef struct CliStats {
    const CliJob *job;
    GlintSceneInfo scene;
    GlintStats library;
    int width, height; /* of the whole picture */
    int crop_x, crop_y, crop_width, crop_height;
    double write_seconds, total_seconds;
    uint64_t resident_peak; /* bytes */
} CliStats;

/* The most memory the process has held so far, in bytes; 0 when the system does not tell. */
uint64_t cli_stats_resident_peak(void);

double cli_stats_rays_per_second(const CliStats *stats);

/* A table on standard error. */
void cli_stats_print_text(const CliStats *stats);

/* One object on one line of standard output. */
void cli_stats_print_json(const CliStats *stats);
