/* SPDX-License-Identifier: MIT
 * Asks for memory that will be read soon. */
#pragma once

static inline void gi_prefetch(const void *address) {
#if defined(__GNUC__)
    __builtin_prefetch(address);
#else
    (void)address;
#endif
}
