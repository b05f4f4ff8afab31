/* SPDX-License-Identifier: MIT */
#include "base/array.h"

bool gi_array_reserve_bytes(
    GiMemory *memory, void **data, size_t *capacity, size_t count, size_t more, size_t size) {
    if (more <= *capacity - count) return true;
    if (more > SIZE_MAX - count) return false;
    size_t wanted = *capacity < 8 ? 8 : *capacity * 2;
    if (wanted < count + more) wanted = count + more;
    size_t bytes;
    if (!gi_size_multiply(wanted, size, &bytes)) return false;
    /* realloc moves large blocks by remapping pages, so that growth costs no second copy. */
    void *grown = gi_memory_resize(memory, *data, *capacity * size, bytes);
    if (grown == NULL) return false;
    *data = grown;
    *capacity = wanted;
    return true;
}
