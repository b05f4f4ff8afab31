/* SPDX-License-Identifier: MIT
 * Four floats at once, for boxes: x, y, z and one to spare. SSE where the processor is known to
 * have it (every x86-64), plain C elsewhere, with the same results. */
#pragma once

#include <stdint.h>

#ifdef __SSE2__
#include <emmintrin.h>

typedef __m128 GiFour;

static inline GiFour gi_four(float x) { return _mm_set1_ps(x); }
static inline GiFour gi_four_load(const float p[4]) { return _mm_loadu_ps(p); }
static inline void gi_four_store(float p[4], GiFour a) { _mm_storeu_ps(p, a); }
/* a < b ? a : b, and a > b ? a : b */
static inline GiFour gi_four_min(GiFour a, GiFour b) { return _mm_min_ps(a, b); }
static inline GiFour gi_four_max(GiFour a, GiFour b) { return _mm_max_ps(a, b); }
static inline GiFour gi_four_add(GiFour a, GiFour b) { return _mm_add_ps(a, b); }
static inline GiFour gi_four_sub(GiFour a, GiFour b) { return _mm_sub_ps(a, b); }
static inline GiFour gi_four_multiply(GiFour a, GiFour b) { return _mm_mul_ps(a, b); }
/* Toward zero. */
static inline void gi_four_to_int(GiFour a, int32_t to[4]) {
    _mm_storeu_si128((__m128i *)(void *)to, _mm_cvttps_epi32(a));
}

#else

typedef struct GiFour {
    float v[4];
} GiFour;

#define GI_FOUR_EACH(expression)                                                                   \
    do {                                                                                           \
        GiFour r_;                                                                                 \
        for (int i = 0; i < 4; i++) r_.v[i] = (expression);                                        \
        return r_;                                                                                 \
    } while (0)

static inline GiFour gi_four(float x) { GI_FOUR_EACH(x); }
static inline GiFour gi_four_load(const float p[4]) { GI_FOUR_EACH(p[i]); }
static inline void gi_four_store(float p[4], GiFour a) {
    for (int i = 0; i < 4; i++) p[i] = a.v[i];
}
static inline GiFour gi_four_min(GiFour a, GiFour b) {
    GI_FOUR_EACH(a.v[i] < b.v[i] ? a.v[i] : b.v[i]);
}
static inline GiFour gi_four_max(GiFour a, GiFour b) {
    GI_FOUR_EACH(a.v[i] > b.v[i] ? a.v[i] : b.v[i]);
}
static inline GiFour gi_four_add(GiFour a, GiFour b) { GI_FOUR_EACH(a.v[i] + b.v[i]); }
static inline GiFour gi_four_sub(GiFour a, GiFour b) { GI_FOUR_EACH(a.v[i] - b.v[i]); }
static inline GiFour gi_four_multiply(GiFour a, GiFour b) { GI_FOUR_EACH(a.v[i] * b.v[i]); }
static inline void gi_four_to_int(GiFour a, int32_t to[4]) {
    for (int i = 0; i < 3; i++) to[i] = (int32_t)a.v[i];
    to[3] = 0; /* the lane to spare may hold anything */
}

#endif
