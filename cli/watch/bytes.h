/* SPDX-License-Identifier: MIT
 * Text and bytes that grow. A request that memory cannot fill empties nothing and is remembered, so
 * that only the whole has to be asked whether it is complete. */
#pragma once

#include "message.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct CliBytes {
    char *data; /* always with a zero behind it, unless null */
    size_t size, capacity;
    bool failed; /* something is missing */
} CliBytes;

void cli_bytes_add(CliBytes *bytes, const void *data, size_t size);
void cli_bytes_add_text(CliBytes *bytes, const char *text);
CLI_PRINTF(2, 3) void cli_bytes_format(CliBytes *bytes, const char *format, ...);

/* Forgets the content and keeps the memory. */
void cli_bytes_clear(CliBytes *bytes);
void cli_bytes_reset(CliBytes *bytes);

/* The text so far; "" when there is none. */
const char *cli_bytes_text(const CliBytes *bytes);
