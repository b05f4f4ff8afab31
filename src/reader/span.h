/* SPDX-License-Identifier: MIT
 * A piece of a longer text: it does not end with a zero, and is not to be kept. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

typedef struct GiSpan {
    const char *data;
    size_t size;
} GiSpan;

typedef struct GiAttribute {
    GiSpan name, value;
} GiAttribute;

/* Copying and comparing short text, eight bytes or four at a time, the last of them over again. A
 * call of the C library, or what compilers make of one, takes longer to begin. */
static inline void gi_span_copy(GiSpan from, char *to) {
    const char *data = from.data;
    size_t size = from.size, i = 0;
    if (size >= 8) {
        for (; i + 8 < size; i += 8) memcpy(to + i, data + i, 8);
        memcpy(to + size - 8, data + size - 8, 8);
    } else if (size >= 4) {
        memcpy(to, data, 4);
        memcpy(to + size - 4, data + size - 4, 4);
    } else {
        for (; i < size; i++) to[i] = data[i];
    }
}

static inline bool gi_span_equals(GiSpan span, const char *text) {
    const char *data = span.data;
    size_t size = span.size, i = 0;
    if (size >= 8) {
        for (; i + 8 < size; i += 8) {
            if (memcmp(data + i, text + i, 8) != 0) return false;
        }
        return memcmp(data + size - 8, text + size - 8, 8) == 0;
    }
    if (size >= 4) {
        return memcmp(data, text, 4) == 0 && memcmp(data + size - 4, text + size - 4, 4) == 0;
    }
    for (; i < size; i++) {
        if (data[i] != text[i]) return false;
    }
    return true;
}

static inline GiSpan gi_span(const char *text) { return (GiSpan){text, strlen(text)}; }

/* Quickest with a literal, whose length is then known. */
static inline bool gi_span_is(GiSpan span, const char *text) {
    size_t size = strlen(text);
    return span.size == size && memcmp(span.data, text, size) == 0;
}
