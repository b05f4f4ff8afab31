/* SPDX-License-Identifier: MIT
 * Runs of digits, eight at a time: the processor guesses wrong where a run ends more often than
 * anything else in a file of numbers, and this way it need not guess. */
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

static inline bool gi_is_digit(char c) { return (unsigned char)(c - '0') <= 9; }

/* Appends the digits at p to *value, which wraps when there are too many, and returns their end. */
static inline const char *gi_digits_read(const char *p, const char *end, uint64_t *value) {
    uint64_t number = *value;
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    static const uint64_t powers[] = {
        1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
    while (end - p >= 8) {
        uint64_t bytes;
        memcpy(&bytes, p, sizeof bytes);
        bytes ^= UINT64_C(0x3030303030303030); /* digits become 0 to 9 */
        uint64_t others = ((bytes + UINT64_C(0x7676767676767676)) | bytes) &
                          UINT64_C(0x8080808080808080); /* exact up to the first that is none */
        int count = others != 0 ? __builtin_ctzll(others) / 8 : 8;
        if (count == 0) break;
        /* Zeros in front make it eight; then neighbours are joined to pairs, fours, eights. */
        bytes <<= 64 - 8 * count;
        bytes = (bytes * 10 + (bytes >> 8)) & UINT64_C(0x00ff00ff00ff00ff);
        bytes = (bytes * 100 + (bytes >> 16)) & UINT64_C(0x0000ffff0000ffff);
        bytes = (bytes * 10000 + (bytes >> 32)) & UINT64_C(0xffffffff);
        number = number * powers[count] + bytes;
        p += count;
        if (count < 8) {
            *value = number;
            return p;
        }
    }
#endif
    for (; p < end && gi_is_digit(*p); p++) number = number * 10 + (uint64_t)(*p - '0');
    *value = number;
    return p;
}
