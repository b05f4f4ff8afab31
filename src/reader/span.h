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

static inline GiSpan gi_span(const char *text) { return (GiSpan){text, strlen(text)}; }

/* Quickest with a literal, whose length is then known. */
static inline bool gi_span_is(GiSpan span, const char *text) {
    size_t size = strlen(text);
    return span.size == size && memcmp(span.data, text, size) == 0;
}
