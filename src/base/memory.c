/* SPDX-License-Identifier: MIT */
#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

static void *heap_reallocate(void *user, void *pointer, size_t old_size, size_t new_size) {
    (void)user;
    (void)old_size;
    if (new_size == 0) {
        free(pointer);
        return NULL;
    }
    return realloc(pointer, new_size);
}

void gi_memory_init(GiMemory *memory, const GlintAllocator *allocator, size_t limit) {
    memory->allocator =
        allocator != NULL ? *allocator : (GlintAllocator){.reallocate = heap_reallocate};
    memory->limit = limit != 0 ? limit : SIZE_MAX;
    atomic_init(&memory->used, 0);
    atomic_init(&memory->peak, 0);
}

void *gi_memory_resize(GiMemory *memory, void *pointer, size_t old_size, size_t new_size) {
    if (new_size > old_size) {
        size_t more = new_size - old_size;
        size_t used = atomic_fetch_add(&memory->used, more) + more;
        if (used > memory->limit || used < more) {
            atomic_fetch_sub(&memory->used, more);
            return NULL;
        }
        size_t peak = atomic_load(&memory->peak);
        while (used > peak && !atomic_compare_exchange_weak(&memory->peak, &peak, used)) {}
    }
    void *result =
        memory->allocator.reallocate(memory->allocator.user, pointer, old_size, new_size);
    if (new_size > old_size && result == NULL) atomic_fetch_sub(&memory->used, new_size - old_size);
    if (new_size < old_size && (result != NULL || new_size == 0)) {
        atomic_fetch_sub(&memory->used, old_size - new_size);
    }
    return result;
}

/* The block begins up to 64 bytes before the line; its address is kept just before the line. */
enum { LINE = 64, LINE_EXTRA = LINE + sizeof(void *) };

void *gi_memory_allocate_lines(GiMemory *memory, size_t count, size_t size) {
    size_t bytes;
    if (!gi_size_multiply(count, size, &bytes) || bytes > SIZE_MAX - LINE_EXTRA) return NULL;
    char *block = gi_memory_allocate(memory, bytes + LINE_EXTRA);
    if (block == NULL) return NULL;
    uintptr_t line = ((uintptr_t)block + LINE_EXTRA) & ~(uintptr_t)(LINE - 1);
    memcpy((char *)line - sizeof block, &block, sizeof block);
    return (void *)line;
}

void gi_memory_free_lines(GiMemory *memory, void *pointer, size_t count, size_t size) {
    if (pointer == NULL) return;
    char *block;
    memcpy(&block, (char *)pointer - sizeof block, sizeof block);
    gi_memory_free(memory, block, count * size + LINE_EXTRA);
}
