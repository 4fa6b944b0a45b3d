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
