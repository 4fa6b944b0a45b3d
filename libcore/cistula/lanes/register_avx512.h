// The registers of AVX-512: 64 bytes, and masks that are bits of an integer.
#pragma once

#include <immintrin.h>

#include "cistula/lanes/vector_types.h"

namespace cistula {

/// Bytes of a register.
inline constexpr int lane_bytes = 64;

/// AVX-512's instructions for what compilers have no operators for.
namespace native {

using Floats = VectorOf<float, 16>::Type;
using Doubles = VectorOf<double, 8>::Type;
using Ints = VectorOf<int32_t, 16>::Type;
using Longs = VectorOf<int64_t, 8>::Type;

/// A mask of lanes of so many bytes, a bit each.
template <int bytes>
struct MaskRegister {
    static constexpr uint32_t all = (1u << lane_bytes / bytes) - 1u;
    uint32_t bits;

    friend CISTULA_INLINE MaskRegister operator&(MaskRegister a, MaskRegister b) { return {a.bits & b.bits}; }
    friend CISTULA_INLINE MaskRegister operator|(MaskRegister a, MaskRegister b) { return {a.bits | b.bits}; }
    friend CISTULA_INLINE MaskRegister operator~(MaskRegister a) { return {~a.bits & all}; }
};
using Mask16 = MaskRegister<4>;
using Mask8 = MaskRegister<8>;

CISTULA_INLINE Mask16 less(Floats a, Floats b) {
    return {_mm512_cmp_ps_mask(a, b, _CMP_LT_OQ)};
}
CISTULA_INLINE Mask8 less(Doubles a, Doubles b) {
    return {_mm512_cmp_pd_mask(a, b, _CMP_LT_OQ)};
}
CISTULA_INLINE Mask16 less(Ints a, Ints b) {
    return {_mm512_cmplt_epi32_mask((__m512i)a, (__m512i)b)};
}
CISTULA_INLINE Mask8 less(Longs a, Longs b) {
    return {_mm512_cmplt_epi64_mask((__m512i)a, (__m512i)b)};
}
CISTULA_INLINE Mask16 less_equal(Floats a, Floats b) {
    return {_mm512_cmp_ps_mask(a, b, _CMP_LE_OQ)};
}
CISTULA_INLINE Mask8 less_equal(Doubles a, Doubles b) {
    return {_mm512_cmp_pd_mask(a, b, _CMP_LE_OQ)};
}
CISTULA_INLINE Mask16 less_equal(Ints a, Ints b) {
    return {_mm512_cmple_epi32_mask((__m512i)a, (__m512i)b)};
}
CISTULA_INLINE Mask8 less_equal(Longs a, Longs b) {
    return {_mm512_cmple_epi64_mask((__m512i)a, (__m512i)b)};
}
CISTULA_INLINE Mask16 equal(Floats a, Floats b) {
    return {_mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ)};
}
CISTULA_INLINE Mask8 equal(Doubles a, Doubles b) {
    return {_mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ)};
}
CISTULA_INLINE Mask16 equal(Ints a, Ints b) {
    return {_mm512_cmpeq_epi32_mask((__m512i)a, (__m512i)b)};
}
CISTULA_INLINE Mask8 equal(Longs a, Longs b) {
    return {_mm512_cmpeq_epi64_mask((__m512i)a, (__m512i)b)};
}
template <class Vector>
CISTULA_INLINE auto unequal(Vector a, Vector b) {
    return ~equal(a, b);
}
CISTULA_INLINE Ints minus_ones(Mask16 mask) {
    return (Ints)_mm512_movm_epi32(__mmask16(mask.bits));
}
CISTULA_INLINE Longs minus_ones(Mask8 mask) {
    return (Longs)_mm512_movm_epi64(__mmask8(mask.bits));
}
/// Where all three numbers are in [0, 1); -0 counts as outside.
CISTULA_INLINE Mask16 are_below_one(Floats a, Floats b, Floats c) {
    const __m512i greatest = _mm512_max_epu32(_mm512_max_epu32((__m512i)a, (__m512i)b), (__m512i)c);
    return {_mm512_cmple_epu32_mask(greatest, _mm512_set1_epi32(0x3f7fffff))};
}
/// floor(2^31 a), for a in [0, 2^31): the first and the second eight.
CISTULA_INLINE void whole_of(Floats a, Longs& low, Longs& high) {
    const __m512 scaled = _mm512_mul_ps(a, _mm512_set1_ps(0x1p31f));
    low = (Longs)_mm512_cvttps_epi64(_mm512_castps512_ps256(scaled));
    high = (Longs)_mm512_cvttps_epi64(_mm512_extractf32x8_ps(scaled, 1));
}
/// The numbers of the highest bits of positive integers.
CISTULA_INLINE Ints highest_bits(Ints a) {
    return (Ints)_mm512_sub_epi32(_mm512_set1_epi32(31), _mm512_lzcnt_epi32((__m512i)a));
}
CISTULA_INLINE __m128 three_at(const float* from) {
    return _mm_movelh_ps(_mm_loadl_pi(_mm_setzero_ps(), reinterpret_cast<const __m64*>(from)), _mm_load_ss(from + 2));
}
/// Three numbers from each of these places.
CISTULA_INLINE void gather_three(const float* from, Ints places, Floats& x, Floats& y, Floats& z) {
    alignas(64) int32_t at[16];
    _mm512_store_si512(at, (__m512i)places);
    const auto four = [&](int i) {
        __m512 v = _mm512_castps128_ps512(three_at(from + uint32_t(at[i])));
        v = _mm512_insertf32x4(v, three_at(from + uint32_t(at[i + 4])), 1);
        v = _mm512_insertf32x4(v, three_at(from + uint32_t(at[i + 8])), 2);
        return _mm512_insertf32x4(v, three_at(from + uint32_t(at[i + 12])), 3);
    };
    const __m512 a = four(0);
    const __m512 b = four(1);
    const __m512 c = four(2);
    const __m512 d = four(3);
    const __m512 ab = _mm512_unpacklo_ps(a, b);
    const __m512 cd = _mm512_unpacklo_ps(c, d);
    x = _mm512_shuffle_ps(ab, cd, 0x44);
    y = _mm512_shuffle_ps(ab, cd, 0xee);
    z = _mm512_shuffle_ps(_mm512_unpackhi_ps(a, b), _mm512_unpackhi_ps(c, d), 0x44);
}
/// Entries of tables of so many bytes each that looked_up() takes.
template <int bytes>
inline constexpr uint32_t table_entries = bytes == 4 ? 16 : 8;
CISTULA_INLINE Floats looked_up(const float* table, Ints index) {
    return _mm512_permutexvar_ps((__m512i)index, _mm512_load_ps(table));
}
CISTULA_INLINE Doubles looked_up(const double* table, Longs index) {
    return _mm512_permutexvar_pd((__m512i)index, _mm512_load_pd(table));
}
CISTULA_INLINE Ints looked_up(const int32_t* table, Ints index) {
    return (Ints)_mm512_permutexvar_epi32((__m512i)index, _mm512_load_si512(table));
}
CISTULA_INLINE Longs looked_up(const int64_t* table, Longs index) {
    return (Longs)_mm512_permutexvar_epi64((__m512i)index, _mm512_load_si512(table));
}
CISTULA_INLINE Longs masked(Mask8 mask, Longs a) {
    return (Longs)_mm512_maskz_mov_epi64(__mmask8(mask.bits), (__m512i)a);
}
CISTULA_INLINE Ints masked(Mask16 mask, Ints a) {
    return (Ints)_mm512_maskz_mov_epi32(__mmask16(mask.bits), (__m512i)a);
}
CISTULA_INLINE Floats masked(Mask16 mask, Floats a) {
    return _mm512_maskz_mov_ps(__mmask16(mask.bits), a);
}
/// The mask with these bits.
template <int bytes>
CISTULA_INLINE MaskRegister<bytes> mask_of(uint32_t bits) {
    return {bits & MaskRegister<bytes>::all};
}
template <int bytes>
CISTULA_INLINE MaskRegister<bytes> mask_of_all(bool all) {
    return {all ? MaskRegister<bytes>::all : 0u};
}
template <int bytes>
CISTULA_INLINE uint32_t bits(MaskRegister<bytes> mask) {
    return mask.bits;
}
CISTULA_INLINE Floats fused(Floats a, Floats b, Floats c) {
    return _mm512_fmadd_ps(a, b, c);
}
CISTULA_INLINE Doubles fused(Doubles a, Doubles b, Doubles c) {
    return _mm512_fmadd_pd(a, b, c);
}
CISTULA_INLINE Floats square_root(Floats a) {
    return _mm512_sqrt_ps(a);
}
CISTULA_INLINE Doubles square_root(Doubles a) {
    return _mm512_sqrt_pd(a);
}
CISTULA_INLINE Floats floor_of(Floats a) {
    return _mm512_floor_ps(a);
}
CISTULA_INLINE Doubles floor_of(Doubles a) {
    return _mm512_floor_pd(a);
}
CISTULA_INLINE Floats min_or_second(Floats a, Floats b) {
    return _mm512_min_ps(a, b);
}
CISTULA_INLINE Doubles min_or_second(Doubles a, Doubles b) {
    return _mm512_min_pd(a, b);
}
CISTULA_INLINE Floats max_or_second(Floats a, Floats b) {
    return _mm512_max_ps(a, b);
}
CISTULA_INLINE Doubles max_or_second(Doubles a, Doubles b) {
    return _mm512_max_pd(a, b);
}
CISTULA_INLINE Floats select(Mask16 mask, Floats a, Floats b) {
    return _mm512_mask_blend_ps(__mmask16(mask.bits), b, a);
}
CISTULA_INLINE Doubles select(Mask8 mask, Doubles a, Doubles b) {
    return _mm512_mask_blend_pd(__mmask8(mask.bits), b, a);
}
CISTULA_INLINE Ints select(Mask16 mask, Ints a, Ints b) {
    return (Ints)_mm512_mask_blend_epi32(__mmask16(mask.bits), (__m512i)b, (__m512i)a);
}
CISTULA_INLINE Longs select(Mask8 mask, Longs a, Longs b) {
    return (Longs)_mm512_mask_blend_epi64(__mmask8(mask.bits), (__m512i)b, (__m512i)a);
}
CISTULA_INLINE Doubles low_half(Floats a) {
    return _mm512_cvtps_pd(_mm512_castps512_ps256(a));
}
CISTULA_INLINE Doubles high_half(Floats a) {
    return _mm512_cvtps_pd(_mm512_extractf32x8_ps(a, 1));
}
CISTULA_INLINE Floats joined(Doubles low, Doubles high) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(low)), _mm512_cvtpd_ps(high), 1);
}
/// The halves of a mask as masks of lanes of twice the size, and back.
CISTULA_INLINE Mask8 low_half(Mask16 a) {
    return {a.bits & Mask8::all};
}
CISTULA_INLINE Mask8 high_half(Mask16 a) {
    return {a.bits >> 8};
}
CISTULA_INLINE Mask16 joined(Mask8 low, Mask8 high) {
    return {low.bits | high.bits << 8};
}
/// Shifts by a number of bits a lane; 0 for more than 63, or below 0.
CISTULA_INLINE Longs shifted_left(Longs a, Longs by) {
    return (Longs)_mm512_sllv_epi64((__m512i)a, (__m512i)by);
}
CISTULA_INLINE Longs shifted_right(Longs a, Longs by) {
    return (Longs)_mm512_srlv_epi64((__m512i)a, (__m512i)by);
}
/// The lanes of the mask, moved to the front; the others are 0.
template <class Vector>
CISTULA_INLINE Vector packed(Vector a, uint32_t mask) {
    if constexpr (sizeof(a[0]) == 4)
        return (Vector)_mm512_maskz_compress_epi32(__mmask16(mask), (__m512i)a);
    else
        return (Vector)_mm512_maskz_compress_epi64(__mmask8(mask), (__m512i)a);
}

}  // namespace native
}  // namespace cistula
