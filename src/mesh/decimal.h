/* SPDX-License-Identifier: MIT
 * Decimal text to single precision, rounded once, to the nearest (ties to even), independent of
 * the locale. By way of a double it would be rounded twice, which is wrong for a few. */
#pragma once

/* Reads the longest number at the start of text: an optional sign, digits with an optional point
 * (at least one digit), an optional exponent. Returns its end; null when no number begins here. No
 * hexadecimal, no infinity, no nan. What is too large becomes infinite, what is too small zero. */
const char *gi_decimal_read(const char *text, const char *end, float *value);
