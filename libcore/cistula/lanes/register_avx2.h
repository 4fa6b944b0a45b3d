// The registers of AVX2: 32 bytes, and masks that are registers of all ones and zeros. What a register can do is named
// in this file and in its siblings for other instruction sets (register_avx512.h), and nowhere else.
#pragma once

#include <immintrin.h>

#include "cistula/lanes/vector_types.h"

namespace cistula {

/// Bytes of a register.
inline constexpr int lane_bytes = 32;

/// AVX2's instructions for what compilers have no operators for.
namespace native {

using Floats = VectorOf<float, 8>::Type;
using Doubles = VectorOf<double, 4>::Type;
using Ints = VectorOf<int32_t, 8>::Type;
using Longs = VectorOf<int64_t, 4>::Type;

/// A mask of lanes of so many bytes.
template <int bytes>
using MaskRegister = std::conditional_t<bytes == 4, Ints, Longs>;

template <class Vector>
CISTULA_INLINE auto less(Vector a, Vector b) {
    return (MaskRegister<sizeof(a[0])>)(a < b);
}
template <class Vector>
CISTULA_INLINE auto less_equal(Vector a, Vector b) {
    return (MaskRegister<sizeof(a[0])>)(a <= b);
}
template <class Vector>
CISTULA_INLINE auto equal(Vector a, Vector b) {
    return (MaskRegister<sizeof(a[0])>)(a == b);
}
template <class Vector>
CISTULA_INLINE auto unequal(Vector a, Vector b) {
    return (MaskRegister<sizeof(a[0])>)(a != b);
}
/// -1 in the lanes of the mask, 0 in others.
CISTULA_INLINE Ints minus_ones(Ints mask) {
    return mask;
}
CISTULA_INLINE Longs minus_ones(Longs mask) {
    return mask;
}
/// The mask with these bits.
template <int bytes>
CISTULA_INLINE MaskRegister<bytes> mask_of(uint32_t bits) {
    using Whole = SignedOf<bytes>;
    MaskRegister<bytes> one{};
    for (int i = 0; i < lane_bytes / bytes; ++i) one[i] = Whole(1) << i;
    return (MaskRegister<bytes>)(((MaskRegister<bytes>{} + Whole(bits)) & one) != 0);
}
template <int bytes>
CISTULA_INLINE MaskRegister<bytes> mask_of_all(bool all) {
    return MaskRegister<bytes>{} - SignedOf<bytes>(all);
}

CISTULA_INLINE Floats fused(Floats a, Floats b, Floats c) {
    return _mm256_fmadd_ps(a, b, c);
}
CISTULA_INLINE Doubles fused(Doubles a, Doubles b, Doubles c) {
    return _mm256_fmadd_pd(a, b, c);
}
CISTULA_INLINE Floats square_root(Floats a) {
    return _mm256_sqrt_ps(a);
}
CISTULA_INLINE Doubles square_root(Doubles a) {
    return _mm256_sqrt_pd(a);
}
CISTULA_INLINE Floats floor_of(Floats a) {
    return _mm256_floor_ps(a);
}
CISTULA_INLINE Doubles floor_of(Doubles a) {
    return _mm256_floor_pd(a);
}
CISTULA_INLINE Floats min_or_second(Floats a, Floats b) {
    return _mm256_min_ps(a, b);
}
CISTULA_INLINE Doubles min_or_second(Doubles a, Doubles b) {
    return _mm256_min_pd(a, b);
}
CISTULA_INLINE Floats max_or_second(Floats a, Floats b) {
    return _mm256_max_ps(a, b);
}
CISTULA_INLINE Doubles max_or_second(Doubles a, Doubles b) {
    return _mm256_max_pd(a, b);
}
CISTULA_INLINE Floats select(Ints mask, Floats a, Floats b) {
    return _mm256_blendv_ps(b, a, (__m256)mask);
}
CISTULA_INLINE Doubles select(Longs mask, Doubles a, Doubles b) {
    return _mm256_blendv_pd(b, a, (__m256d)mask);
}
CISTULA_INLINE Ints select(Ints mask, Ints a, Ints b) {
    return (Ints)_mm256_blendv_ps((__m256)b, (__m256)a, (__m256)mask);
}
CISTULA_INLINE Longs select(Longs mask, Longs a, Longs b) {
    return (Longs)_mm256_blendv_pd((__m256d)b, (__m256d)a, (__m256d)mask);
}
/// Where all three numbers are in [0, 1); -0 counts as outside.
CISTULA_INLINE Ints are_below_one(Floats a, Floats b, Floats c) {
    const __m256i greatest = _mm256_max_epu32(_mm256_max_epu32((__m256i)a, (__m256i)b), (__m256i)c);
    return (Ints)_mm256_cmpeq_epi32(_mm256_min_epu32(greatest, _mm256_set1_epi32(0x3f7fffff)), greatest);
}
/// floor(2^31 a), for a in [0, 2^31): the first and the second four.
CISTULA_INLINE void whole_of(Floats a, Longs& low, Longs& high) {
    const __m256i upper = _mm256_cvttps_epi32(a);
    const __m256 rest = _mm256_sub_ps(a, _mm256_cvtepi32_ps(upper));
    const __m256i lower = _mm256_cvttps_epi32(_mm256_mul_ps(rest, _mm256_set1_ps(0x1p31f)));
    const __m256i first = _mm256_or_si256(lower, _mm256_slli_epi32(upper, 31));
    const __m256i second = _mm256_srli_epi32(upper, 1);
    const __m256i even = _mm256_unpacklo_epi32(first, second);
    const __m256i odd = _mm256_unpackhi_epi32(first, second);
    low = (Longs)_mm256_permute2x128_si256(even, odd, 0x20);
    high = (Longs)_mm256_permute2x128_si256(even, odd, 0x31);
}
/// The numbers of the highest bits of positive integers.
CISTULA_INLINE Ints highest_bits(Ints a) {
    const __m256i top = _mm256_andnot_si256(_mm256_srli_epi32((__m256i)a, 1), (__m256i)a);  // rounds to no higher one
    return (Ints)_mm256_sub_epi32(_mm256_srli_epi32((__m256i)_mm256_cvtepi32_ps(top), 23), _mm256_set1_epi32(127));
}
CISTULA_INLINE __m128 three_at(const float* from) {
    return _mm_movelh_ps(_mm_loadl_pi(_mm_setzero_ps(), reinterpret_cast<const __m64*>(from)), _mm_load_ss(from + 2));
}
/// Three numbers from each of these places.
CISTULA_INLINE void gather_three(const float* from, Ints places, Floats& x, Floats& y, Floats& z) {
    alignas(32) int32_t at[8];
    _mm256_store_si256(reinterpret_cast<__m256i*>(at), (__m256i)places);
    const auto two = [&](int i) {
        return _mm256_insertf128_ps(_mm256_castps128_ps256(three_at(from + uint32_t(at[i]))),
                                    three_at(from + uint32_t(at[i + 4])), 1);
    };
    const __m256 a = two(0);
    const __m256 b = two(1);
    const __m256 c = two(2);
    const __m256 d = two(3);
    const __m256 ab = _mm256_unpacklo_ps(a, b);
    const __m256 cd = _mm256_unpacklo_ps(c, d);
    x = _mm256_shuffle_ps(ab, cd, 0x44);
    y = _mm256_shuffle_ps(ab, cd, 0xee);
    z = _mm256_shuffle_ps(_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d), 0x44);
}
/// Entries of tables of so many bytes each that looked_up() takes.
template <int bytes>
inline constexpr uint32_t table_entries = 8;
CISTULA_INLINE Floats looked_up(const float* table, Ints index) {
    return _mm256_permutevar8x32_ps(_mm256_load_ps(table), (__m256i)index);
}
CISTULA_INLINE Ints looked_up(const int32_t* table, Ints index) {
    return (Ints)_mm256_permutevar8x32_epi32(_mm256_load_si256(reinterpret_cast<const __m256i*>(table)),
                                             (__m256i)index);
}
/// Entries of 64 bits, by pairs of words of the first and of the second four.
CISTULA_INLINE Doubles looked_up(const double* table, Longs index) {
    const __m256i first = _mm256_slli_epi64((__m256i)index, 1);
    const __m256i words = _mm256_or_si256(first, _mm256_slli_epi64(_mm256_add_epi64(first, _mm256_set1_epi64x(1)), 32));
    const auto four = [&](const double* from) {
        return (__m256d)_mm256_permutevar8x32_epi32(_mm256_load_si256(reinterpret_cast<const __m256i*>(from)), words);
    };
    return _mm256_blendv_pd(four(table), four(table + 4), (__m256d)_mm256_slli_epi64((__m256i)index, 61));
}
CISTULA_INLINE Longs looked_up(const int64_t* table, Longs index) {
    return (Longs)looked_up(reinterpret_cast<const double*>(table), index);
}
template <class Vector, class Mask>
CISTULA_INLINE Vector masked(Mask mask, Vector a) {
    return (Vector)((Mask)a & mask);
}
/// The sign bits of the lanes.
CISTULA_INLINE uint32_t bits(Ints mask) {
    return uint32_t(_mm256_movemask_ps((__m256)mask));
}
CISTULA_INLINE uint32_t bits(Longs mask) {
    return uint32_t(_mm256_movemask_pd((__m256d)mask));
}
CISTULA_INLINE Doubles low_half(Floats a) {
    return _mm256_cvtps_pd(_mm256_castps256_ps128(a));
}
CISTULA_INLINE Doubles high_half(Floats a) {
    return _mm256_cvtps_pd(_mm256_extractf128_ps(a, 1));
}
CISTULA_INLINE Floats joined(Doubles low, Doubles high) {
    return _mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low));
}
/// The halves of a mask as masks of lanes of twice the size, and back.
CISTULA_INLINE Longs low_half(Ints a) {
    return (Longs)_mm256_cvtepi32_epi64(_mm256_castsi256_si128((__m256i)a));
}
CISTULA_INLINE Longs high_half(Ints a) {
    return (Longs)_mm256_cvtepi32_epi64(_mm256_extracti128_si256((__m256i)a, 1));
}
CISTULA_INLINE Ints joined(Longs low, Longs high) {
    const __m256 even = _mm256_shuffle_ps((__m256)low, (__m256)high, 0x88);
    return (Ints)_mm256_permute4x64_epi64((__m256i)even, 0xd8);
}
/// Shifts by a number of bits a lane; 0 for more than 63, or below 0.
CISTULA_INLINE Longs shifted_left(Longs a, Longs by) {
    return (Longs)_mm256_sllv_epi64((__m256i)a, (__m256i)by);
}
CISTULA_INLINE Longs shifted_right(Longs a, Longs by) {
    return (Longs)_mm256_srlv_epi64((__m256i)a, (__m256i)by);
}

/// For each mask of eight (four) lanes, the numbers of the lanes that it has, first to last, in words of 32 bits.
struct LaneOrders {
    alignas(32) int32_t of_eight[256][8], of_four[16][8];
    constexpr LaneOrders() : of_eight(), of_four() {
        for (int mask = 0; mask < 256; ++mask)
            for (int lane = 0, n = 0; lane < 8; ++lane)
                if (mask >> lane & 1) of_eight[mask][n++] = lane;
        for (int mask = 0; mask < 16; ++mask) {
            int n = 0;
            for (int lane = 0; lane < 4; ++lane)
                if (mask >> lane & 1) of_four[mask][n++] = 2 * lane, of_four[mask][n++] = 2 * lane + 1;
            for (; n < 8; ++n) of_four[mask][n] = n % 2;  // copies of the first lane, as above
        }
    }
};
inline constexpr LaneOrders lane_orders;

CISTULA_INLINE __m256i order_of(const int32_t (&order)[8]) {
    return _mm256_load_si256(reinterpret_cast<const __m256i*>(order));
}
/// The lanes of the mask, moved to the front.
template <class Vector>
CISTULA_INLINE Vector packed(Vector a, uint32_t mask) {
    constexpr bool eight = sizeof(a[0]) == 4;
    const __m256i order = eight ? order_of(lane_orders.of_eight[mask]) : order_of(lane_orders.of_four[mask & 15]);
    return (Vector)_mm256_permutevar8x32_epi32((__m256i)a, order);
}

}  // namespace native

}  // namespace cistula
