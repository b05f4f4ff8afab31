/* SPDX-License-Identifier: MIT
 * Elementary functions made of IEEE additions, multiplications and divisions only, in a fixed
 * order: the same bits on every machine, which the C library does not promise. */
#pragma once

/* base^exponent for base >= 0. Relative error below 4e-15 * (1 + |exponent * log2(base)| / 16), for
 * whole exponents up to 1024 below 2e-16 * exponent.
 * 0^0 = 1, 0^positive = 0, 0^negative = infinity, NaN in, NaN out. */
double gi_pow(double base, double exponent);

/* Sine and cosine of an angle in degrees, error below 2e-16; exact at multiples of 90. */
void gi_sincos_degrees(double degrees, double *sine, double *cosine);

/* The functions below have the C library's special cases (C11, annex F): NaN in, NaN out, and
 * otherwise as said. */

/* e^x, relative error below 4e-16; results too small for all digits are off by less than the
 * smallest number. Infinity from 709.79 on, 0 from -745.14 down. */
double gi_exp(double x);

/* The natural logarithm, relative error below 4e-16. -infinity of 0, NaN of a negative number. */
double gi_log(double x);

/* Of an angle in radians. Error below 2e-16 up to |x| = 1e6; a larger angle is taken modulo the
 * double nearest to 2 pi, which adds 4e-17 |x|. NaN of an infinite one. The sine of -0 is 0. */
void gi_sincos(double x, double *sine, double *cosine);

/* The angle of the point (x, y) from the axis of x, in -pi ... pi. Absolute error below 5e-16 and
 * relative error below 1e-15. Zeros and infinities keep their signs: gi_atan2(-0.0, -1) = -pi,
 * gi_atan2(INFINITY, INFINITY) = pi / 4. */
double gi_atan2(double y, double x);

/* In -pi/2 ... pi/2 and 0 ... pi, absolute error below 6e-16 and relative error below 1e-15. NaN
 * beyond -1 ... 1. */
double gi_asin(double x);
double gi_acos(double x);
