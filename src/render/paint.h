/* SPDX-License-Identifier: MIT
 * Colours for numbers, and a legend that explains them. */
#pragma once

#include "math/vec.h"

#include <stdint.h>

/* The linear colour that a PNG shows as these values from 0 to 1. */
GiVec gi_paint_shown(double red, double green, double blue);

/* From black through blue, red and yellow to white, for 0 to 1. */
GiVec gi_paint_heat(double part);

/* A colour of its own for every number, not dark and not white. */
GiVec gi_paint_number(uint32_t number);

/* Draws the colours of heat with 0, half of top and top under them, into the lower left corner of a
 * picture of width * height * 3 floats. A picture without room for it stays as it is. */
void gi_paint_legend(float *pixels, int width, int height, double top);
