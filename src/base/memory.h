/* SPDX-License-Identifier: MIT
 * The one door to the heap: counts what is in use, refuses to pass a limit, and lets a caller (or
 * a test that makes the Nth request fail) replace the allocator. Safe from several threads. */
#pragma once

#include "glint/glint.h"

#include <stdatomic.h>

typedef struct GiMemory {
    GlintAllocator allocator;
    size_t limit; /* bytes in use at once */
    _Atomic size_t used, peak;
} GiMemory;

/* allocator null: the C library's. limit 0: none. */
void gi_memory_init(GiMemory *memory, const GlintAllocator *allocator, size_t limit);

/* Like realloc, but the old size is told and new_size 0 frees. Null when there is no more memory;
 * the old block is then untouched. */
void *gi_memory_resize(GiMemory *memory, void *pointer, size_t old_size, size_t new_size);

static inline void *gi_memory_allocate(GiMemory *memory, size_t size) {
    return gi_memory_resize(memory, NULL, 0, size);
}

static inline void gi_memory_free(GiMemory *memory, void *pointer, size_t size) {
    if (pointer != NULL) gi_memory_resize(memory, pointer, size, 0);
}

/* count * size bytes at an address that is a multiple of 64 (one cache line). Freed with the
 * same count and size. Null when there is no more memory or the product overflows. */
void *gi_memory_allocate_lines(GiMemory *memory, size_t count, size_t size);
void gi_memory_free_lines(GiMemory *memory, void *pointer, size_t count, size_t size);

/* False when a * b overflows. */
static inline bool gi_size_multiply(size_t a, size_t b, size_t *product) {
    if (b != 0 && a > SIZE_MAX / b) return false;
    *product = a * b;
    return true;
}
