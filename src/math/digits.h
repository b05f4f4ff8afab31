/* SPDX-License-Identifier: MIT
 * Runs of digits, eight at a time: the processor guesses wrong where a run ends more often than
 * anything else in a file of numbers, and this way it need not guess. */
#pragma once

#include "math/eight.h"

#include <stdbool.h>
#include <stdint.h>

static inline bool gi_is_digit(char c) { return (unsigned char)(c - '0') <= 9; }

/* How many of eight characters are digits, up to the first that is none, and their value: no loop,
 * whose length could not be foretold. */
static inline int gi_digits_eight(uint64_t eight, uint64_t *value) {
    const uint64_t ones = UINT64_C(0x0101010101010101);
    const uint64_t pairs = UINT64_C(0x000000ff000000ff);
    uint64_t digits = eight ^ '0' * ones; /* 0 to 9, and what is no digit more */
    uint64_t others = ((digits + (0x80 - 10) * ones) | digits) & 0x80 * ones;
    int count = others == 0 ? 8 : __builtin_ctzll(others) / 8;
    *value = 0;
    if (count == 0) return 0;
    /* Zeros in front make it eight; then neighbours are joined, then pairs, then fours. */
    digits <<= 8 * (8 - count);
    digits = digits * 10 + (digits >> 8);
    *value = ((digits & pairs) * (100 + (UINT64_C(1000000) << 32)) +
                 ((digits >> 16) & pairs) * (1 + (UINT64_C(10000) << 32))) >>
             32;
    return count;
}

/* Appends the digits at p to *value, which wraps when there are too many, and returns their end. */
static inline const char *gi_digits_read(const char *p, const char *end, uint64_t *value) {
    static const uint64_t powers[] = {
        1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
    uint64_t number = *value, next;
    while (end - p >= 8) {
        int count = gi_digits_eight(gi_eight_load(p), &next);
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
