/* SPDX-License-Identifier: MIT */
#include "watch/schedule.h"

#include <math.h>

enum {
    DIVISOR_LIMIT = 32,
    UNKNOWN_PIXELS = 20000 /* of a first step when nothing is known */
};

/* Seconds. A picture at once that takes no longer; the first of those that take longer; and the
 * longest that needs no picture in between. */
static const double at_once = 0.04, first_look = 0.025, no_step_between = 0.25;

static int grid_side(int samples) {
    int side = (int)(sqrt((double)samples) + 0.5);
    return side > 1 ? side : 1;
}

static double cost_of(const CliSchedule *schedule, int divisor, int side) {
    double pixels = (double)schedule->width * schedule->height / ((double)divisor * divisor);
    return pixels * side * side * schedule->cost;
}

void cli_schedule_begin(CliSchedule *schedule, int width, int height, int samples) {
    double cost = schedule->cost;
    *schedule = (CliSchedule){.width = width, .height = height, .samples = samples, .cost = cost};
}

static void choose_first(CliSchedule *schedule) {
    bool known = schedule->cost > 0;
    schedule->divisor = 1;
    schedule->side = grid_side(schedule->samples);
    if (known && cost_of(schedule, 1, schedule->side) <= at_once) return;
    schedule->side = 1;
    for (; schedule->divisor < DIVISOR_LIMIT; schedule->divisor *= 2) {
        double square = (double)schedule->divisor * schedule->divisor;
        double pixels = (double)schedule->width * schedule->height / square;
        if (known ? pixels * schedule->cost <= first_look : pixels <= UNKNOWN_PIXELS) break;
    }
}

static void choose_next(CliSchedule *schedule) {
    int side = grid_side(schedule->samples);
    if (cost_of(schedule, 1, side) <= no_step_between) {
        schedule->divisor = 1;
        schedule->side = side;
    } else if (schedule->divisor > 1) {
        schedule->divisor = schedule->divisor > 4 ? schedule->divisor / 4 : 1;
    } else {
        /* What would be more than half of the last step is not worth a step. */
        schedule->side *= 2;
        if (2 * schedule->side * schedule->side > side * side) schedule->side = side;
    }
}

static int divided(int size, int divisor) { return (size + divisor - 1) / divisor; }

bool cli_schedule_next(CliSchedule *schedule, CliStep *step) {
    if (schedule->ended) return false;
    bool first = !schedule->begun;
    schedule->begun = true;
    if (first) {
        choose_first(schedule);
    } else {
        choose_next(schedule);
    }
    bool last = schedule->divisor == 1 && schedule->side == grid_side(schedule->samples);
    schedule->ended = last;
    *step = (CliStep){.width = divided(schedule->width, schedule->divisor),
        .height = divided(schedule->height, schedule->divisor),
        .samples = last ? schedule->samples : schedule->side * schedule->side,
        .first = first,
        .last = last};
    return true;
}

void cli_schedule_measure(
    CliSchedule *schedule, const CliStep *step, double seconds, double share) {
    int side = grid_side(step->samples);
    double samples = (double)step->width * step->height * side * side * share;
    if (samples > 0 && seconds > 0) schedule->cost = seconds / samples;
}
