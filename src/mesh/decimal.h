/* SPDX-License-Identifier: MIT
 * Decimal text to single precision, rounded once, to the nearest (ties to even), independent of
 * the locale. By way of a double it would be rounded twice, which is wrong for a few. */
#pragma once

#include "math/bits.h"
#include "math/digits.h"

#include <stddef.h>

/* Powers of ten that a double holds exactly. */
enum { GI_DECIMAL_POWER_LIMIT = 22, GI_DECIMAL_CERTAIN_DIGITS = 18 };
extern const double gi_decimal_powers[GI_DECIMAL_POWER_LIMIT + 1];

/* Whether a double with an error of up to 8 units in the last place rounds to the float that the
 * exact number rounds to. Below the normal floats the middles lie elsewhere. */
static inline bool gi_decimal_is_decided(double value) {
    uint32_t rest = (uint32_t)gi_bits_of(value) & 0x1fffffff;
    return rest - (0x10000000 - 8) > 16 && value >= 0x1p-126;
}

/* What gi_decimal_read does, for any number. */
const char *gi_decimal_read_any(const char *text, const char *end, float *value);

/* The same for a sign, few digits before the point and up to sixteen behind it, which nearly all
 * numbers are made of. Null for others; what follows is not looked at. The text goes on for at
 * least GI_DECIMAL_LOOK bytes. */
enum { GI_DECIMAL_LOOK = 32 };
static inline const char *gi_decimal_read_plain(const char *text, float *value) {
    static const uint64_t shifts[] = {
        1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
    static const float signs[] = {1, -1}; /* nobody can foretell a branch on the sign */
    bool negative = *text == '-';
    const char *p = text + negative, *first = p;
    uint64_t digits = 0, more;
    /* Few and often as many as last time, so that this loop is quicker than eight at once. */
    while (gi_is_digit(*p)) {
        digits = digits * 10 + (uint64_t)(*p - '0');
        if (++p - first > 9) return NULL;
    }
    int count = (int)(p - first), places = 0;
    if (*p == '.') {
        p++;
        places = gi_digits_eight(gi_eight_load(p), &more);
        p += places;
        digits = digits * shifts[places] + more;
        if (places == 8) {
            int rest = gi_digits_eight(gi_eight_load(p), &more);
            p += rest;
            places += rest;
            digits = digits * shifts[rest] + more;
        }
    }
    count += places;
    if (count == 0 || count > GI_DECIMAL_CERTAIN_DIGITS) return NULL;
    double quotient = (double)(int64_t)digits / gi_decimal_powers[places];
    if (!gi_decimal_is_decided(quotient) && digits != 0) return NULL;
    *value = (float)quotient * signs[negative];
    return p;
}

/* Reads the longest number at the start of text: an optional sign, digits with an optional point
 * (at least one digit), an optional exponent. Returns its end; null when no number begins here. No
 * hexadecimal, no infinity, no nan. What is too large becomes infinite, what is too small zero. */
static inline const char *gi_decimal_read(const char *text, const char *end, float *value) {
    if (end - text >= GI_DECIMAL_LOOK) {
        const char *p = gi_decimal_read_plain(text, value);
        if (p != NULL && !gi_is_digit(*p) && *p != 'e' && *p != 'E') return p;
    }
    return gi_decimal_read_any(text, end, value);
}
