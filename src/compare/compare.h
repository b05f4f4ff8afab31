/* SPDX-License-Identifier: MIT
 * How far two pictures are apart. */
#pragma once

#include "base/memory.h"

/* Null, or what is wrong with it. */
const char *gi_compare_check(const GlintCompareDesc *desc);

/* Whether it has pixels, and no more than 2^28. */
static inline bool gi_compare_is_picture(const GlintImage *image) {
    return image != NULL && image->pixels != NULL && image->width >= 1 && image->height >= 1 &&
           image->width <= (1 << 28) / image->height;
}

/* Fills map (width * height) with the FLIP error of each pixel, 0 to 1, of two pictures of so many
 * sRGB triples of 8 bits. False when memory is short. */
bool gi_flip(GiMemory *memory, int width, int height, const uint8_t *reference, const uint8_t *test,
    double pixels_per_degree, float *map);
