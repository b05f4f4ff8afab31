/* SPDX-License-Identifier: MIT */
#include "math/elementary.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

static uint64_t bits_of(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static double from_bits(uint64_t bits) {
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* log2 of a positive, finite, normal number as a sum high + low, high being the whole part plus the
 * leading term. log2 m = 2/ln 2 * (s + s^3/3 + s^5/5 + ...), s = (m-1)/(m+1), m in [0.707, 1.414],
 * so |s| < 0.1716 and the terms after s^19 are below 1e-17 relative. */
static void log2_parts(double value, double *whole, double *fraction) {
    uint64_t bits = bits_of(value);
    int exponent = (int)(bits >> 52) - 1023;
    double m = from_bits((bits & 0x000fffffffffffffu) | 0x3ff0000000000000u);
    if (m > 1.4142135623730951) {
        m *= 0.5;
        exponent++;
    }
    double s = (m - 1) / (m + 1);
    double q = s * s;
    double tail = 1.0 / 21;
    for (int odd = 19; odd >= 3; odd -= 2) tail = tail * q + 1.0 / odd;
    const double scale = 2.8853900817779268; /* 2 / ln 2 */
    *whole = exponent;
    *fraction = scale * (s + s * q * tail);
}

/* 2^x for |x| <= 0.5 by the Taylor series of e^(x ln 2), |argument| < 0.347: the term after the
 * 14th is below 1e-19. */
static double exp2_fraction(double x) {
    static const double inverse_factorial[] = {1.0, 1.0, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120,
        1.0 / 720, 1.0 / 5040, 1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800,
        1.0 / 479001600, 1.0 / 6227020800.0};
    double y = x * 0.69314718055994531;
    double sum = inverse_factorial[13];
    for (int i = 12; i >= 0; i--) sum = sum * y + inverse_factorial[i];
    return sum;
}

/* base^n by squaring, for the exponents that highlights usually have. Each of at most 2 * 10
 * products adds half a rounding times what is left of the exponent. */
static double whole_power(double base, unsigned n) {
    double power = n & 1 ? base : 1;
    while (n >>= 1) {
        base *= base;
        if (n & 1) power *= base;
    }
    return power;
}

double gi_pow(double base, double exponent) {
    if (exponent >= 0 && exponent <= 1024 && base >= 0) {
        unsigned n = (unsigned)exponent;
        if (n == exponent) return whole_power(base, n);
    }
    if (exponent == 0) return 1;
    if (isnan(base) || isnan(exponent) || base < 0) return NAN;
    if (base == 0) return exponent > 0 ? 0 : INFINITY;
    if (base == 1) return 1;
    double extra = 0;
    if (base < 0x1p-1022) { /* subnormal */
        base *= 0x1p54;
        extra = -54;
    }
    if (isinf(base)) return exponent > 0 ? INFINITY : 0;
    double whole, fraction;
    log2_parts(base, &whole, &fraction);
    /* The product of the whole part is split off so that the fraction keeps its low bits. */
    double x = (whole + extra) * exponent, y = fraction * exponent;
    double sum = x + y;
    if (!(sum < 1100)) return sum != sum ? NAN : INFINITY;
    if (sum < -1100) return 0;
    double nearest = floor(sum + 0.5);
    double power = exp2_fraction((x - nearest) + y);
    /* Two factors, because 2^nearest alone may leave the range while the result does not. */
    int half = (int)nearest / 2, rest = (int)nearest - half;
    return power * from_bits((uint64_t)(1023 + half) << 52) *
           from_bits((uint64_t)(1023 + rest) << 52);
}

void gi_sincos_degrees(double degrees, double *sine, double *cosine) {
    double turn = fmod(degrees, 360); /* exact by definition */
    double quarter = floor(turn / 90 + 0.5);
    double r = (turn - 90 * quarter) * 0.017453292519943295; /* |r| <= pi/4 */
    double q = r * r;
    /* Taylor series; the terms left out are below 1e-17. */
    double s = 0, c = 0;
    for (int n = 17; n >= 3; n -= 2) s = (1 + s) * (-q / (n * (n - 1)));
    for (int n = 18; n >= 2; n -= 2) c = (1 + c) * (-q / (n * (n - 1)));
    s = r * (1 + s);
    c = 1 + c;
    switch ((int)quarter & 3) {
    case 0: *sine = s, *cosine = c; break;
    case 1: *sine = c, *cosine = -s; break;
    case 2: *sine = -s, *cosine = -c; break;
    default: *sine = -c, *cosine = s; break;
    }
}
