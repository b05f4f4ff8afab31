/* SPDX-License-Identifier: MIT
 * The line at the bottom of the terminal that says how far the picture is. */
#pragma once

#include "glint/glint.h"

typedef struct CliProgress {
    bool wanted;      /* false: every call does nothing */
    bool shown;       /* the line stands on the terminal */
    const char *name; /* of the scene */
    int index, count; /* this scene of how many */
    GlintPhase phase;
    int frame;    /* of the spinner */
    double began; /* the scene, in seconds of cli_clock */
    double phase_began;
    double drawn;        /* the line, the last time */
    uint64_t read_bytes; /* of a stream, whose end is not known */
} CliProgress;

/* Seconds since some fixed moment. */
double cli_clock(void);

void cli_progress_begin(CliProgress *progress, bool wanted, const char *name, int index, int count);

/* Shows where the phase stands; fraction < 0 when that is not known. Cheap: it draws at most ten
 * times a second, and not before a third of a second has gone by. */
void cli_progress_update(CliProgress *progress, GlintPhase phase, double fraction);

/* Takes the line away, so that something else can be printed. It may come back. */
void cli_progress_clear(CliProgress *progress);
