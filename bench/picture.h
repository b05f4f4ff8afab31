/* SPDX-License-Identifier: MIT
 * Pictures: whether two are the same, and how long it takes to write one. */
#pragma once

#include "statistics.h"

#include <stdint.h>

/* Of the file's bytes (FNV-1a, 64 bits); never 0. A file that cannot be read ends the program. */
uint64_t picture_hash(const char *path);

enum { ENCODE_EDGE = 1024 };

typedef struct EncodeResult {
    Spread seconds;
    uint64_t size; /* of the PNG */
} EncodeResult;

/* Encodes a picture of spheres, ENCODE_EDGE on each side, as PNG on one thread, in memory. Draws
 * it first, so it makes this process large: to be called after all other measurements. */
EncodeResult picture_encode(int rep_count);
