/* SPDX-License-Identifier: MIT */
#include "watch/bytes.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool reserve(CliBytes *bytes, size_t more) {
    if (more < bytes->capacity - bytes->size) return true;
    size_t capacity = bytes->capacity > 0 ? bytes->capacity : 256;
    while (capacity - bytes->size <= more) {
        if (capacity > SIZE_MAX / 2) return false;
        capacity *= 2;
    }
    char *data = realloc(bytes->data, capacity);
    if (data == NULL) return false;
    bytes->data = data;
    bytes->capacity = capacity;
    return true;
}

void cli_bytes_add(CliBytes *bytes, const void *data, size_t size) {
    if (!reserve(bytes, size)) {
        bytes->failed = true;
        return;
    }
    if (size > 0) memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
    bytes->data[bytes->size] = '\0';
}

void cli_bytes_add_text(CliBytes *bytes, const char *text) {
    cli_bytes_add(bytes, text, strlen(text));
}

void cli_bytes_format(CliBytes *bytes, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (length < 0 || !reserve(bytes, (size_t)length + 1)) {
        bytes->failed = true;
        return;
    }
    va_start(arguments, format);
    vsnprintf(bytes->data + bytes->size, (size_t)length + 1, format, arguments);
    va_end(arguments);
    bytes->size += (size_t)length;
}

void cli_bytes_clear(CliBytes *bytes) {
    bytes->size = 0;
    bytes->failed = false;
    if (bytes->data != NULL) bytes->data[0] = '\0';
}

void cli_bytes_reset(CliBytes *bytes) {
    free(bytes->data);
    *bytes = (CliBytes){0};
}

const char *cli_bytes_text(const CliBytes *bytes) { return bytes->data != NULL ? bytes->data : ""; }
