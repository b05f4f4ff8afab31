/* SPDX-License-Identifier: MIT
 * How each program is called, and what Glint says about itself. */
#pragma once

#include "contest.h"

enum { ARGUMENT_MAX = 20 };

typedef struct Command {
    char *arguments[ARGUMENT_MAX]; /* null at the end; they point into the struct */
    char texts[ARGUMENT_MAX][PATH_SIZE];
    char picture[PATH_SIZE], output[PATH_SIZE], error[PATH_SIZE];
} Command;

SceneFormat program_format(Program program);

/* Every program writes an 8-bit PNG; Glint a linear .pfm when exact is set. The scene's file is
 * made when it is missing. */
void program_command(const Field *field, const BenchScene *scene, Program program, int threads,
    bool exact, Command *command);

/* Fills the measures of the phases from what glint --stats=json or Tachyon left in the file, and of
 * Glint also what they were spent on. POV-Ray is silent. */
void program_phases(Program program, const char *output_path, Entry *entry, int rep);
