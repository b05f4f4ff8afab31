/* SPDX-License-Identifier: MIT
 * Four floats at once, for boxes: x, y, z and one to spare. SSE where the processor is known to
 * have it (every x86-64), plain C elsewhere, with the same results. */
#pragma once

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#ifdef __SSE2__
#include <emmintrin.h>

typedef __m128 GiFour;

static inline GiFour gi_four(float x) { return _mm_set1_ps(x); }
static inline GiFour gi_four_of(float x, float y, float z, float w) {
    return _mm_setr_ps(x, y, z, w);
}
static inline GiFour gi_four_load(const float p[4]) { return _mm_loadu_ps(p); }
static inline void gi_four_store(float p[4], GiFour a) { _mm_storeu_ps(p, a); }
/* a < b ? a : b, and a > b ? a : b */
static inline GiFour gi_four_min(GiFour a, GiFour b) { return _mm_min_ps(a, b); }
static inline GiFour gi_four_max(GiFour a, GiFour b) { return _mm_max_ps(a, b); }
static inline GiFour gi_four_add(GiFour a, GiFour b) { return _mm_add_ps(a, b); }
static inline GiFour gi_four_sub(GiFour a, GiFour b) { return _mm_sub_ps(a, b); }
static inline GiFour gi_four_multiply(GiFour a, GiFour b) { return _mm_mul_ps(a, b); }
static inline GiFour gi_four_divide(GiFour a, GiFour b) { return _mm_div_ps(a, b); }
/* Toward zero. */
static inline void gi_four_to_int(GiFour a, int32_t to[4]) {
    _mm_storeu_si128((__m128i *)(void *)to, _mm_cvttps_epi32(a));
}
static inline GiFour gi_four_of_int(const int32_t p[4]) {
    return _mm_cvtepi32_ps(_mm_loadu_si128((const __m128i *)(const void *)p));
}
static inline GiFour gi_four_truncate(GiFour a) { return _mm_cvtepi32_ps(_mm_cvttps_epi32(a)); }
/* a < b ? x : y */
static inline GiFour gi_four_select_less(GiFour a, GiFour b, GiFour x, GiFour y) {
    GiFour less = _mm_cmplt_ps(a, b);
    return _mm_or_ps(_mm_and_ps(less, x), _mm_andnot_ps(less, y));
}
static inline bool gi_four_any_less(GiFour a, GiFour b) {
    return _mm_movemask_ps(_mm_cmplt_ps(a, b)) != 0;
}
/* Not-a-numbers where it is hidden, which a min or max whose second operand is a number drops. */
static inline GiFour gi_four_hide(GiFour a, bool hidden) {
    return _mm_or_ps(a, _mm_castsi128_ps(_mm_set1_epi32(-(int32_t)hidden)));
}
/* Of three vectors the first lanes, the second and the third; the fourth hold anything. */
static inline void gi_four_transpose(GiFour a, GiFour b, GiFour c, GiFour to[3]) {
    GiFour first = _mm_unpacklo_ps(a, b), second = _mm_unpackhi_ps(a, b);
    to[0] = _mm_movelh_ps(first, c);
    to[1] = _mm_shuffle_ps(first, c, _MM_SHUFFLE(3, 1, 3, 2));
    to[2] = _mm_shuffle_ps(second, c, _MM_SHUFFLE(3, 2, 1, 0));
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
static inline GiFour gi_four_of(float x, float y, float z, float w) {
    return (GiFour){{x, y, z, w}};
}
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
static inline GiFour gi_four_divide(GiFour a, GiFour b) { GI_FOUR_EACH(a.v[i] / b.v[i]); }
static inline void gi_four_to_int(GiFour a, int32_t to[4]) {
    for (int i = 0; i < 3; i++) to[i] = (int32_t)a.v[i];
    to[3] = 0; /* the lane to spare may hold anything */
}
static inline GiFour gi_four_of_int(const int32_t p[4]) { GI_FOUR_EACH((float)p[i]); }
static inline GiFour gi_four_truncate(GiFour a) { GI_FOUR_EACH(truncf(a.v[i])); }
static inline GiFour gi_four_select_less(GiFour a, GiFour b, GiFour x, GiFour y) {
    GI_FOUR_EACH(a.v[i] < b.v[i] ? x.v[i] : y.v[i]);
}
static inline bool gi_four_any_less(GiFour a, GiFour b) {
    return (a.v[0] < b.v[0]) | (a.v[1] < b.v[1]) | (a.v[2] < b.v[2]) | (a.v[3] < b.v[3]);
}
static inline GiFour gi_four_hide(GiFour a, bool hidden) { GI_FOUR_EACH(hidden ? NAN : a.v[i]); }
static inline void gi_four_transpose(GiFour a, GiFour b, GiFour c, GiFour to[3]) {
    for (int i = 0; i < 3; i++) to[i] = (GiFour){{a.v[i], b.v[i], c.v[i], 0}};
}

#endif
