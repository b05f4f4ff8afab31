/* SPDX-License-Identifier: MIT
 * A number is first computed in double, with an error of a few units in the last place. Rounding
 * that to single precision is right unless the double lies about half-way between two floats;
 * then whole numbers of any length tell on which side of the middle the decimal number is. */
#include "mesh/decimal.h"

#include <math.h> /* INFINITY */

typedef struct Decimal {
    const char *digits, *end; /* as written, with the point, without leading zeros */
    uint64_t leading;         /* value of the first 19 significant digits or fewer */
    int significant;          /* how many those are */
    int64_t exponent;         /* the number is 0.digits * 10^exponent */
} Decimal;

const double gi_decimal_powers[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* ---------------------------------------------------------------- any length */

/* The middle of two floats has at most 113 significant digits, so what follows the first 120 of a
 * number matters only in whether it is zero. With these limits nothing below exceeds 2^800. */
enum { DIGIT_LIMIT = 120, LIMB_COUNT = 28 };

typedef struct Big {
    uint32_t limb[LIMB_COUNT]; /* least significant first */
    int count;                 /* without leading zeros */
} Big;

static void big_multiply_add(Big *big, uint32_t factor, uint32_t addend) {
    uint64_t carry = addend;
    for (int i = 0; i < big->count; i++) {
        carry += (uint64_t)big->limb[i] * factor;
        big->limb[i] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry != 0) big->limb[big->count++] = (uint32_t)carry;
}

static void big_multiply_power(Big *big, uint32_t base, int exponent) {
    for (; exponent > 0; exponent--) big_multiply_add(big, base, 0);
}

static int big_compare(const Big *a, const Big *b) {
    if (a->count != b->count) return a->count < b->count ? -1 : 1;
    for (int i = a->count - 1; i >= 0; i--) {
        if (a->limb[i] != b->limb[i]) return a->limb[i] < b->limb[i] ? -1 : 1;
    }
    return 0;
}

/* The digits as a whole number; returns how many were taken. */
static int big_from_digits(Big *big, const Decimal *decimal) {
    int count = 0;
    bool rest = false;
    for (const char *p = decimal->digits; p < decimal->end; p++) {
        if (*p == '.') continue;
        if (count == DIGIT_LIMIT) {
            rest |= *p != '0';
        } else {
            big_multiply_add(big, 10, (uint32_t)(*p - '0'));
            count++;
        }
    }
    if (rest) big_multiply_add(big, 10, 1);
    return count + rest;
}

/* The sign of decimal - middle, where middle = m * 2^e with a whole number m below 2^32. Powers of
 * five and two go to the side where they are whole. */
static int compare(const Decimal *decimal, double middle) {
    uint64_t bits = gi_bits_of(middle);
    uint32_t mantissa = (uint32_t)(bits >> 21) | UINT32_C(1) << 31;
    Big left = {.count = 0}, right = {.limb = {mantissa}, .count = 1};
    int ten = (int)decimal->exponent - big_from_digits(&left, decimal);
    int two = ten - ((int)(bits >> 52) - 1023 - 31);
    big_multiply_power(ten > 0 ? &left : &right, 5, ten > 0 ? ten : -ten);
    big_multiply_power(two > 0 ? &left : &right, 2, two > 0 ? two : -two);
    return big_compare(&left, &right);
}

/* The middle between the two floats round a positive double. */
static double middle_near(double value) {
    if (value < 0x1p-126) return ((double)(uint32_t)(value * 0x1p149) + 0.5) * 0x1p-149;
    return gi_from_bits((gi_bits_of(value) & ~UINT64_C(0x1fffffff)) | 0x10000000);
}

/* ---------------------------------------------------------------- rounding */

static float to_float(double value) { return value >= 0x1.ffffffp127 ? INFINITY : (float)value; }

/* For leading > 0. */
static float convert(const Decimal *decimal) {
    /* 10^39 is infinite, and 10^-46 less than half of the smallest float. */
    if (decimal->exponent > 39) return INFINITY;
    if (decimal->exponent < -45) return 0;
    int exponent = (int)decimal->exponent - decimal->significant;
    double value = (double)decimal->leading;
    for (; exponent < -GI_DECIMAL_POWER_LIMIT; exponent += GI_DECIMAL_POWER_LIMIT)
        value /= gi_decimal_powers[GI_DECIMAL_POWER_LIMIT];
    for (; exponent > GI_DECIMAL_POWER_LIMIT; exponent -= GI_DECIMAL_POWER_LIMIT)
        value *= gi_decimal_powers[GI_DECIMAL_POWER_LIMIT];
    value =
        exponent < 0 ? value / gi_decimal_powers[-exponent] : value * gi_decimal_powers[exponent];
    if (gi_decimal_is_decided(value)) return to_float(value);
    double middle = middle_near(value);
    int side = compare(decimal, middle);
    return to_float(gi_from_bits(gi_bits_of(middle) + (uint64_t)(int64_t)side));
}

/* ---------------------------------------------------------------- reading */

static const char *read_exponent(const char *p, const char *end, int64_t *exponent) {
    if (p == end || (*p != 'e' && *p != 'E')) return p;
    const char *q = p + 1;
    bool minus = q < end && *q == '-';
    if (q < end && (*q == '-' || *q == '+')) q++;
    if (q == end || !gi_is_digit(*q)) return p;
    int64_t value = 0;
    for (; q < end && gi_is_digit(*q); q++) {
        if (value < INT64_C(1) << 59) value = value * 10 + (*q - '0');
    }
    *exponent += minus ? -value : value;
    return q;
}

const char *gi_decimal_read_any(const char *text, const char *end, float *value) {
    const char *p = text;
    bool negative = p < end && *p == '-';
    p += negative | (p < end && *p == '+');
    Decimal decimal = {.digits = NULL};
    const char *point = NULL;
    int64_t count = 0; /* of all digits, leading zeros too */
    for (; p < end; p++) {
        if (*p == '.' && point == NULL) {
            point = p;
            continue;
        }
        if (!gi_is_digit(*p)) break;
        count++;
        if (decimal.digits == NULL) {
            if (*p == '0') {
                decimal.exponent -= point != NULL;
                continue;
            }
            decimal.digits = p;
        }
        decimal.exponent += point == NULL;
        if (decimal.significant < 19) {
            decimal.leading = decimal.leading * 10 + (uint64_t)(*p - '0');
            decimal.significant++;
        }
    }
    if (count == 0) return NULL;
    decimal.end = p;
    p = read_exponent(p, end, &decimal.exponent);
    *value = (decimal.leading > 0 ? convert(&decimal) : 0) * (float)(1 - 2 * negative);
    return p;
}
