/* SPDX-License-Identifier: MIT
 * Pictures of another size. */
#pragma once

#include <stdbool.h>

/* Resamples linear colours: to fewer pixels by the mean over what each of them covers, to more by
 * repeating. `to` has 3 * to_width * to_height floats. */
void cli_picture_resize(
    const float *from, int from_width, int from_height, float *to, int to_width, int to_height);

/* The largest size within these limits that has the shape of the picture, at least 1 x 1, and no
 * larger than the picture unless `enlarge`. */
void cli_picture_fit(int width, int height, int most_width, int most_height, bool enlarge,
    int *fit_width, int *fit_height);
