/* SPDX-License-Identifier: MIT
 * Asks for memory that will be read soon. */
#pragma once

#include <stddef.h>
#include <stdint.h>

static inline void gi_prefetch(const void *address) {
#if defined(__GNUC__)
    __builtin_prefetch(address);
#else
    (void)address;
#endif
}

/* The same of what is `bytes` further on, which need not be there. */
static inline void gi_prefetch_ahead(const void *address, size_t bytes) {
    gi_prefetch((const void *)((uintptr_t)address + bytes));
}
