/* SPDX-License-Identifier: MIT
 * Sixty-four bytes at once: what is asked of them is answered with a bit for each, the lowest for
 * the first. SSE2 where the processor is known to have it (every x86-64), plain C elsewhere, with
 * the same results. */
#pragma once

#include "math/eight.h"

#include <stdint.h>

enum { GI_BYTES = 64 };

#ifdef __SSE2__
#include <emmintrin.h>

typedef struct GiBytes {
    __m128i part[GI_BYTES / 16];
} GiBytes;

static inline GiBytes gi_bytes_load(const char *p) {
    GiBytes bytes;
    for (int i = 0; i < GI_BYTES / 16; i++) {
        bytes.part[i] = _mm_loadu_si128((const __m128i *)(const void *)(p + 16 * i));
    }
    return bytes;
}

static inline uint64_t gi_bytes_equal(GiBytes bytes, char c) {
    uint64_t bits = 0;
    for (int i = 0; i < GI_BYTES / 16; i++) {
        __m128i equal = _mm_cmpeq_epi8(bytes.part[i], _mm_set1_epi8(c));
        bits |= (uint64_t)(uint32_t)_mm_movemask_epi8(equal) << (16 * i);
    }
    return bits;
}

/* A blank or one of the five from tab to carriage return. */
static inline uint64_t gi_bytes_space(GiBytes bytes) {
    uint64_t bits = 0;
    for (int i = 0; i < GI_BYTES / 16; i++) {
        __m128i above = _mm_sub_epi8(bytes.part[i], _mm_set1_epi8('\t'));
        __m128i control = _mm_cmpeq_epi8(_mm_min_epu8(above, _mm_set1_epi8('\r' - '\t')), above);
        __m128i blank = _mm_cmpeq_epi8(bytes.part[i], _mm_set1_epi8(' '));
        bits |= (uint64_t)(uint32_t)_mm_movemask_epi8(_mm_or_si128(control, blank)) << (16 * i);
    }
    return bits;
}

#else

/* Eight at a time. A byte's answer is its highest bit; no sum carries into the next byte. */
typedef struct GiBytes {
    uint64_t part[GI_BYTES / 8];
} GiBytes;

#define GI_BYTES_ONES UINT64_C(0x0101010101010101)
#define GI_BYTES_HIGH UINT64_C(0x8080808080808080)

static inline GiBytes gi_bytes_load(const char *p) {
    GiBytes bytes;
    for (int i = 0; i < GI_BYTES / 8; i++) bytes.part[i] = gi_eight_load(p + 8 * i);
    return bytes;
}

/* The highest bits of eight bytes behind one another. */
static inline uint64_t gi_bytes_gather(uint64_t high) {
    return (high >> 7) * UINT64_C(0x0102040810204080) >> 56;
}

static inline uint64_t gi_bytes_equal_eight(uint64_t eight, char c) {
    uint64_t other = eight ^ (unsigned char)c * GI_BYTES_ONES;
    return ~(((other & ~GI_BYTES_HIGH) + ~GI_BYTES_HIGH) | other) & GI_BYTES_HIGH;
}

static inline uint64_t gi_bytes_equal(GiBytes bytes, char c) {
    uint64_t bits = 0;
    for (int i = 0; i < GI_BYTES / 8; i++) {
        bits |= gi_bytes_gather(gi_bytes_equal_eight(bytes.part[i], c)) << (8 * i);
    }
    return bits;
}

static inline uint64_t gi_bytes_space(GiBytes bytes) {
    uint64_t bits = 0;
    for (int i = 0; i < GI_BYTES / 8; i++) {
        bits |= gi_bytes_gather(gi_eight_space(bytes.part[i])) << (8 * i);
    }
    return bits;
}

#endif

/* How many bits are set. x86-64 as such has no instruction for it. */
static inline int gi_bytes_count(uint64_t bits) {
    bits -= bits >> 1 & UINT64_C(0x5555555555555555);
    bits = (bits & UINT64_C(0x3333333333333333)) + (bits >> 2 & UINT64_C(0x3333333333333333));
    bits = (bits + (bits >> 4)) & UINT64_C(0x0f0f0f0f0f0f0f0f);
    return (int)(bits * UINT64_C(0x0101010101010101) >> 56);
}
