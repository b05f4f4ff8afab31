/* SPDX-License-Identifier: MIT */
#include "math/elementary.h"

#include "math/angle.h"
#include "math/bits.h"

#include <math.h>

/* log2 of a positive, finite, normal number as a sum high + low, high being the whole part plus the
 * leading term. log2 m = 2/ln 2 * (s + s^3/3 + s^5/5 + ...), s = (m-1)/(m+1), m in [0.707, 1.414],
 * so |s| < 0.1716 and the terms after s^19 are below 1e-17 relative. */
static void log2_parts(double value, double *whole, double *fraction) {
    uint64_t bits = gi_bits_of(value);
    int exponent = (int)(bits >> 52) - 1023;
    double m = gi_from_bits((bits & 0x000fffffffffffffu) | 0x3ff0000000000000u);
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
    return power * gi_from_bits((uint64_t)(1023 + half) << 52) *
           gi_from_bits((uint64_t)(1023 + rest) << 52);
}

/* ---------------------------------------------------------------- exponential and logarithm */

/* ln 2 in two parts; the first has 32 bits, so that its product with an exponent is exact. */
static const double ln2_high = 0x1.62e42feep-1, ln2_low = 0x1.a39ef35793c76p-33;

/* The sum of coefficient[i] x^i by Horner's scheme. */
static double polynomial(const double *coefficient, int count, double x) {
    double sum = coefficient[count - 1];
    for (int i = count - 2; i >= 0; i--) sum = sum * x + coefficient[i];
    return sum;
}

/* x = k ln 2 + r with |r| <= 0.347, and e^r = 1 + r + r^2 (1/2 + r/6 + ...). The first term left
 * out, r^14 / 14!, is below 5e-18. */
double gi_exp(double x) {
    static const double series[] = {1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040,
        1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600,
        1.0 / 6227020800.0};
    if (isnan(x)) return x;
    if (x > 709.79) return INFINITY;
    if (x < -745.14) return 0;
    double k = floor(x * 1.4426950408889634 + 0.5);
    double high = x - k * ln2_high, low = k * ln2_low;
    double r = high - low;
    double rest = (high - r) - low; /* what the rounding of r has lost */
    double power = 1 + (r + (r * r * polynomial(series, 12, r) + rest));
    /* Two factors, as in gi_pow. */
    int half = (int)k / 2, other = (int)k - half;
    return power * gi_from_bits((uint64_t)(1023 + half) << 52) *
           gi_from_bits((uint64_t)(1023 + other) << 52);
}

/* x = 2^k (1 + f) with 1 + f in [0.707, 1.414]. With s = f / (2 + f) and q = s^2,
 * log(1 + f) = 2 s + (2/3) s^3 + (2/5) s^5 + ... = f - (f^2 / 2 - s (f^2 / 2 + R)),
 * R = 2/3 q + 2/5 q^2 + ..., where the large term f is exact. q < 0.0295; the first term left out
 * is below 1e-18 of the sum. */
double gi_log(double x) {
    static const double series[] = {2.0 / 3, 2.0 / 5, 2.0 / 7, 2.0 / 9, 2.0 / 11, 2.0 / 13,
        2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21};
    if (isnan(x) || x < 0) return NAN;
    if (x == 0) return -INFINITY;
    if (isinf(x)) return x;
    int k = -1023;
    if (x < 0x1p-1022) { /* subnormal */
        x *= 0x1p54;
        k -= 54;
    }
    k += (int)(gi_bits_of(x) >> 52);
    double m = gi_from_bits((gi_bits_of(x) & 0x000fffffffffffffu) | 0x3ff0000000000000u);
    if (m > 1.4142135623730951) {
        m *= 0.5;
        k++;
    }
    double f = m - 1;
    double s = f / (2 + f), q = s * s, half_square = 0.5 * f * f;
    double correction =
        half_square - (s * (half_square + q * polynomial(series, 10, q)) + k * ln2_low);
    return k * ln2_high - (correction - f);
}

/* ---------------------------------------------------------------- angles */

/* Sine and cosine of `quarter` right angles and r more, |r| <= 0.786, by their Taylor series; the
 * terms left out are below 1e-18. */
static void sincos_of_quarter(int quarter, double r, double *sine, double *cosine) {
    double q = r * r;
    double s = r + r * (q * polynomial(gi_sine_series, GI_SINE_TERMS, q));
    double half = 0.5 * q, high = 1 - half;
    double c =
        high + (((1 - high) - half) + q * q * polynomial(gi_cosine_series, GI_SINE_TERMS, q));
    switch (quarter & 3) {
    case 0: *sine = s, *cosine = c; break;
    case 1: *sine = c, *cosine = -s; break;
    case 2: *sine = -s, *cosine = -c; break;
    default: *sine = -c, *cosine = s; break;
    }
}

void gi_sincos_degrees(double degrees, double *sine, double *cosine) {
    double turn = fmod(degrees, 360); /* exact by definition */
    double quarter = floor(turn / 90 + 0.5);
    double r = (turn - 90 * quarter) * 0.017453292519943295; /* |r| <= pi/4 */
    sincos_of_quarter((int)quarter, r, sine, cosine);
}

void gi_sincos(double x, double *sine, double *cosine) {
    const double *part = gi_quarter_parts;
    if (!(fabs(x) <= 1e6)) x = isinf(x) ? NAN : fmod(x, 6.2831853071795865);
    if (isnan(x)) {
        *sine = *cosine = x;
        return;
    }
    double quarter = floor(x * GI_QUARTERS + 0.5);
    double r = ((x - quarter * part[0]) - quarter * part[1]) - quarter * part[2];
    sincos_of_quarter((int)quarter, r, sine, cosine);
}

/* atan(y / x) for 0 <= y <= x. With c the nearest eighth to y / x,
 * atan(y / x) = atan(c) + atan((y - c x) / (x + c y)), and what is left is at most 1/16 (a little
 * more by rounding), where seven terms of the series do. */
static double atan_of_octant(double y, double x) {
    int eighth = (int)(y / x * 8 + 0.5);
    double c = eighth * 0.125;
    double z = (y - c * x) / (x + c * y), q = z * z;
    return gi_atan_of_eighths[eighth] +
           (z + z * (q * polynomial(gi_atan_series, GI_ATAN_TERMS, q)));
}

/* The angle of the ray to (x, y) above the axis: both finite, one of them not small. Pi and pi/2
 * are taken with what they lack. */
static double angle_above(double y, double x) {
    double angle = y <= x ? atan_of_octant(y, x) : atan_of_octant(x, y);
    return y <= x ? angle : GI_HALF_PI - (angle - GI_HALF_PI_REST);
}

double gi_atan2(double y, double x) {
    if (isnan(x) || isnan(y)) return NAN;
    if (isinf(x) || isinf(y)) { /* only who is infinite matters */
        x = copysign(isinf(x) ? 1 : 0, x);
        y = copysign(isinf(y) ? 1 : 0, y);
    }
    double a = fabs(x), b = fabs(y), largest = a > b ? a : b;
    /* Sums and products of the two shall stay in the range of normal numbers. */
    double scale = largest > 0x1p1000 ? 0x1p-100 : largest < 0x1p-900 ? 0x1p100 : 1;
    a *= scale;
    b *= scale;
    double angle = largest > 0 ? angle_above(b, a) : 0;
    if (signbit(x)) angle = 3.1415926535897931 - (angle - 1.2246467991473532e-16);
    return copysign(angle, y);
}

double gi_asin(double x) {
    if (!(fabs(x) <= 1)) return NAN;
    return copysign(angle_above(fabs(x), sqrt((1 - x) * (1 + x))), x);
}

double gi_acos(double x) { return gi_atan2(sqrt((1 - x) * (1 + x)), x); }
