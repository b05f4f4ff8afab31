/* SPDX-License-Identifier: MIT */
#include "statistics.h"

#include <stdlib.h>

static int compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

Spread statistics_spread(double *values, int count) {
    if (count <= 0) return (Spread){0, 0, 0};
    qsort(values, (size_t)count, sizeof values[0], compare);
    double middle = (values[count / 2] + values[(count - 1) / 2]) / 2;
    return (Spread){middle, values[0], values[count - 1]};
}
