/* SPDX-License-Identifier: MIT
 * Growable arrays of plain structs: a pointer, a count and a capacity that live in the owner. */
#pragma once

#include "base/memory.h"

/* Makes room for `more` further elements; doubles the capacity when it has to grow. False (and
 * nothing changed) when memory is short. */
bool gi_array_reserve_bytes(
    GiMemory *memory, void **data, size_t *capacity, size_t count, size_t more, size_t size);

/* Declares an array member triple: GI_ARRAY(GiSphere) spheres; */
#define GI_ARRAY(Type)                                                                             \
    struct {                                                                                       \
        Type *data;                                                                                \
        size_t count, capacity;                                                                    \
    }

/* An expression that evaluates its arguments more than once: mostly there is room, and no call. */
#define gi_array_reserve(memory, array, more)                                                      \
    ((size_t)(more) <= (array)->capacity - (array)->count ||                                       \
        gi_array_reserve_bytes((memory), (void **)&(array)->data, &(array)->capacity,              \
            (array)->count, (more), sizeof *(array)->data))

/* Appends one element, by value. An expression: false when memory is short. */
#define gi_array_push(memory, array, ...)                                                          \
    (gi_array_reserve((memory), (array), 1)                                                        \
            ? ((array)->data[(array)->count++] = (__VA_ARGS__), true)                              \
            : false)

#define gi_array_free(memory, array)                                                               \
    (gi_memory_free((memory), (array)->data, (array)->capacity * sizeof *(array)->data),           \
        (array)->data = NULL, (array)->count = (array)->capacity = 0)
