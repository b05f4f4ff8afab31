/* SPDX-License-Identifier: MIT
 * Three ways, each exact, tried in order of speed (the first once more ahead of all, for numbers
 * that are written the way nearly all are):
 *
 *   1. The digits fit in 53 bits and the power of ten in a double: one rounding, done by the
 *      processor (Clinger 1990).
 *   2. The digits fit in 64 bits and 5^|exponent| too: one product or quotient of 128 bits. Longer
 *      digit strings are cut to 19 digits and bracketed: when the cut number and its successor
 *      round to the same double, so does all between.
 *   3. Whole numbers of any length, divided bit by bit. Slow, rare and short. */
#include "reader/number.h"

#include "math/digits.h"

#include <float.h>
#include <string.h>

typedef struct Decimal {
    const char *digits, *end; /* as written, with the point, without leading zeros */
    uint64_t leading;         /* value of the first 19 significant digits or fewer */
    int64_t exponent;         /* of ten, for `leading` */
    bool cut;                 /* more digits follow that are not all zero */
} Decimal;

/* The double nearest to (mantissa + sticky) * 2^exponent, where mantissa has its top bit set and
 * sticky stands for something between 0 and 1. Infinite when out of range. */
static double assemble(uint64_t mantissa, int exponent, bool sticky) {
    int top = exponent + 63;
    if (top < -1076) return 0;
    int shift = 64 - 53;
    if (top < -1022) shift += -1022 - top;
    uint64_t kept = shift >= 64 ? 0 : mantissa >> shift;
    uint64_t rest = shift >= 64 ? mantissa : mantissa & ((UINT64_C(1) << shift) - 1);
    if (shift <= 64) {
        uint64_t half = UINT64_C(1) << (shift - 1);
        if (rest > half || (rest == half && (sticky || (kept & 1) != 0))) kept++;
    }
    /* The implicit bit of `kept` adds one to the exponent field; so does a carry out of rounding.
     */
    uint64_t bits = kept + (top >= -1022 ? (uint64_t)(top + 1022) << 52 : 0);
    if (top > 1023 || bits > UINT64_C(0x7ff) << 52) bits = UINT64_C(0x7ff) << 52;
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static int leading_zeros(uint64_t x) {
    int count = 0;
    for (int step = 32; step > 0; step /= 2) {
        if (x >> (64 - step) == 0) {
            x <<= step;
            count += step;
        }
    }
    return count;
}

/* ---------------------------------------------------------------- 128 bits */

#if defined(__SIZEOF_INT128__)
__extension__ typedef unsigned __int128 Wide;

#define WIDE_EXPONENT 27 /* 5^27 < 2^63 */

/* Rounds a 128-bit value * 2^exponent. */
static double assemble_wide(Wide value, int exponent, bool sticky) {
    uint64_t high = (uint64_t)(value >> 64);
    int shift = high == 0 ? 64 : leading_zeros(high);
    if (shift == 64) shift += leading_zeros((uint64_t)value);
    value <<= shift;
    return assemble((uint64_t)(value >> 64), exponent + 64 - shift, sticky || (uint64_t)value != 0);
}

/* digits * 10^exponent for digits > 0 and |exponent| <= 27. */
static double convert_wide(uint64_t digits, int exponent) {
    uint64_t power = 1;
    for (int i = exponent < 0 ? -exponent : exponent; i > 0; i--) power *= 5;
    if (exponent >= 0) return assemble_wide((Wide)digits * power, exponent, false);
    int shift = leading_zeros(digits);
    Wide dividend = (Wide)(digits << shift) << 64;
    return assemble_wide(dividend / power, exponent - shift - 64, dividend % power != 0);
}
#else
#define WIDE_EXPONENT -1
static double convert_wide(uint64_t digits, int exponent) { return (double)digits * exponent; }
#endif

/* ---------------------------------------------------------------- any length */

/* A double is decided by its first 768 significant digits and whether anything follows. With these
 * limits the largest number below is 10^1127 or so. */
enum { DIGIT_LIMIT = 800, LIMB_COUNT = 160 };

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

static void big_multiply_power_of_ten(Big *big, int exponent) {
    for (; exponent >= 9; exponent -= 9) big_multiply_add(big, 1000000000, 0);
    for (; exponent > 0; exponent--) big_multiply_add(big, 10, 0);
}

static int big_bits(const Big *big) {
    return big->count * 32 - (leading_zeros(big->limb[big->count - 1]) - 32);
}

static void big_shift_left(Big *big, int shift) {
    int limbs = shift / 32, bits = shift % 32;
    if (limbs > 0) {
        memmove(big->limb + limbs, big->limb, (size_t)big->count * sizeof big->limb[0]);
        memset(big->limb, 0, (size_t)limbs * sizeof big->limb[0]);
        big->count += limbs;
    }
    if (bits > 0) big_multiply_add(big, UINT32_C(1) << bits, 0);
}

static bool big_less(const Big *a, const Big *b) {
    if (a->count != b->count) return a->count < b->count;
    for (int i = a->count - 1; i >= 0; i--) {
        if (a->limb[i] != b->limb[i]) return a->limb[i] < b->limb[i];
    }
    return false;
}

static void big_subtract(Big *a, const Big *b) {
    int64_t borrow = 0;
    for (int i = 0; i < a->count; i++) {
        int64_t difference = (int64_t)a->limb[i] - (i < b->count ? b->limb[i] : 0) + borrow;
        a->limb[i] = (uint32_t)difference;
        borrow = difference < 0 ? -1 : 0;
    }
    while (a->count > 0 && a->limb[a->count - 1] == 0) a->count--;
}

static double convert_exact(const Decimal *decimal, int64_t point_exponent) {
    Big number = {.count = 0}, divisor = {.limb = {1}, .count = 1};
    int count = 0;
    int64_t exponent = point_exponent; /* of ten, for the digits taken so far */
    bool sticky_digit = false;
    for (const char *p = decimal->digits; p < decimal->end; p++) {
        if (*p == '.') continue;
        if (count < DIGIT_LIMIT) {
            big_multiply_add(&number, 10, (uint32_t)(*p - '0'));
            count++;
            exponent--;
        } else {
            sticky_digit |= *p != '0';
        }
    }
    if (sticky_digit) {
        big_multiply_add(&number, 10, 1);
        exponent--;
    }
    if (exponent >= 0) {
        big_multiply_power_of_ten(&number, (int)exponent);
    } else {
        big_multiply_power_of_ten(&divisor, (int)-exponent);
    }
    /* Line up the top bits; the quotient is then in (1/2, 2). */
    int shift = big_bits(&number) - big_bits(&divisor);
    if (shift > 0) big_shift_left(&divisor, shift);
    if (shift < 0) big_shift_left(&number, -shift);
    if (big_less(&number, &divisor)) {
        big_shift_left(&number, 1);
        shift--;
    }
    uint64_t quotient = 0;
    for (int i = 0; i < 64; i++) {
        quotient <<= 1;
        if (!big_less(&number, &divisor)) {
            big_subtract(&number, &divisor);
            quotient |= 1;
        }
        big_shift_left(&number, 1);
    }
    return assemble(quotient, shift - 63, number.count > 0);
}

/* ---------------------------------------------------------------- reading */

/* The powers of ten that are doubles. */
static const double powers[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12,
    1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

static double convert(const Decimal *decimal, int64_t point_exponent) {
    uint64_t digits = decimal->leading;
    if (digits == 0) return 0;
#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD == 0
    if (!decimal->cut && digits <= UINT64_C(1) << 53) {
        if (decimal->exponent >= 0 && decimal->exponent <= 22) {
            return (double)digits * powers[decimal->exponent];
        }
        if (decimal->exponent < 0 && decimal->exponent >= -22) {
            return (double)digits / powers[-decimal->exponent];
        }
    }
#endif
    if (point_exponent > 310) return DBL_MAX * powers[22];
    if (point_exponent < -326) return 0;
    if (decimal->exponent >= -WIDE_EXPONENT && decimal->exponent <= WIDE_EXPONENT) {
        double value = convert_wide(digits, (int)decimal->exponent);
        if (!decimal->cut) return value;
        if (convert_wide(digits + 1, (int)decimal->exponent) == value) return value;
    }
    return convert_exact(decimal, point_exponent);
}

/* ---------------------------------------------------------------- eight digits at once */

#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD == 0

/* Up to eight characters from p on, the first in the lowest byte; zeros for those behind the end.
 * The text begins at least eight characters before the end. */
static uint64_t load_eight(const char *p, const char *end) {
    if (end - p >= 8) return gi_eight_load(p);
    return p < end ? gi_eight_load(end - 8) >> 8 * (8 - (end - p)) : 0;
}

/* A number of at most eight digits before the point and eight behind it, without an exponent:
 * nearly all are written so. False when it is something else. */
static bool read_plain(const char *text, size_t size, double *value, size_t *used) {
    if (size < 8) return false;
    const char *p = text, *end = text + size;
    bool negative = *p == '-';
    p += negative;
    /* Few and often as many as last time, so that this loop is quicker than eight at once. */
    const char *first = p;
    uint64_t digits = 0;
    while (p - text < 8 && gi_is_digit(*p)) digits = digits * 10 + (uint64_t)(*p++ - '0');
    int count = (int)(p - first), places = 0;
    if (p < end && *p == '.') {
        static const uint32_t shifts[] = {
            1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
        uint64_t fraction;
        p++;
        places = gi_digits_eight(load_eight(p, end), &fraction);
        p += places;
        digits = digits * shifts[places] + fraction;
    }
    bool more = p < end && (gi_is_digit(*p) || *p == 'e' || *p == 'E');
    if (more || count + places == 0 || digits > UINT64_C(1) << 53) return false;
    static const double signs[] = {1, -1}; /* nobody can foretell a branch on the sign */
    *value = (double)(int64_t)digits / powers[places] * signs[negative];
    *used = (size_t)(p - text);
    return true;
}
#else
static bool read_plain(const char *text, size_t size, double *value, size_t *used) {
    (void)text, (void)size, (void)value, (void)used;
    return false;
}
#endif

/* ---------------------------------------------------------------- the whole */

GiNumberStatus gi_number_read(const char *text, size_t size, double *value, size_t *used) {
    if (read_plain(text, size, value, used)) return GI_NUMBER_OK;
    const char *p = text, *end = text + size;
    bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) p++;

    Decimal decimal = {.digits = NULL};
    const char *point = NULL;
    int64_t digit_count = 0;    /* all digits, leading zeros too */
    int significant = 0;        /* digits in decimal.leading */
    int64_t point_exponent = 0; /* the number is 0.digits * 10^point_exponent */
    for (; p < end; p++) {
        if (*p == '.' && point == NULL) {
            point = p;
            continue;
        }
        if (!gi_is_digit(*p)) break;
        digit_count++;
        if (decimal.digits == NULL) {
            if (*p == '0') {
                if (point != NULL) point_exponent--;
                continue;
            }
            decimal.digits = p;
        }
        if (point == NULL) point_exponent++;
        if (significant < 19) {
            decimal.leading = decimal.leading * 10 + (uint64_t)(*p - '0');
            significant++;
        } else {
            decimal.cut |= *p != '0';
        }
    }
    *used = 0;
    if (digit_count == 0) return GI_NUMBER_MALFORMED;
    decimal.end = p;

    if (p < end && (*p == 'e' || *p == 'E')) {
        const char *q = p + 1;
        bool minus = q < end && *q == '-';
        if (q < end && (*q == '-' || *q == '+')) q++;
        if (q < end && gi_is_digit(*q)) {
            int64_t exponent = 0;
            for (; q < end && gi_is_digit(*q); q++) {
                if (exponent < 1000000000) exponent = exponent * 10 + (*q - '0');
            }
            point_exponent += minus ? -exponent : exponent;
            p = q;
        }
    }
    *used = (size_t)(p - text);
    decimal.exponent = point_exponent - significant;
    double magnitude = convert(&decimal, point_exponent);
    *value = negative ? -magnitude : magnitude;
    return magnitude > DBL_MAX ? GI_NUMBER_TOO_LARGE : GI_NUMBER_OK;
}
