/* SPDX-License-Identifier: MIT
 * The part of wide.h for packets of sixteen rays.
 *
 *     GI_ISA      P: floats, sixteen of them or as many as a vector has
 *     avx512      16
 *     others      as F
 */
#pragma once

/* Sixteen numbers against one: bits of those where x <= p[i], and where p[i] <= x. */
#if defined(GI_IS_AVX512)
static inline unsigned sixteen_from(float x, const float p[16]) {
    return _mm512_cmp_ps_mask(_mm512_set1_ps(x), _mm512_loadu_ps(p), _CMP_LE_OQ);
}
static inline unsigned sixteen_up_to(float x, const float p[16]) {
    return _mm512_cmp_ps_mask(_mm512_loadu_ps(p), _mm512_set1_ps(x), _CMP_LE_OQ);
}
#else
static inline unsigned sixteen_from(float x, const float p[16]) {
    unsigned bits = 0;
    for (int i = 0; i < 16; i += GI_FLOATS) bits |= f_less_equal(f_of(x), f_load(p + i)) << i;
    return bits;
}
static inline unsigned sixteen_up_to(float x, const float p[16]) {
    unsigned bits = 0;
    for (int i = 0; i < 16; i += GI_FLOATS) bits |= f_less_equal(f_load(p + i), f_of(x)) << i;
    return bits;
}
#endif

/* Bits of those of sixteen that equal value. */
static inline unsigned sixteen_equal(uint32_t value, const uint32_t p[16]) {
#if defined(GI_IS_AVX512)
    return _mm512_cmpeq_epi32_mask(_mm512_set1_epi32((int)value), _mm512_loadu_si512(p));
#elif defined(GI_IS_AVX2)
    const __m256i all = _mm256_set1_epi32((int)value);
    unsigned bits = 0;
    for (int i = 0; i < 16; i += 8) {
        __m256i eight = _mm256_loadu_si256((const __m256i *)(const void *)(p + i));
        __m256 equal = _mm256_castsi256_ps(_mm256_cmpeq_epi32(all, eight));
        bits |= (unsigned)_mm256_movemask_ps(equal) << i;
    }
    return bits;
#else
    unsigned bits = 0;
    for (int i = 0; i < 16; i++) bits |= (unsigned)(p[i] == value) << i;
    return bits;
#endif
}

/* ---------------------------------------------------------------- as wide as can be */

#if defined(GI_IS_AVX512)
enum { GI_WIDEST = 16 };
typedef __m512 P;
static inline P p_of(float x) { return _mm512_set1_ps(x); }
static inline P p_load(const float *p) { return _mm512_loadu_ps(p); }
static inline void p_store(float *p, P a) { _mm512_storeu_ps(p, a); }
static inline P p_min(P a, P b) { return _mm512_min_ps(a, b); }
static inline P p_max(P a, P b) { return _mm512_max_ps(a, b); }
static inline P p_fused(P a, P b, P c) { return _mm512_fmadd_ps(a, b, c); }
static inline P p_less_fused(P a, P b, P c) { return _mm512_fnmadd_ps(a, b, c); }
static inline P p_size(P a) { return _mm512_abs_ps(a); }
static inline unsigned p_less_equal(P a, P b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
static inline unsigned p_less(P a, P b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
static inline void p_fill_where(uint32_t *p, unsigned bits, uint32_t value) {
    _mm512_mask_storeu_epi32(p, (__mmask16)bits, _mm512_set1_epi32((int)value));
}
static inline void p_store_where(float *p, unsigned bits, P a) {
    _mm512_mask_storeu_ps(p, (__mmask16)bits, a);
}
/* From GI_PARTS vectors of doubles. */
enum { GI_PARTS = GI_WIDEST / GI_DOUBLES };
static inline P p_rounded(const R *parts) {
    return _mm512_insertf32x8(
        _mm512_castps256_ps512(_mm512_cvtpd_ps(parts[0])), _mm512_cvtpd_ps(parts[1]), 1);
}
#else
enum { GI_WIDEST = GI_FLOATS };
typedef F P;
static inline P p_of(float x) { return f_of(x); }
static inline P p_load(const float *p) { return f_load(p); }
static inline void p_store(float *p, P a) { f_store(p, a); }
static inline P p_min(P a, P b) { return f_min(a, b); }
static inline P p_max(P a, P b) { return f_max(a, b); }
static inline P p_fused(P a, P b, P c) { return f_fused(a, b, c); }
static inline P p_less_fused(P a, P b, P c) { return f_less_fused(a, b, c); }
static inline P p_size(P a) { return f_max(a, f_of(0) - a); }
static inline unsigned p_less_equal(P a, P b) { return f_less_equal(a, b); }
static inline unsigned p_less(P a, P b) { return f_less(a, b); }
enum { GI_PARTS = GI_WIDEST / GI_DOUBLES };
#if defined(GI_IS_AVX2)
static inline P p_rounded(const R *parts) {
    return _mm256_insertf128_ps(
        _mm256_castps128_ps256(_mm256_cvtpd_ps(parts[0])), _mm256_cvtpd_ps(parts[1]), 1);
}
#elif defined(GI_IS_SSE2)
static inline P p_rounded(const R *parts) {
    return _mm_movelh_ps(_mm_cvtpd_ps(parts[0]), _mm_cvtpd_ps(parts[1]));
}
#else
static inline P p_rounded(const R *parts) { return (float)parts[0]; }
#endif
#if defined(GI_IS_AVX2)
static inline __m256i p_mask(unsigned bits) {
    const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    return _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32((int)bits), bit), bit);
}
static inline void p_fill_where(uint32_t *p, unsigned bits, uint32_t value) {
    __m256i all = _mm256_loadu_si256((const __m256i *)(const void *)p);
    all = _mm256_blendv_epi8(all, _mm256_set1_epi32((int)value), p_mask(bits));
    _mm256_storeu_si256((__m256i *)(void *)p, all);
}
static inline void p_store_where(float *p, unsigned bits, P a) {
    _mm256_storeu_ps(p, _mm256_blendv_ps(_mm256_loadu_ps(p), a, _mm256_castsi256_ps(p_mask(bits))));
}
#else
static inline void p_store_where(float *p, unsigned bits, P a) {
    float lanes[GI_WIDEST];
    p_store(lanes, a);
    for (int i = 0; i < GI_WIDEST; i++) {
        if (bits >> i & 1) p[i] = lanes[i];
    }
}
static inline void p_fill_where(uint32_t *p, unsigned bits, uint32_t value) {
    for (int i = 0; i < GI_WIDEST; i++) {
        if (bits >> i & 1) p[i] = value;
    }
}
#endif
#endif

/* Writes base + i for every bit i of sixteen, in order, and returns how many. There must be room
 * for sixteen. */
static inline int sixteen_append(uint32_t *to, unsigned bits, uint32_t base) {
#if defined(GI_IS_AVX512)
    const __m512i count = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    __m512i all = _mm512_add_epi32(count, _mm512_set1_epi32((int)base));
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32((__mmask16)bits, all));
    return _mm_popcnt_u32(bits);
#elif defined(GI_HAS_EIGHT)
    int count = eight_append_indices(to, base, bits & 0xff);
    return count + eight_append_indices(to + count, base + 8, bits >> 8);
#else
    int count = 0;
    for (; bits != 0; bits &= bits - 1) to[count++] = base + (uint32_t)lowest_bit(bits);
    return count;
#endif
}
