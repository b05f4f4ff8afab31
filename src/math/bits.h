/* SPDX-License-Identifier: MIT
 * A double as its bits (IEEE 754), and back. */
#pragma once

#include <stdint.h>
#include <string.h>

static inline uint64_t gi_bits_of(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static inline double gi_from_bits(uint64_t bits) {
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}
