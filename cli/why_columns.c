/* SPDX-License-Identifier: MIT
 * zlib is asked for only when a page is made: what is linked would be loaded at every start. Where
 * there is none, the bytes are stored as they are, in the same format (RFC 1950, RFC 1951). */
#include "why_columns.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

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

/* ---------------------------------------------------------------- compression */

typedef struct Bytes {
    uint8_t *data; /* null: there was no memory */
    size_t size;
} Bytes;

enum { STORED_LIMIT = 65535 }; /* bytes of a stored block */

static Bytes stored(const uint8_t *plain, size_t size) {
    size_t blocks = size / STORED_LIMIT + 1;
    Bytes packed = {malloc(2 + 5 * blocks + size + 4), 0};
    if (packed.data == NULL) return packed;
    uint8_t *to = packed.data;
    uint32_t a = 1, b = 0; /* Adler's sum */
    *to++ = 0x78, *to++ = 0x01;
    for (size_t block = 0; block < blocks; block++) {
        size_t left = size - block * STORED_LIMIT;
        size_t length = left < STORED_LIMIT ? left : STORED_LIMIT;
        *to++ = block + 1 == blocks;
        *to++ = length & 255, *to++ = (uint8_t)(length >> 8);
        *to++ = ~length & 255, *to++ = (uint8_t)(~length >> 8);
        memcpy(to, plain + block * STORED_LIMIT, length);
        to += length;
    }
    for (size_t i = 0; i < size; i++) {
        a = (a + plain[i]) % 65521;
        b = (b + a) % 65521;
    }
    *to++ = (uint8_t)(b >> 8), *to++ = b & 255, *to++ = (uint8_t)(a >> 8), *to++ = a & 255;
    packed.size = (size_t)(to - packed.data);
    return packed;
}

/* By zlib's compress2. False: there is no zlib, or no memory. */
static bool deflated(const uint8_t *plain, size_t size, Bytes *packed) {
    int (*compress)(uint8_t *, unsigned long *, const uint8_t *, unsigned long, int);
    enum { LEVEL = 6 };
    void *library = dlopen("libz.so.1", RTLD_NOW | RTLD_LOCAL);
    void *symbol = library != NULL ? dlsym(library, "compress2") : NULL;
    unsigned long room = (unsigned long)(size + size / 1000 + 64); /* more than compressBound */
    *packed = (Bytes){symbol != NULL ? malloc(room) : NULL, 0};
    bool good = packed->data != NULL;
    if (good) {
        memcpy(&compress, &symbol, sizeof compress); /* C knows no cast from data to function */
        good = compress(packed->data, &room, plain, (unsigned long)size, LEVEL) == 0;
        packed->size = room;
    }
    if (!good) free(packed->data);
    if (library != NULL) dlclose(library);
    return good;
}

/* ---------------------------------------------------------------- the table */

bool cli_columns_write(FILE *out, const CliColumn *columns, int count) {
    static const char *const types[] = {"u8", "u16", "u32", "f32"};
    size_t size = cli_columns_size(columns, count);
    uint8_t *plain = malloc(size + 1), *end = plain;
    if (plain == NULL) return false;
    for (int i = 0; i < count; i++) end = put_planes(end, &columns[i]);
    Bytes packed;
    if (!deflated(plain, size, &packed)) packed = stored(plain, size);
    fputs("\"columns\":[", out);
    for (int i = 0; i < count; i++) {
        fprintf(out, "%s[\"%s\",\"%s\",%zu]", i == 0 ? "" : ",", columns[i].name,
            types[columns[i].type], columns[i].count);
    }
    fputs("],\"data\":\"", out);
    cli_base64_write(out, packed.data, packed.size);
    fputc('"', out);
    free(plain);
    free(packed.data);
    return packed.data != NULL;
}

void cli_columns_reset(CliColumn *columns, int count) {
    for (int i = 0; i < count; i++) free(columns[i].values);
}
