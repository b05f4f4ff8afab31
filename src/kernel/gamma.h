/* SPDX-License-Identifier: MIT
 * The gamma curve, sixteen values at a time: gi_gamma_encode to the last bit. Part of kernel.c. */
#pragma once

#include "math/gamma.h"

static void GI_KERNEL(encode)(const float *linear, size_t count, uint8_t *bytes) {
    const uint32_t *table = gi_gamma_table();
    for (; count >= 16; count -= 16, linear += 16, bytes += 16) {
        sixteen_gamma(table, linear, bytes);
    }
    if (count == 0) return;
    float rest[16] = {0};
    uint8_t rest_bytes[16];
    memcpy(rest, linear, count * sizeof *rest);
    sixteen_gamma(table, rest, rest_bytes);
    memcpy(bytes, rest_bytes, count);
}
