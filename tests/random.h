/* SPDX-License-Identifier: MIT
 * Random numbers for tests: small, seeded, the same everywhere (splitmix64, Steele 2014). */
#pragma once

#include "math/vec.h"

#include <math.h>
#include <stdint.h>

typedef struct Random {
    uint64_t state;
} Random;

static inline uint64_t random_bits(Random *random) {
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* Uniform in [low, high). */
static inline double random_real(Random *random, double low, double high) {
    return low + (high - low) * ((double)(random_bits(random) >> 11) * 0x1p-53);
}

static inline int random_below(Random *random, int count) {
    return (int)(random_bits(random) % (uint64_t)count);
}

static inline GiVec random_vec(Random *random, double low, double high) {
    double x = random_real(random, low, high);
    double y = random_real(random, low, high);
    double z = random_real(random, low, high);
    return gi_vec(x, y, z);
}

static inline GiVec random_unit(Random *random) {
    GiVec v;
    do {
        v = random_vec(random, -1, 1);
    } while (gi_length(v) < 0.1);
    return gi_normalize(v);
}

/* From a tenth to a billionth, of either sign. */
static inline double random_tiny(Random *random) {
    double part = pow(10, -random_real(random, 1, 9));
    return random_below(random, 2) ? part : -part;
}
