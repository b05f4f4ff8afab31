/* SPDX-License-Identifier: MIT
 * What differs between two texts, line by line. */
#pragma once

#include "content.h"

/* Prints a unified diff from old to new on standard output, with three lines of context; in colours
 * on a terminal. Nothing when they are the same. */
CliStatus cli_diff_print(const char *name, const CliContent *old, const CliContent *new);
