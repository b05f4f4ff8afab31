/* SPDX-License-Identifier: MIT
 * Which scenes are drawn, and where their pictures go. */
#pragma once

#include "verb.h"

typedef struct CliJob {
    char *scene;   /* a path, or "-" */
    char *picture; /* a path that ends in .png, .pfm or .exr */
} CliJob;

typedef struct CliJobs {
    CliJob *items;
    int count, capacity;
} CliJobs;

/* Turns the operands into jobs, folders spread out; output is the value of --output, or null;
 * ending, such as ".png", is what a picture that it does not name has behind the scene's name. Says
 * what is wrong; with CLI_INPUT the jobs that are right can still be done. */
CliStatus cli_jobs_init(
    CliJobs *jobs, const CliOperands *scenes, const char *output, const char *ending);

/* The same of what draws no picture: the jobs have none. */
CliStatus cli_jobs_init_plain(CliJobs *jobs, const CliOperands *scenes);
void cli_jobs_reset(CliJobs *jobs);

bool cli_job_reads_standard_input(const CliJob *job);

/* What messages and pictures call the scene: its path, or "stdin". */
const char *cli_job_name(const CliJob *job);

/* The part of a path behind the last slash. */
const char *cli_path_base(const char *path);
