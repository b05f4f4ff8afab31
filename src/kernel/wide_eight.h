/* SPDX-License-Identifier: MIT
 * The part of wide.h that many.h needs: vectors of eight floats and of eight numbers. Instruction
 * sets without them do without it. */
#pragma once

#if defined(GI_IS_AVX512) || defined(GI_IS_AVX2)
#define GI_HAS_EIGHT 1

/* a * b - c */
static inline F f_fused_less(F a, F b, F c) { return _mm256_fmsub_ps(a, b, c); }
static inline F f_sqrt(F a) { return _mm256_sqrt_ps(a); }
/* a, or -a where b is negative. */
static inline F f_signed_by(F a, F b) {
    return _mm256_xor_ps(a, _mm256_and_ps(_mm256_set1_ps(-0.0f), b));
}
/* The larger of two sizes. */
#ifdef GI_IS_AVX512
static inline F f_larger_size(F a, F b) { return _mm256_range_ps(a, b, 0xb); }
#else
static inline F f_larger_size(F a, F b) {
    const F sign = _mm256_set1_ps(-0.0f);
    return f_max(_mm256_andnot_ps(sign, a), _mm256_andnot_ps(sign, b));
}
#endif

/* Moves the lanes whose bits are set to the front, in order. */
#ifdef GI_IS_AVX512
static inline __m256i eight_compress(__m256i a, unsigned bits) {
    return _mm256_maskz_compress_epi32((__mmask8)bits, a);
}
#else
static inline __m256i eight_compress(__m256i a, unsigned bits) {
    uint64_t bytes = _pdep_u64(bits, 0x0101010101010101u) * 255;
    uint64_t lanes = _pext_u64(0x0706050403020100u, bytes);
    __m256i order = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((long long)lanes));
    return _mm256_permutevar8x32_epi32(a, order);
}
#endif

/* Writes those of eight whose bits are set, in order, and returns how many. There must be room
 * for eight. */
static inline int eight_append(uint32_t *to, const void *from, unsigned bits) {
    __m256i all = _mm256_loadu_si256((const __m256i *)from);
    _mm256_storeu_si256((__m256i *)(void *)to, eight_compress(all, bits));
    return _mm_popcnt_u32(bits);
}

/* The same of base, base + 1, ... */
static inline int eight_append_indices(uint32_t *to, uint32_t base, unsigned bits) {
    __m256i all =
        _mm256_add_epi32(_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), _mm256_set1_epi32((int)base));
    _mm256_storeu_si256((__m256i *)(void *)to, eight_compress(all, bits));
    return _mm_popcnt_u32(bits);
}

/* Eight times the same. */
static inline void eight_fill(uint32_t *to, uint32_t value) {
    _mm256_storeu_si256((__m256i *)(void *)to, _mm256_set1_epi32((int)value));
}

/* Bits of those of eight whose highest four bits are those of value. */
static inline unsigned eight_of_kind(uint32_t value, const void *p) {
    __m256i all = _mm256_loadu_si256((const __m256i *)p);
    __m256i other = _mm256_xor_si256(all, _mm256_set1_epi32((int)value));
    __m256i equal = _mm256_cmpeq_epi32(_mm256_srli_epi32(other, 28), _mm256_setzero_si256());
    return (unsigned)_mm256_movemask_ps(_mm256_castsi256_ps(equal));
}

/* Writes keys and values whose bits are set, largest key first, and returns how many; there must
 * be room for eight. No key is minus infinity. What is sorted, by a network without a branch, are
 * the keys with their lanes' numbers in the lowest three bits, and so they are written: up to 7
 * units in the last place off. */
static inline int eight_push_sorted(
    float *keys, uint32_t *values, F key, const uint32_t value[8], unsigned bits) {
    const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    const __m256 least = _mm256_set1_ps(-INFINITY);
    __m256i all = _mm256_loadu_si256((const __m256i *)(const void *)value);
    int count = _mm_popcnt_u32(bits);
    F a = _mm256_castsi256_ps(
        _mm256_or_si256(_mm256_and_si256(_mm256_castps_si256(key), _mm256_set1_epi32(-8)), lane));
#ifdef GI_IS_AVX512
    a = _mm256_mask_compress_ps(least, (__mmask8)bits, a);
    if (count <= 4) { /* nearly always */
        __m128 few = _mm256_castps256_ps128(a), other;
#define EXCHANGE(shuffle, lower)                                                                   \
    other = _mm_permute_ps(few, shuffle);                                                          \
    few = _mm_blend_ps(_mm_max_ps(few, other), _mm_min_ps(few, other), lower)
        EXCHANGE(0xb1, 0xa);
        EXCHANGE(0x1b, 0xc);
        EXCHANGE(0xb1, 0xa);
#undef EXCHANGE
        __m256i order = _mm256_castps_si256(_mm256_castps128_ps256(few));
        _mm_storeu_ps(keys, few);
        _mm_storeu_si128((__m128i *)(void *)values,
            _mm256_castsi256_si128(_mm256_permutevar8x32_epi32(all, order)));
        return count;
    }
#else
    const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    __m256i set = _mm256_and_si256(_mm256_set1_epi32((int)bits), bit);
    a = _mm256_blendv_ps(least, a, _mm256_castsi256_ps(_mm256_cmpeq_epi32(set, bit)));
#endif
    F b;
#define EXCHANGE(shuffled, lower)                                                                  \
    b = (shuffled);                                                                                \
    a = _mm256_blend_ps(_mm256_max_ps(a, b), _mm256_min_ps(a, b), lower)
    EXCHANGE(_mm256_permute_ps(a, 0xb1), 0xaa);
    EXCHANGE(_mm256_permute_ps(a, 0x1b), 0xcc);
    EXCHANGE(_mm256_permute_ps(a, 0xb1), 0xaa);
    EXCHANGE(_mm256_permutevar8x32_ps(a, _mm256_setr_epi32(7, 6, 5, 4, 3, 2, 1, 0)), 0xf0);
    EXCHANGE(_mm256_permute_ps(a, 0x4e), 0xcc);
    EXCHANGE(_mm256_permute_ps(a, 0xb1), 0xaa);
#undef EXCHANGE
    _mm256_storeu_ps(keys, a);
    _mm256_storeu_si256(
        (__m256i *)(void *)values, _mm256_permutevar8x32_epi32(all, _mm256_castps_si256(a)));
    return count;
}

/* Of entries from begin to end - 1, keeps those whose key is at most limit, in order, and returns
 * the new end. There must be room for eight more. */
static inline int eight_keep_up_to(float *keys, uint32_t *values, int begin, int end, float limit) {
    int kept = begin;
    for (int i = begin; i < end; i += 8) {
        __m256 key = _mm256_loadu_ps(keys + i);
        __m256i value = _mm256_loadu_si256((const __m256i *)(const void *)(values + i));
        unsigned bits =
            f_less_equal(key, f_of(limit)) & (end - i < 8 ? (1u << (end - i)) - 1 : 255);
        _mm256_storeu_si256(
            (__m256i *)(void *)(keys + kept), eight_compress(_mm256_castps_si256(key), bits));
        _mm256_storeu_si256((__m256i *)(void *)(values + kept), eight_compress(value, bits));
        kept += _mm_popcnt_u32(bits);
    }
    return kept;
}

/* Rows to columns: to[i] gets the numbers i of the rows. */
static inline void eight_transpose(float *const to[8], float rows[8][8]) {
    F low[4], high[4]; /* of rows i and i + 4: columns 0 to 3, and 4 to 7 */
    for (int i = 0; i < 4; i++) {
        low[i] = _mm256_insertf128_ps(
            _mm256_castps128_ps256(_mm_loadu_ps(rows[i])), _mm_loadu_ps(rows[i + 4]), 1);
        high[i] = _mm256_insertf128_ps(
            _mm256_castps128_ps256(_mm_loadu_ps(rows[i] + 4)), _mm_loadu_ps(rows[i + 4] + 4), 1);
    }
    for (int half = 0; half < 2; half++) {
        const F *four = half == 0 ? low : high;
        F a = _mm256_unpacklo_ps(four[0], four[1]), b = _mm256_unpacklo_ps(four[2], four[3]);
        F c = _mm256_unpackhi_ps(four[0], four[1]), d = _mm256_unpackhi_ps(four[2], four[3]);
        _mm256_storeu_ps(to[4 * half], _mm256_shuffle_ps(a, b, 0x44));
        _mm256_storeu_ps(to[4 * half + 1], _mm256_shuffle_ps(a, b, 0xee));
        _mm256_storeu_ps(to[4 * half + 2], _mm256_shuffle_ps(c, d, 0x44));
        _mm256_storeu_ps(to[4 * half + 3], _mm256_shuffle_ps(c, d, 0xee));
    }
}

/* Lowers each of `count` numbers, a multiple of sixteen, by one, but not below zero, and reads
 * what is there in rows of `stride`: to[i] = p[i * stride + places[i]]. */
static inline void step_down(
    uint32_t *to, const uint32_t *p, int32_t *places, int stride, int count) {
#ifdef GI_IS_AVX512
    const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i rows = _mm512_mullo_epi32(lanes, _mm512_set1_epi32(stride));
    for (int i = 0; i < count; i += 16) {
        __m512i place = _mm512_add_epi32(_mm512_loadu_si512(places + i), _mm512_set1_epi32(-1));
        place = _mm512_max_epi32(place, _mm512_setzero_si512());
        _mm512_storeu_si512(places + i, place);
        __m512i at = _mm512_add_epi32(place, rows);
        _mm512_storeu_si512(to + i, _mm512_i32gather_epi32(at, p + i * stride, 4));
    }
#else
    const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    const __m256i rows = _mm256_mullo_epi32(lanes, _mm256_set1_epi32(stride));
    for (int i = 0; i < count; i += 8) {
        __m256i place = _mm256_loadu_si256((const __m256i *)(const void *)(places + i));
        place = _mm256_add_epi32(place, _mm256_set1_epi32(-1));
        place = _mm256_max_epi32(place, _mm256_setzero_si256());
        _mm256_storeu_si256((__m256i *)(void *)(places + i), place);
        __m256i at = _mm256_add_epi32(place, rows);
        _mm256_storeu_si256((__m256i *)(void *)(to + i),
            _mm256_i32gather_epi32((const int *)(const void *)(p + i * stride), at, 4));
    }
#endif
}

/* Writes the places of those of `count` numbers, a multiple of sixteen, whose bits under the mask
 * are value, and returns how many. There must be room for sixteen
 * more. */
static inline int places_where(
    uint32_t *to, const uint32_t *p, int count, uint32_t mask, uint32_t value) {
    int found = 0;
#ifdef GI_IS_AVX512
    const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    for (int i = 0; i < count; i += 16) {
        __m512i all = _mm512_and_si512(_mm512_loadu_si512(p + i), _mm512_set1_epi32((int)mask));
        __mmask16 bits = _mm512_cmpeq_epi32_mask(all, _mm512_set1_epi32((int)value));
        __m512i places = _mm512_add_epi32(lanes, _mm512_set1_epi32(i));
        _mm512_storeu_si512(to + found, _mm512_maskz_compress_epi32(bits, places));
        found += _mm_popcnt_u32(bits);
    }
#else
    for (int i = 0; i < count; i += 8) {
        __m256i all = _mm256_and_si256(_mm256_loadu_si256((const __m256i *)(const void *)(p + i)),
            _mm256_set1_epi32((int)mask));
        __m256i equal = _mm256_cmpeq_epi32(all, _mm256_set1_epi32((int)value));
        unsigned bits = (unsigned)_mm256_movemask_ps(_mm256_castsi256_ps(equal));
        found += eight_append_indices(to + found, (uint32_t)i, bits);
    }
#endif
    return found;
}
#endif
