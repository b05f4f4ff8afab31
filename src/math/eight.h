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

/* The highest bit of each byte that is a blank or one of the five from tab to carriage return. */
static inline uint64_t gi_eight_space(uint64_t eight) {
    const uint64_t ones = UINT64_C(0x0101010101010101), high = ones * 0x80;
    uint64_t low = eight & ~high; /* no sum below carries into the next byte */
    uint64_t control = (low + ones * (0x80 - '\t')) & ~(low + ones * (0x80 - '\r' - 1));
    uint64_t blank = ~((low ^ ones * ' ') + ones * 0x7f);
    return (control | blank) & ~eight & high;
}
