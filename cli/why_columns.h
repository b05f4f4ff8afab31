/* SPDX-License-Identifier: MIT
 * Numbers of one kind, one after the other, as a page's script wants them: a typed array. The
 * columns of a table are compressed together. */
#pragma once

#include "glint/glint.h"

#include <stdio.h>

typedef enum CliColumnType {
    CLI_COLUMN_U8,
    CLI_COLUMN_U16,
    CLI_COLUMN_U32,
    CLI_COLUMN_F32
} CliColumnType;

typedef struct CliColumn {
    const char *name;
    CliColumnType type;
    uint32_t *values; /* floats by their bits */
    size_t count, capacity;
} CliColumn;

/* Append; false when memory is short. A float keeps sixteen bits of its mantissa, five digits,
 * which is more than is read and much less to store. */
bool cli_column_add(CliColumn *column, uint32_t value);
bool cli_column_add_number(CliColumn *column, double value);

/* Bytes of all columns before they are compressed. */
size_t cli_columns_size(const CliColumn *columns, int count);

/* Writes `"columns":[["name","f32",count],...],"data":"..."`: one column behind the other, each
 * cut into planes, the lowest byte of every number, then the next; all that by zlib, in base64.
 * False when memory is short. */
bool cli_columns_write(FILE *out, const CliColumn *columns, int count);

void cli_columns_reset(CliColumn *columns, int count);

/* Base64 of RFC 4648. */
void cli_base64_write(FILE *out, const uint8_t *bytes, size_t size);
