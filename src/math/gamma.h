/* SPDX-License-Identifier: MIT
 * Linear colour to the 8 bits of a picture file. */
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* bytes[i] = floor(255 * clamp(linear[i]^(1/2.2), 0, 1) + 0.5), exactly: as if worked out without
 * rounding. NaN and everything below zero give 0, infinity gives 255. Any thread may call it. The
 * kernels have another that gives the same (kernel/gamma.h). */
typedef void (*GiGammaFn)(const float *linear, size_t count, uint8_t *bytes);
void gi_gamma_encode(const float *linear, size_t count, uint8_t *bytes);

/* ---------------------------------------------------------------- for the kernels */

/* All values below 2^-20 give 0, since the first step is at 2^-19.8; all from 1 on give 255. */
#define GI_GAMMA_LOWEST 0x1p-20f
enum { GI_GAMMA_LOW_BITS = 16, GI_GAMMA_LOWEST_BITS = 107 << 23 };

/* The entries that gamma.c explains; made at the first call. */
const uint32_t *gi_gamma_table(void);

/* Of a value from GI_GAMMA_LOWEST to 1. */
static inline uint8_t gi_gamma_byte(const uint32_t *table, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    uint32_t entry = table[(bits - GI_GAMMA_LOWEST_BITS) >> GI_GAMMA_LOW_BITS];
    return (uint8_t)((entry + (bits & ((1u << GI_GAMMA_LOW_BITS) - 1))) >> GI_GAMMA_LOW_BITS);
}
