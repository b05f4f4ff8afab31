/* SPDX-License-Identifier: MIT
 * Linear colour to the 8 bits of a picture file. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* bytes[i] = floor(255 * clamp(linear[i]^(1/2.2), 0, 1) + 0.5), exactly: as if worked out without
 * rounding. NaN and everything below zero give 0, infinity gives 255. Any thread may call it. */
void gi_gamma_encode(const float *linear, size_t count, uint8_t *bytes);
