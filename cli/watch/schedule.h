/* SPDX-License-Identifier: MIT
 * From coarse to fine: which pictures are drawn one after the other until the one that was asked
 * for stands. The first comes so soon that a view can be turned by hand, each of the others costs
 * about four to sixteen times the one before, and the last is the picture of `glint render`. */
#pragma once

#include <stdbool.h>

typedef struct CliStep {
    int width, height;
    int samples;
    bool first, last; /* first: too soon to be interrupted */
} CliStep;

typedef struct CliSchedule {
    int width, height, samples; /* asked for */
    int divisor, side;          /* of the last step: of the size; of the grid of samples */
    bool begun, ended;
    double cost; /* seconds a sample, as the last step had it; 0: not known yet */
} CliSchedule;

/* Begins with a picture; what samples cost is kept from the one before. */
void cli_schedule_begin(CliSchedule *schedule, int width, int height, int samples);

/* The next step, or false when the last has been given. */
bool cli_schedule_next(CliSchedule *schedule, CliStep *step);

/* What a step has cost, or a part of it (its share, above 0, at most 1). */
void cli_schedule_measure(CliSchedule *schedule, const CliStep *step, double seconds, double share);
