/* SPDX-License-Identifier: MIT
 * The numbers of math/elementary.c's functions of angles, for those who work them out many at a
 * time. */
#pragma once

#define GI_PI           3.14159265358979323846
#define GI_HALF_PI      1.5707963267948966
#define GI_HALF_PI_REST 6.1232339957367660e-17 /* what it lacks */

/* Taylor series: sin r = r + r^3 (...), cos r = 1 - r^2 / 2 + r^4 (...), in powers of r^2. */
enum { GI_SINE_TERMS = 8 };
static const double gi_sine_series[GI_SINE_TERMS] = {-1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880,
    -1.0 / 39916800, 1.0 / 6227020800.0, -1.0 / 1307674368000.0, 1.0 / 355687428096000.0};
static const double gi_cosine_series[GI_SINE_TERMS] = {1.0 / 24, -1.0 / 720, 1.0 / 40320,
    -1.0 / 3628800, 1.0 / 479001600, -1.0 / 87178291200.0, 1.0 / 20922789888000.0,
    -1.0 / 6402373705728000.0};

/* Right angles in a radian, and pi/2 in three parts (Cody and Waite 1980); the first two have 33
 * bits, so that their products with a number of right angles up to 2^20 are exact. */
#define GI_QUARTERS 0.63661977236758134
static const double gi_quarter_parts[3] = {
    0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69};

/* atan of 0, 1/8, ... 1, and atan z = z + z^3 (...). */
enum { GI_ATAN_EIGHTHS = 9, GI_ATAN_TERMS = 7 };
static const double gi_atan_of_eighths[GI_ATAN_EIGHTHS] = {0, 0.12435499454676144,
    0.24497866312686414, 0.35877067027057225, 0.4636476090008061, 0.5585993153435624,
    0.6435011087932844, 0.7188299996216245, 0.7853981633974483};
static const double gi_atan_series[GI_ATAN_TERMS] = {
    -1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11, 1.0 / 13, -1.0 / 15};
