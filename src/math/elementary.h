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
