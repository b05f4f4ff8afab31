/* SPDX-License-Identifier: MIT */
#include "why_columns.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

bool cli_column_add(CliColumn *column, uint32_t value) {
    if (column->count == column->capacity) {
        size_t capacity = column->capacity > 0 ? 2 * column->capacity : 1024;
        uint32_t *values = realloc(column->values, capacity * sizeof *values);
        if (values == NULL) return false;
        column->values = values;
        column->capacity = capacity;
    }
    column->values[column->count++] = value;
    return true;
}

bool cli_column_add_number(CliColumn *column, double value) {
    float number = (float)value;
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    bool finite = (bits & 0x7f800000u) != 0x7f800000u;
    if (finite) bits = (bits + 0x40u) & ~0x7fu;
    return cli_column_add(column, bits);
}

static size_t width_of(CliColumnType type) {
    return type == CLI_COLUMN_U8 ? 1 : type == CLI_COLUMN_U16 ? 2 : 4;
}

size_t cli_columns_size(const CliColumn *columns, int count) {
    size_t size = 0;
    for (int i = 0; i < count; i++) size += columns[i].count * width_of(columns[i].type);
    return size;
}

/* Bytes of like meaning come to lie side by side, which halves what zlib makes of floats. */
static uint8_t *put_planes(uint8_t *to, const CliColumn *column) {
    for (size_t plane = 0; plane < width_of(column->type); plane++) {
        for (size_t i = 0; i < column->count; i++) {
            *to++ = (uint8_t)(column->values[i] >> (8 * plane));
        }
    }
    return to;
}

void cli_base64_write(FILE *out, const uint8_t *bytes, size_t size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        uint32_t group = (uint32_t)bytes[i] << 16 | (left > 1 ? (uint32_t)bytes[i + 1] << 8 : 0) |
                         (left > 2 ? (uint32_t)bytes[i + 2] : 0);
        const char text[4] = {digits[group >> 18], digits[group >> 12 & 63],
            left > 1 ? digits[group >> 6 & 63] : '=', left > 2 ? digits[group & 63] : '='};
        fwrite(text, 1, sizeof text, out);
    }
}

bool cli_columns_write(FILE *out, const CliColumn *columns, int count) {
    static const char *const types[] = {"u8", "u16", "u32", "f32"};
    size_t size = cli_columns_size(columns, count);
    uLongf packed_size = compressBound((uLong)size);
    uint8_t *plain = malloc(size + 1), *packed = malloc(packed_size), *end = plain;
    bool good = plain != NULL && packed != NULL;
    for (int i = 0; i < count && good; i++) end = put_planes(end, &columns[i]);
    good = good && compress2(packed, &packed_size, plain, (uLong)size, 6) == Z_OK;
    fputs("\"columns\":[", out);
    for (int i = 0; i < count; i++) {
        fprintf(out, "%s[\"%s\",\"%s\",%zu]", i == 0 ? "" : ",", columns[i].name,
            types[columns[i].type], columns[i].count);
    }
    fputs("],\"data\":\"", out);
    if (good) cli_base64_write(out, packed, packed_size);
    fputc('"', out);
    free(plain);
    free(packed);
    return good;
}

void cli_columns_reset(CliColumn *columns, int count) {
    for (int i = 0; i < count; i++) free(columns[i].values);
}
