/* SPDX-License-Identifier: MIT
 * Decimal text to double, correctly rounded (to nearest, ties to even) and independent of the
 * locale, so that a scene means the same numbers on every machine. */
#pragma once

#include <stddef.h>

typedef enum GiNumberStatus {
    GI_NUMBER_OK,
    GI_NUMBER_MALFORMED, /* no number begins here */
    GI_NUMBER_TOO_LARGE  /* a number, but beyond the range of double */
} GiNumberStatus;

/* Reads the longest number at the start of text: an optional sign, digits with an optional point
 * (at least one digit), an optional exponent. No hexadecimal, no infinity, no nan. *used is how
 * many characters it took; an `e` without digits after it is not taken. What is too small for a
 * double becomes zero. */
GiNumberStatus gi_number_read(const char *text, size_t size, double *value, size_t *used);
