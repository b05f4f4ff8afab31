/* SPDX-License-Identifier: MIT
 * Eight bytes as a number, the first of them lowest on every machine. */
#pragma once

#include <stdint.h>
#include <string.h>

static inline uint64_t gi_eight_load(const char *p) {
    uint64_t eight = 0;
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    memcpy(&eight, p, sizeof eight);
#else
    for (int i = 0; i < 8; i++) eight |= (uint64_t)(unsigned char)p[i] << (8 * i);
#endif
    return eight;
}
