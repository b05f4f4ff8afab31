/* SPDX-License-Identifier: MIT
 * Whole files in memory, for the verbs that work on the text of scenes. */
#pragma once

#include "inputs.h"

#include <stdbool.h>

typedef struct CliBytes {
    char *data; /* null: none */
    size_t size, capacity;
} CliBytes;

/* Reads the scene of a job, a file or standard input; says what is wrong. */
CliStatus cli_bytes_load(CliBytes *bytes, const CliJob *job);

/* Appends; a GlintSinkFn, whose user is the CliBytes. False when memory is short. */
bool cli_bytes_append(void *bytes, const void *more, size_t size);

bool cli_bytes_equal(const CliBytes *a, const CliBytes *b);
void cli_bytes_reset(CliBytes *bytes);
