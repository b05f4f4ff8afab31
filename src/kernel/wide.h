/* SPDX-License-Identifier: MIT
 * Vectors of the width the instruction set has, under a handful of names. Intrinsics appear in this
 * file, its parts for eight and for sixteen at a time, and nowhere else. It is included by
 * kernel.c, which is compiled once for each of
 *
 *     GI_ISA      F: floats   R: doubles   M: what a comparison of doubles gives
 *     avx512      8           8            a mask register
 *     avx2        8           4            a vector of all ones and zeros
 *     sse2        4           2            the same
 *     portable    1           1            an int
 *
 * and U, as many whole numbers as R has doubles. Comparisons of floats give bits, lane 0 lowest.
 * Arithmetic is written with operators, of U only those on bits. */
#pragma once

#include "math/gamma.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define GI_PASTE_(a, b) a##b
#define GI_PASTE(a, b)  GI_PASTE_(a, b)
#define GI_TEXT_(a)     #a
#define GI_TEXT(a)      GI_TEXT_(a)

#define avx512        1
#define avx2          2
#define sse2          3
#define portable      4
#define GI_ISA_NUMBER GI_ISA
#if GI_ISA_NUMBER == avx512
#define GI_IS_AVX512 1
#elif GI_ISA_NUMBER == avx2
#define GI_IS_AVX2 1
#elif GI_ISA_NUMBER == sse2
#define GI_IS_SSE2 1
#elif GI_ISA_NUMBER == portable
#define GI_IS_PORTABLE 1
#else
#error "GI_ISA must be avx512, avx2, sse2 or portable"
#endif
#undef avx512
#undef avx2
#undef sse2
#undef portable

#ifndef GI_IS_PORTABLE
#include <immintrin.h>
#endif

/* ---------------------------------------------------------------- bits, memory */

#if defined(__GNUC__)
#define NOINLINE __attribute__((noinline))
#define FLATTEN  __attribute__((flatten)) /* all that it calls becomes part of it */
static inline void prefetch(const void *p) { __builtin_prefetch(p); }
static inline int lowest_bit(unsigned bits) { return __builtin_ctz(bits); }
static inline int lowest_bit_of(uint64_t bits) { return __builtin_ctzll(bits); }
static inline int bit_count(unsigned bits) { return __builtin_popcount(bits); }
#else
#define NOINLINE
#define FLATTEN
static inline void prefetch(const void *p) { (void)p; }
static inline int lowest_bit(unsigned bits) {
    int index = 0;
    while (!(bits >> index & 1)) index++;
    return index;
}
static inline int lowest_bit_of(uint64_t bits) {
    unsigned low = (unsigned)(bits & 0xffffffff);
    return low != 0 ? lowest_bit(low) : 32 + lowest_bit((unsigned)(bits >> 32));
}
static inline int bit_count(unsigned bits) {
    int count = 0;
    for (; bits != 0; bits &= bits - 1) count++;
    return count;
}
#endif

/* ---------------------------------------------------------------- floats: culling */

#if defined(GI_IS_AVX512) || defined(GI_IS_AVX2)
enum { GI_FLOATS = 8 };
typedef __m256 F;
static inline F f_of(float x) { return _mm256_set1_ps(x); }
static inline F f_load(const float *p) { return _mm256_loadu_ps(p); }
static inline void f_store(float *p, F a) { _mm256_storeu_ps(p, a); }
static inline F f_min(F a, F b) { return _mm256_min_ps(a, b); }
static inline F f_max(F a, F b) { return _mm256_max_ps(a, b); }
/* a * b + c. Culling may round once or twice, so unlike the exact tests it may fuse. */
static inline F f_fused(F a, F b, F c) { return _mm256_fmadd_ps(a, b, c); }
static inline F f_less_fused(F a, F b, F c) { return _mm256_fnmadd_ps(a, b, c); } /* c - a * b */
#ifdef GI_IS_AVX512
static inline unsigned f_less_equal(F a, F b) { return _mm256_cmp_ps_mask(a, b, _CMP_LE_OQ); }
static inline unsigned f_less(F a, F b) { return _mm256_cmp_ps_mask(a, b, _CMP_LT_OQ); }
#else
static inline unsigned f_less_equal(F a, F b) {
    return (unsigned)_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ));
}
static inline unsigned f_less(F a, F b) {
    return (unsigned)_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OQ));
}
#endif
#elif defined(GI_IS_SSE2)
enum { GI_FLOATS = 4 };
typedef __m128 F;
static inline F f_of(float x) { return _mm_set1_ps(x); }
static inline F f_load(const float *p) { return _mm_loadu_ps(p); }
static inline void f_store(float *p, F a) { _mm_storeu_ps(p, a); }
static inline F f_min(F a, F b) { return _mm_min_ps(a, b); }
static inline F f_max(F a, F b) { return _mm_max_ps(a, b); }
static inline F f_fused(F a, F b, F c) { return a * b + c; }
static inline F f_less_fused(F a, F b, F c) { return c - a * b; }
static inline unsigned f_less_equal(F a, F b) {
    return (unsigned)_mm_movemask_ps(_mm_cmple_ps(a, b));
}
static inline unsigned f_less(F a, F b) { return (unsigned)_mm_movemask_ps(_mm_cmplt_ps(a, b)); }
#else
enum { GI_FLOATS = 1 };
typedef float F;
static inline F f_of(float x) { return x; }
static inline F f_load(const float *p) { return *p; }
static inline void f_store(float *p, F a) { *p = a; }
static inline F f_min(F a, F b) { return a < b ? a : b; }
static inline F f_max(F a, F b) { return a > b ? a : b; }
static inline F f_fused(F a, F b, F c) { return a * b + c; }
static inline F f_less_fused(F a, F b, F c) { return c - a * b; }
static inline unsigned f_less_equal(F a, F b) { return a <= b; }
static inline unsigned f_less(F a, F b) { return a < b; }
#endif

/* What a table has for the kinds of GI_FLOATS shapes: their highest four bits, or 7 if these are
 * more. */
static inline F f_by_kind(const float table[8], const void *p) {
#if defined(GI_IS_AVX512) || defined(GI_IS_AVX2)
    __m256i kind = _mm256_srli_epi32(_mm256_loadu_si256((const __m256i *)p), 28);
    kind = _mm256_min_epu32(kind, _mm256_set1_epi32(7));
    return _mm256_permutevar8x32_ps(_mm256_loadu_ps(table), kind);
#else
    float lanes[GI_FLOATS];
    uint32_t refs[GI_FLOATS];
    memcpy(refs, p, sizeof refs);
    for (int i = 0; i < GI_FLOATS; i++) {
        uint32_t kind = refs[i] >> 28;
        lanes[i] = table[kind < 7 ? kind : 7];
    }
    return f_load(lanes);
#endif
}

/* The smallest and the largest of the lanes. */
#if defined(GI_IS_PORTABLE)
static inline float f_least(F a) { return a; }
static inline float f_most(F a) { return a; }
#else
#if defined(GI_IS_SSE2)
#define F_FOLD(op, a) (a)
#else
#define F_FOLD(op, a) op(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1))
#endif
#define F_REDUCE(op, a)                                                                            \
    __m128 four = F_FOLD(op, a), two = op(four, _mm_movehl_ps(four, four));                        \
    return _mm_cvtss_f32(op(two, _mm_shuffle_ps(two, two, 1)))
static inline float f_least(F a) { F_REDUCE(_mm_min_ps, a); }
static inline float f_most(F a) { F_REDUCE(_mm_max_ps, a); }
#undef F_REDUCE
#undef F_FOLD
#endif

/* The same of count numbers, a multiple of eight. */
static inline float f_lowest(const float *p, int count) {
    F least = f_load(p);
    for (int i = GI_FLOATS; i < count; i += GI_FLOATS) least = f_min(f_load(p + i), least);
    return f_least(least);
}
static inline float f_highest(const float *p, int count) {
    F most = f_load(p);
    for (int i = GI_FLOATS; i < count; i += GI_FLOATS) most = f_max(f_load(p + i), most);
    return f_most(most);
}

/* Of GI_FLOATS rows of sixteen numbers, the smallest, or the largest, of each row. The rows are
 * folded together, which takes half as many shuffles as one after the other. */
#if defined(GI_IS_PORTABLE)
static inline F f_ends(const float *rows, bool most) {
    return most ? f_highest(rows, 16) : f_lowest(rows, 16);
}
#else
static inline F f_end(F a, F b, bool most) { return most ? f_max(a, b) : f_min(a, b); }
#if defined(GI_IS_SSE2)
static inline F f_fold(F a, F b, bool most) {
    return f_end(_mm_unpacklo_ps(a, b), _mm_unpackhi_ps(a, b), most);
}
static inline F f_row_end(const float *p, bool most) {
    return f_end(
        f_end(f_load(p), f_load(p + 4), most), f_end(f_load(p + 8), f_load(p + 12), most), most);
}
#else
static inline F f_fold(F a, F b, bool most) { /* in halves */
    return f_end(_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b), most);
}
static inline F f_row_end(const float *p, bool most) {
    return f_end(f_load(p), f_load(p + 8), most);
}
#endif
static inline F f_four_ends(const float *rows, bool most) {
    F even = f_fold(f_row_end(rows, most), f_row_end(rows + 32, most), most);
    F odd = f_fold(f_row_end(rows + 16, most), f_row_end(rows + 48, most), most);
    return f_fold(even, odd, most);
}
static inline F f_ends(const float *rows, bool most) {
    F four = f_four_ends(rows, most);
#if !defined(GI_IS_SSE2)
    F next = f_four_ends(rows + 64, most);
    four = f_end(
        _mm256_permute2f128_ps(four, next, 0x20), _mm256_permute2f128_ps(four, next, 0x31), most);
#endif
    return four;
}
#endif

/* Eight points, coordinate by coordinate. A fourth number behind each point is read, not used. */
#if defined(GI_IS_AVX512) || defined(GI_IS_AVX2)
static inline void eight_coordinates(const float *const points[8], F xyz[3]) {
    __m256 row[4];
    for (int i = 0; i < 4; i++) {
        row[i] = _mm256_insertf128_ps(
            _mm256_castps128_ps256(_mm_loadu_ps(points[i])), _mm_loadu_ps(points[i + 4]), 1);
    }
    __m256 xy01 = _mm256_unpacklo_ps(row[0], row[1]), xy23 = _mm256_unpacklo_ps(row[2], row[3]);
    __m256 z01 = _mm256_unpackhi_ps(row[0], row[1]), z23 = _mm256_unpackhi_ps(row[2], row[3]);
    xyz[0] = _mm256_shuffle_ps(xy01, xy23, 0x44);
    xyz[1] = _mm256_shuffle_ps(xy01, xy23, 0xee);
    xyz[2] = _mm256_shuffle_ps(z01, z23, 0x44);
}
static inline void eight_points(const float *const points[8], float xyz[3][8]) {
    F rows[3];
    eight_coordinates(points, rows);
    for (int axis = 0; axis < 3; axis++) f_store(xyz[axis], rows[axis]);
}
#else
static inline void eight_points(const float *const points[8], float xyz[3][8]) {
    for (int i = 0; i < 8; i++) {
        for (int axis = 0; axis < 3; axis++) xyz[axis][i] = points[i][axis];
    }
}
#endif

/* ---------------------------------------------------------------- floats: gamma */

/* Sixteen values, clamped, through the table of math/gamma.h. The smallest value comes second to
 * max, which then takes it for NaN. With AVX-512 the look-ups take 0.27 ns a value, with AVX2 0.45,
 * one by one 0.8. */
#if defined(GI_IS_AVX512)
static inline void sixteen_gamma(const uint32_t *table, const float p[16], uint8_t to[16]) {
    __m512 value = _mm512_max_ps(_mm512_loadu_ps(p), _mm512_set1_ps(GI_GAMMA_LOWEST));
    __m512i bits = _mm512_castps_si512(_mm512_min_ps(value, _mm512_set1_ps(1)));
    __m512i bucket = _mm512_srli_epi32(
        _mm512_sub_epi32(bits, _mm512_set1_epi32(GI_GAMMA_LOWEST_BITS)), GI_GAMMA_LOW_BITS);
    __m512i low = _mm512_and_si512(bits, _mm512_set1_epi32((1 << GI_GAMMA_LOW_BITS) - 1));
    __m512i sum = _mm512_add_epi32(_mm512_i32gather_epi32(bucket, table, 4), low);
    __m128i all = _mm512_cvtepi32_epi8(_mm512_srli_epi32(sum, GI_GAMMA_LOW_BITS));
    _mm_storeu_si128((__m128i *)(void *)to, all);
}
#elif defined(GI_IS_AVX2)
static inline __m256i eight_gamma(const uint32_t *table, const float p[8]) {
    __m256 value = _mm256_max_ps(_mm256_loadu_ps(p), _mm256_set1_ps(GI_GAMMA_LOWEST));
    __m256i bits = _mm256_castps_si256(_mm256_min_ps(value, _mm256_set1_ps(1)));
    __m256i bucket = _mm256_srli_epi32(
        _mm256_sub_epi32(bits, _mm256_set1_epi32(GI_GAMMA_LOWEST_BITS)), GI_GAMMA_LOW_BITS);
    __m256i low = _mm256_and_si256(bits, _mm256_set1_epi32((1 << GI_GAMMA_LOW_BITS) - 1));
    __m256i entry = _mm256_i32gather_epi32((const int *)(const void *)table, bucket, 4);
    return _mm256_srli_epi32(_mm256_add_epi32(entry, low), GI_GAMMA_LOW_BITS);
}
static inline void sixteen_gamma(const uint32_t *table, const float p[16], uint8_t to[16]) {
    __m256i words = _mm256_packus_epi32(eight_gamma(table, p), eight_gamma(table, p + 8));
    words = _mm256_permute4x64_epi64(words, 0xd8); /* packing works in halves */
    __m128i low = _mm256_castsi256_si128(words), high = _mm256_extracti128_si256(words, 1);
    _mm_storeu_si128((__m128i *)(void *)to, _mm_packus_epi16(low, high));
}
#else
static inline void sixteen_gamma(const uint32_t *table, const float p[16], uint8_t to[16]) {
    float clamped[16];
    for (int i = 0; i < 16; i += GI_FLOATS) {
        F value = f_max(f_load(p + i), f_of(GI_GAMMA_LOWEST));
        f_store(clamped + i, f_min(value, f_of(1)));
    }
    for (int i = 0; i < 16; i++) to[i] = gi_gamma_byte(table, clamped[i]);
}
#endif

/* ---------------------------------------------------------------- doubles: deciding */

#if defined(GI_IS_AVX512)
enum { GI_DOUBLES = 8 };
#define R                  __m512d
#define M                  __mmask8
#define R_OF(x)            _mm512_set1_pd(x)
#define R_SQRT(a)          _mm512_sqrt_pd(a)
#define R_MIN(a, b)        _mm512_min_pd(a, b)
#define R_MAX(a, b)        _mm512_max_pd(a, b)
#define R_LESS(a, b)       _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ)
#define R_LESS_EQUAL(a, b) _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ)
#define R_EQUAL(a, b)      _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ)
#define R_SELECT(m, a, b)  _mm512_mask_blend_pd((M)(m), b, a)
#define M_OF(x)            ((M)(-(int)(x)))
#define M_NOT(m)           ((M)(~(m)))
static inline unsigned m_bits(M m) { return m; }
static inline M m_from_bits(unsigned bits) { return (M)bits; }
static inline R r_load(const double *p) { return _mm512_loadu_pd(p); }
static inline void r_store(double *p, R a) { _mm512_storeu_pd(p, a); }
static inline void r_store_floats(float *p, R a) { _mm256_storeu_ps(p, _mm512_cvtpd_ps(a)); }
static inline void u_store_where(uint32_t *p, unsigned bits, uint32_t value) {
    _mm256_mask_storeu_epi32(p, (__mmask8)bits, _mm256_set1_epi32((int)value));
}
#define R_ABS(a) _mm512_abs_pd(a)
static inline R r_from_floats(const float *p) { return _mm512_cvtps_pd(_mm256_loadu_ps(p)); }
typedef __m256i U;
static inline U u_of(uint32_t x) { return _mm256_set1_epi32((int)x); }
static inline U u_load(const uint32_t *p) {
    return _mm256_loadu_si256((const __m256i *)(const void *)p);
}
static inline void u_store(uint32_t *p, U a) { _mm256_storeu_si256((__m256i *)(void *)p, a); }
static inline U u_gather(const uint32_t *p, U index) {
    return _mm256_i32gather_epi32((const int *)(const void *)p, index, 4);
}
/* Those of a where bits are set. */
static inline U u_select(unsigned bits, U a, U b) {
    return _mm256_mask_blend_epi32((__mmask8)bits, b, a);
}
static inline bool u_is_one(U a) { /* all the same */
    return _mm256_cmpneq_epi32_mask(a, _mm256_broadcastd_epi32(_mm256_castsi256_si128(a))) == 0;
}
static inline bool u_is_run(U a) { /* each the one before, plus one */
    const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    return u_is_one(_mm256_sub_epi32(a, lane));
}
static inline size_t u_first(U a) { return (uint32_t)_mm_cvtsi128_si32(_mm256_castsi256_si128(a)); }
static inline U u_widen(const uint16_t *p) {
    return _mm256_cvtepu16_epi32(_mm_loadu_si128((const __m128i *)(const void *)p));
}
static inline R r_gather(const double *p, U index, int stride) {
    return _mm512_i32gather_pd(_mm256_mullo_epi32(index, _mm256_set1_epi32(stride)), p, 8);
}
/* Writes the lanes whose bits are set one after the other; there must be room for all. */
static inline void r_append_floats(float *to, R a, unsigned bits) {
    _mm256_storeu_ps(to, _mm256_maskz_compress_ps((__mmask8)bits, _mm512_cvtpd_ps(a)));
}
/* The same of base, base + 1, ... */
static inline void u_append_indices(uint32_t *to, unsigned bits, uint32_t base) {
    __m256i all =
        _mm256_add_epi32(_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), _mm256_set1_epi32((int)base));
    _mm256_storeu_si256((__m256i *)(void *)to, _mm256_maskz_compress_epi32((__mmask8)bits, all));
}
/* Of bytes that are 0 or 1. */
static inline M m_from_bytes(const uint8_t *p) {
    __m128i all = _mm_loadl_epi64((const __m128i *)(const void *)p);
    return (M)_mm_test_epi8_mask(all, all);
}
#elif defined(GI_IS_AVX2)
enum { GI_DOUBLES = 4 };
#define R                  __m256d
#define M                  __m256i
#define M_FROM(a)          _mm256_castpd_si256(a)
#define R_OF(x)            _mm256_set1_pd(x)
#define R_SQRT(a)          _mm256_sqrt_pd(a)
#define R_MIN(a, b)        _mm256_min_pd(a, b)
#define R_MAX(a, b)        _mm256_max_pd(a, b)
#define R_LESS(a, b)       M_FROM(_mm256_cmp_pd(a, b, _CMP_LT_OQ))
#define R_LESS_EQUAL(a, b) M_FROM(_mm256_cmp_pd(a, b, _CMP_LE_OQ))
#define R_EQUAL(a, b)      M_FROM(_mm256_cmp_pd(a, b, _CMP_EQ_OQ))
#define R_SELECT(m, a, b)  _mm256_blendv_pd(b, a, _mm256_castsi256_pd(m))
#define M_OF(x)            _mm256_set1_epi64x(-(long long)(x))
#define M_NOT(m)           (~(m))
#define R_ABS(a)           _mm256_andnot_pd(_mm256_set1_pd(-0.0), a)
static inline unsigned m_bits(M m) { return (unsigned)_mm256_movemask_pd(_mm256_castsi256_pd(m)); }
static inline M m_from_bits(unsigned bits) {
    const __m256i each = _mm256_setr_epi64x(1, 2, 4, 8);
    return _mm256_cmpeq_epi64(_mm256_and_si256(_mm256_set1_epi64x(bits), each), each);
}
static inline M m_from_bytes(const uint8_t *p) {
    int all;
    memcpy(&all, p, sizeof all);
    return _mm256_sub_epi64(_mm256_setzero_si256(), _mm256_cvtepu8_epi64(_mm_cvtsi32_si128(all)));
}
static inline R r_load(const double *p) { return _mm256_loadu_pd(p); }
static inline void r_store(double *p, R a) { _mm256_storeu_pd(p, a); }
static inline void r_store_floats(float *p, R a) { _mm_storeu_ps(p, _mm256_cvtpd_ps(a)); }
static inline R r_from_floats(const float *p) { return _mm256_cvtps_pd(_mm_loadu_ps(p)); }
typedef __m128i U;
static inline U u_of(uint32_t x) { return _mm_set1_epi32((int)x); }
static inline U u_load(const uint32_t *p) {
    return _mm_loadu_si128((const __m128i *)(const void *)p);
}
static inline void u_store(uint32_t *p, U a) { _mm_storeu_si128((__m128i *)(void *)p, a); }
static inline U u_gather(const uint32_t *p, U index) {
    return _mm_i32gather_epi32((const int *)(const void *)p, index, 4);
}
static inline U u_select(unsigned bits, U a, U b) {
    const __m128i each = _mm_setr_epi32(1, 2, 4, 8);
    __m128i where = _mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32((int)bits), each), each);
    return _mm_blendv_epi8(b, a, where);
}
static inline bool u_is_one(U a) {
    return _mm_movemask_epi8(_mm_cmpeq_epi32(a, _mm_broadcastd_epi32(a))) == 0xffff;
}
static inline bool u_is_run(U a) { return u_is_one(_mm_sub_epi32(a, _mm_setr_epi32(0, 1, 2, 3))); }
static inline size_t u_first(U a) { return (uint32_t)_mm_cvtsi128_si32(a); }
static inline U u_widen(const uint16_t *p) {
    return _mm_cvtepu16_epi32(_mm_loadl_epi64((const __m128i *)(const void *)p));
}
static inline R r_gather(const double *p, U index, int stride) {
    return _mm256_i32gather_pd(p, _mm_mullo_epi32(index, _mm_set1_epi32(stride)), 8);
}
#elif defined(GI_IS_SSE2)
enum { GI_DOUBLES = 2 };
#define R                  __m128d
#define M                  __m128i
#define M_FROM(a)          _mm_castpd_si128(a)
#define R_OF(x)            _mm_set1_pd(x)
#define R_SQRT(a)          _mm_sqrt_pd(a)
#define R_MIN(a, b)        _mm_min_pd(a, b)
#define R_MAX(a, b)        _mm_max_pd(a, b)
#define R_LESS(a, b)       M_FROM(_mm_cmplt_pd(a, b))
#define R_LESS_EQUAL(a, b) M_FROM(_mm_cmple_pd(a, b))
#define R_EQUAL(a, b)      M_FROM(_mm_cmpeq_pd(a, b))
#define R_SELECT(m, a, b)  r_select(m, a, b)
#define M_OF(x)            _mm_set1_epi64x(-(long long)(x))
#define M_NOT(m)           (~(m))
#define R_ABS(a)           _mm_andnot_pd(_mm_set1_pd(-0.0), a)
static inline R r_select(M m, R a, R b) {
    return _mm_castsi128_pd(
        _mm_or_si128(_mm_and_si128(m, M_FROM(a)), _mm_andnot_si128(m, M_FROM(b))));
}
static inline unsigned m_bits(M m) { return (unsigned)_mm_movemask_pd(_mm_castsi128_pd(m)); }
static inline M m_from_bits(unsigned bits) {
    return _mm_set_epi64x(-(long long)(bits >> 1 & 1), -(long long)(bits & 1));
}
static inline M m_from_bytes(const uint8_t *p) {
    return _mm_set_epi64x(-(long long)p[1], -(long long)p[0]);
}
static inline R r_load(const double *p) { return _mm_loadu_pd(p); }
static inline void r_store(double *p, R a) { _mm_storeu_pd(p, a); }
static inline void r_store_floats(float *p, R a) {
    _mm_storel_epi64((__m128i *)(void *)p, _mm_castps_si128(_mm_cvtpd_ps(a)));
}
static inline R r_from_floats(const float *p) {
    return _mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64((const __m128i *)(const void *)p)));
}
/* Two whole numbers in the lower half. */
typedef __m128i U;
static inline U u_of(uint32_t x) { return _mm_set1_epi32((int)x); }
static inline U u_load(const uint32_t *p) {
    return _mm_loadl_epi64((const __m128i *)(const void *)p);
}
static inline void u_store(uint32_t *p, U a) { _mm_storel_epi64((__m128i *)(void *)p, a); }
static inline U u_select(unsigned bits, U a, U b) {
    __m128i where = _mm_set_epi32(0, 0, -(int)(bits >> 1 & 1), -(int)(bits & 1));
    return (a & where) | (b & ~where);
}
static inline size_t u_first(U a) { return (uint32_t)_mm_cvtsi128_si32(a); }
static inline size_t u_second(U a) { return u_first(_mm_shuffle_epi32(a, 1)); }
static inline bool u_is_one(U a) { return u_first(a) == u_second(a); }
static inline bool u_is_run(U a) { return u_first(a) + 1 == u_second(a); }
static inline U u_gather(const uint32_t *p, U index) {
    return _mm_set_epi32(0, 0, (int)p[u_second(index)], (int)p[u_first(index)]);
}
static inline U u_widen(const uint16_t *p) { return _mm_set_epi32(0, 0, p[1], p[0]); }
static inline R r_gather(const double *p, U index, int stride) {
    return _mm_set_pd(p[u_second(index) * (size_t)stride], p[u_first(index) * (size_t)stride]);
}
#else
enum { GI_DOUBLES = 1 };
#define R                  double
#define M                  int
#define R_OF(x)            (x)
#define R_SQRT(a)          sqrt(a)
#define R_MIN(a, b)        gi_hit_minimum(a, b)
#define R_MAX(a, b)        gi_hit_maximum(a, b)
#define R_LESS(a, b)       ((a) < (b))
#define R_LESS_EQUAL(a, b) ((a) <= (b))
#define R_EQUAL(a, b)      ((a) == (b))
#define R_SELECT(m, a, b)  ((m) ? (a) : (b))
#define M_OF(x)            ((int)(x))
#define M_NOT(m)           (!(m))
#define R_ABS(a)           fabs(a)
static inline unsigned m_bits(M m) { return (unsigned)m; }
static inline M m_from_bits(unsigned bits) { return (int)bits; }
static inline M m_from_bytes(const uint8_t *p) { return p[0]; }
static inline R r_load(const double *p) { return *p; }
static inline void r_store(double *p, R a) { *p = a; }
static inline void r_store_floats(float *p, R a) { *p = (float)a; }
static inline R r_from_floats(const float *p) { return (double)*p; }
typedef uint32_t U;
static inline U u_of(uint32_t x) { return x; }
static inline U u_load(const uint32_t *p) { return *p; }
static inline void u_store(uint32_t *p, U a) { *p = a; }
static inline U u_select(unsigned bits, U a, U b) { return bits & 1 ? a : b; }
static inline bool u_is_one(U a) {
    (void)a;
    return true;
}
static inline bool u_is_run(U a) { return u_is_one(a); }
static inline size_t u_first(U a) { return a; }
static inline U u_gather(const uint32_t *p, U index) { return p[index]; }
static inline U u_widen(const uint16_t *p) { return *p; }
static inline R r_gather(const double *p, U index, int stride) {
    return p[(size_t)index * (size_t)stride];
}
#endif

#ifndef GI_IS_AVX512
static inline void u_store_where(uint32_t *p, unsigned bits, uint32_t value) {
    for (int i = 0; i < GI_DOUBLES; i++) {
        if (bits >> i & 1) p[i] = value;
    }
}
static inline void r_append_floats(float *to, R a, unsigned bits) {
    float lane[GI_DOUBLES];
    r_store_floats(lane, a);
    for (int i = 0; i < GI_DOUBLES; i++) {
        *to = lane[i];
        to += bits >> i & 1;
    }
}
static inline void u_append_indices(uint32_t *to, unsigned bits, uint32_t base) {
    for (uint32_t i = 0; i < GI_DOUBLES; i++) {
        *to = base + i;
        to += bits >> i & 1;
    }
}
#endif

/* Rows of three floats, column by column. A fourth number behind each row is read, not used. */
#if defined(GI_IS_AVX512)
static inline void r_rows(const float *const rows[GI_DOUBLES], R columns[3]) {
    F floats[3];
    eight_coordinates(rows, floats);
    for (int i = 0; i < 3; i++) columns[i] = _mm512_cvtps_pd(floats[i]);
}
#elif defined(GI_IS_AVX2)
static inline void r_rows(const float *const rows[GI_DOUBLES], R columns[3]) {
    __m128 a = _mm_loadu_ps(rows[0]), b = _mm_loadu_ps(rows[1]), c = _mm_loadu_ps(rows[2]),
           d = _mm_loadu_ps(rows[3]);
    _MM_TRANSPOSE4_PS(a, b, c, d);
    columns[0] = _mm256_cvtps_pd(a);
    columns[1] = _mm256_cvtps_pd(b);
    columns[2] = _mm256_cvtps_pd(c);
}
#elif defined(GI_IS_SSE2)
static inline void r_rows(const float *const rows[GI_DOUBLES], R columns[3]) {
    for (int i = 0; i < 3; i++) columns[i] = _mm_set_pd((double)rows[1][i], (double)rows[0][i]);
}
#else
static inline void r_rows(const float *const rows[GI_DOUBLES], R columns[3]) {
    for (int i = 0; i < 3; i++) columns[i] = (double)rows[0][i];
}
#endif

/* As R_SELECT, of what comparisons give. */
#define R_SELECT_M(m, a, b) (((m) & (a)) | (M_NOT(m) & (b)))
