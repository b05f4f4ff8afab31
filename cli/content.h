/* SPDX-License-Identifier: MIT
 * Whole files in memory, for the verbs that work on the text of scenes. */
#pragma once

#include "inputs.h"

#include <stdbool.h>

typedef struct CliContent {
    char *data; /* null: none */
    size_t size, capacity;
} CliContent;

/* Reads the scene of a job, a file or standard input; says what is wrong. */
CliStatus cli_content_load(CliContent *bytes, const CliJob *job);

/* Appends; a GlintSinkFn, whose user is the CliContent. False when memory is short. */
bool cli_content_append(void *bytes, const void *more, size_t size);

bool cli_content_equal(const CliContent *a, const CliContent *b);
void cli_content_reset(CliContent *bytes);
