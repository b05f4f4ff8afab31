/* SPDX-License-Identifier: MIT
 * The curve is a staircase: byte k begins at T_k = ((k - 0.5) / 255)^2.2, so a value needs no
 * power, only its step. Bits of positive floats are ordered like the floats; cut after seven bits
 * of mantissa they number buckets, each at most 1/128 wide (relative), while neighbouring steps
 * are 2.2/255 = 1/116 apart or more. So a bucket holds one step at most:
 *
 *     bits   | exponent and 7 bits of mantissa | 16 bits |
 *     entry  | byte at the bucket's beginning  | 2^16 - (low bits of the step inside, if any) |
 *
 * and (entry + low bits) >> 16 is the byte: the addition carries when the value is at the step or
 * beyond. No branch and one look-up in 10 KB. */
#include "math/gamma.h"

#include "math/elementary.h"

#include <pthread.h>
#include <string.h>

#define LOWEST GI_GAMMA_LOWEST
enum { LOW_BITS = GI_GAMMA_LOW_BITS, LOWEST_BITS = GI_GAMMA_LOWEST_BITS, ONE_BITS = 127 << 23 };
enum { BUCKET_COUNT = ((ONE_BITS - LOWEST_BITS) >> LOW_BITS) + 1, BLOCK = 64 };

static uint32_t table[BUCKET_COUNT];
static pthread_once_t table_once = PTHREAD_ONCE_INIT;

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Bits of the smallest float that is not below T_k. gi_pow is good to 1e-15 and no T_k is that
 * close to a float; the tests check each step against the formula. */
static uint32_t step_bits(int k) {
    double step = gi_pow((k - 0.5) / 255, 2.2);
    uint32_t bits = bits_of((float)step);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value < step ? bits + 1 : bits;
}

static void fill_table(void) {
    uint32_t begin = LOWEST_BITS, byte = 0, step = step_bits(1);
    for (int i = 0; i < BUCKET_COUNT; i++, begin += 1u << LOW_BITS) {
        table[i] = byte << LOW_BITS;
        if (byte < 255 && step - begin < 1u << LOW_BITS) {
            table[i] += (1u << LOW_BITS) - (step - begin);
            byte++;
            step = byte < 255 ? step_bits((int)byte + 1) : 0;
        }
    }
}

const uint32_t *gi_gamma_table(void) {
    pthread_once(&table_once, fill_table);
    return table;
}

static inline void encode_block(
    const uint32_t *steps, const float *linear, size_t count, uint8_t *bytes) {
    /* The clamp goes first, as a loop of its own that compilers turn into max and min. Both
     * comparisons are false for NaN, which thereby becomes LOWEST. */
    float clamped[BLOCK];
    for (size_t i = 0; i < count; i++) {
        float value = linear[i] > LOWEST ? linear[i] : LOWEST;
        clamped[i] = value < 1.0f ? value : 1.0f;
    }
    for (size_t i = 0; i < count; i++) bytes[i] = gi_gamma_byte(steps, clamped[i]);
}

void gi_gamma_encode(const float *linear, size_t count, uint8_t *bytes) {
    const uint32_t *steps = gi_gamma_table();
    /* 1.2 values a nanosecond with GCC, 1.9 with Clang. Told the length, GCC vectorises at -O2. */
    for (; count >= BLOCK; count -= BLOCK, linear += BLOCK, bytes += BLOCK) {
        encode_block(steps, linear, BLOCK, bytes);
    }
    encode_block(steps, linear, count, bytes);
}
