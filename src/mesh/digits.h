/* SPDX-License-Identifier: MIT
 * Runs of digits, eight at a time: the processor guesses wrong where a run ends more often than
 * anything else in a file of numbers, and this way it need not guess. */
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

static inline bool gi_is_digit(char c) { return (unsigned char)(c - '0') <= 9; }

/* How many of the eight characters at p are digits, up to the first that is none, and their value.
 */
static inline int gi_digits_eight(const char *p, uint64_t *value) {
    uint64_t number = 0;
    int count = 0;
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    const uint64_t ones = UINT64_C(0x0101010101010101);
    const uint64_t pairs = UINT64_C(0x000000ff000000ff);
    uint64_t digits;
    memcpy(&digits, p, sizeof digits);
    digits ^= '0' * ones; /* digits become 0 to 9 */
    /* Exact up to the first that is none. */
    uint64_t others = ((digits + (0x80 - 10) * ones) | digits) & 0x80 * ones;
    count = others == 0 ? 8 : __builtin_ctzll(others) / 8;
    if (count > 0) {
        /* Zeros in front make it eight; then neighbours are joined, then pairs, then fours. */
        digits <<= 8 * (8 - count);
        digits = digits * 10 + (digits >> 8);
        number = ((digits & pairs) * (100 + (UINT64_C(1000000) << 32)) +
                     ((digits >> 16) & pairs) * (1 + (UINT64_C(10000) << 32))) >>
                 32;
    }
#else
    while (count < 8 && gi_is_digit(p[count])) number = number * 10 + (uint64_t)(p[count++] - '0');
#endif
    *value = number;
    return count;
}

/* Appends the digits at p to *value, which wraps when there are too many, and returns their end. */
static inline const char *gi_digits_read(const char *p, const char *end, uint64_t *value) {
    static const uint64_t powers[] = {
        1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
    uint64_t number = *value, next;
    while (end - p >= 8) {
        int count = gi_digits_eight(p, &next);
        number = number * powers[count] + next;
        p += count;
        if (count < 8) {
            *value = number;
            return p;
        }
    }
    for (; p < end && gi_is_digit(*p); p++) number = number * 10 + (uint64_t)(*p - '0');
    *value = number;
    return p;
}
