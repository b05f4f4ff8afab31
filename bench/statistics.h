/* SPDX-License-Identifier: MIT
 * What is kept of repeated measurements. */
#pragma once

/* The median, since on a shared machine a disturbed run is slow without bound; the extremes tell
 * how much to believe it. */
typedef struct Spread {
    double median, least, most;
} Spread;

/* Sorts the values. count 0 gives zeros. */
Spread statistics_spread(double *values, int count);
