/* SPDX-License-Identifier: MIT
 * The first two dimensions of Sobol's sequence, scrambled after Owen, once for each dimension of
 * the renderer ("padding"), with the order of the samples shuffled by the same scramble, so that
 * pairs of different dimensions have nothing to do with each other. Scrambles are hashes, nothing
 * is stored (Burley 2020, Practical Hash-based Owen Scrambling).
 *
 * Owen's scramble flips each bit depending on the bits above it. On reversed numbers that is a
 * function whose bits depend on those below only, as those of sums and products do; so most of the
 * work is done on reversed numbers. */
#include "sample/sampler.h"

/* The bits of both halves reversed, and the halves exchanged. */
static uint64_t reverse(uint64_t x) {
    x = (x & 0x5555555555555555) << 1 | (x >> 1 & 0x5555555555555555);
    x = (x & 0x3333333333333333) << 2 | (x >> 2 & 0x3333333333333333);
    x = (x & 0x0f0f0f0f0f0f0f0f) << 4 | (x >> 4 & 0x0f0f0f0f0f0f0f0f);
    return __builtin_bswap64(x);
}

/* Owen's scramble of a reversed number: Laine and Karras 2011, with the constants that N. Vegdahl
 * found for better mixing. */
static uint32_t scramble(uint32_t x, uint32_t seed) {
    x ^= x * 0x3d20adea;
    x += seed;
    x *= seed >> 16 | 1;
    x ^= x * 0x05526c56;
    x ^= x * 0x53a22864;
    return x;
}

/* The second dimension of Sobol's sequence at `index`, reversed. Its direction number k has the
 * bits binomial(k, b) mod 2, which is 1 where the bits of b are among those of k (Lucas). So bit b
 * of the point is the parity of those bits of index whose place k contains b: a sum over supersets,
 * one step for each of the five bits of a place. */
static uint32_t sobol_second(uint32_t index) {
    index ^= index >> 16;
    index ^= index >> 8 & 0x00ff00ff;
    index ^= index >> 4 & 0x0f0f0f0f;
    index ^= index >> 2 & 0x33333333;
    index ^= index >> 1 & 0x55555555;
    return index;
}

/* Steele, Lea and Flood 2014, with the constants of D. Stafford. */
static uint64_t mix(uint64_t x) {
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
    x = (x ^ x >> 27) * 0x94d049bb133111eb;
    return x ^ x >> 31;
}

static uint64_t hash(uint64_t seed, uint64_t value) {
    return mix(seed + (value + 1) * 0x9e3779b97f4a7c15);
}

static double unit(uint32_t bits) { return (double)bits * 0x1p-32; }

GiSampler gi_sampler(uint32_t x, uint32_t y, uint32_t sample) {
    return (GiSampler){
        .seed = mix(mix((uint64_t)y << 32 | x) + 1), .sample = (uint32_t)(reverse(sample) >> 32)};
}

GiSampler gi_sampler_independent(uint32_t x, uint32_t y, uint32_t sample) {
    GiSampler sampler = gi_sampler(x, y, sample);
    sampler.seed = hash(sampler.seed, sample);
    sampler.independent = true;
    return sampler;
}

void gi_sample_2d(const GiSampler *sampler, uint64_t dimension, double u[2]) {
    uint64_t seed = hash(sampler->seed, dimension);
    if (sampler->independent) {
        u[0] = unit((uint32_t)seed);
        u[1] = unit((uint32_t)(seed >> 32));
        return;
    }
    uint32_t first_seed = (uint32_t)(seed >> 32);
    uint32_t second_seed = (uint32_t)(seed * 0xd1342543de82ef95 >> 32);
    uint32_t index = (uint32_t)(reverse(scramble(sampler->sample, (uint32_t)seed)) >> 32);
    /* The first dimension is the index with its bits reversed: reversed again, the index. */
    uint64_t first = scramble(index, first_seed);
    uint64_t second = scramble(sobol_second(index), second_seed);
    uint64_t both = reverse(second << 32 | first);
    u[0] = unit((uint32_t)(both >> 32));
    u[1] = unit((uint32_t)both);
}

double gi_sample_1d(const GiSampler *sampler, uint64_t dimension) {
    double u[2];
    gi_sample_2d(sampler, dimension, u);
    return u[0];
}
