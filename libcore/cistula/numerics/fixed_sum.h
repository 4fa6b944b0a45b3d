// Radiance sums as integers: integer addition is associative, so threads, tiles and GPUs agree on every bit in any
// order. Contributions are rounded down, so the parts of a branch never add up to more than its rounded-down bound, and
// 0 <= reference - image <= ledger holds in integers for any weights.
#pragma once

#include "cistula/numerics/elementary.h"

namespace cistula {

/// The number of fraction bits of a pixel's sums: 62 - ceil(log2(samples)). Samples of at most 1 each then add up to at
/// most 2^62.
CISTULA_INLINE int fixed_shift(uint32_t samples) {
    int bits = 0;
    while (uint64_t{1} << bits < samples) ++bits;
    return 62 - bits;
}

/// 2^shift, the scale that to_fixed takes.
CISTULA_INLINE double fixed_scale(int shift) {
    return elementary::power_of_two(shift);
}

/// Sets out = floor(x * scale), exactly, for x in [0, 1]. Any other x, NaN included, gives false and leaves out
/// unchanged. Radiances are scaled so that their bound is at most 1: a larger one is an error like an infinite one.
template <class Real, class Scale>
CISTULA_INLINE bool to_fixed(Real x, Scale scale, int64_t& out) {
    const Real value = x * static_cast<Real>(scale);  // exact, scale being a power of two
    if (!(x >= 0 && x <= 1)) return false;
    out = whole_of(value);
    return true;
}

/// Sets out = ceil(x * scale), exactly, for x in [0, 1]; used for the ledger. Any other x, NaN included, gives false
/// and leaves out unchanged.
template <class Real, class Scale>
CISTULA_INLINE bool to_fixed_up(Real x, Scale scale, int64_t& out) {
    const Real value = x * static_cast<Real>(scale);
    if (!(x >= 0 && x <= 1)) return false;
    out = whole_above(value);
    return true;
}

/// sum / samples, rounded to nearest, halves to even; for sum >= 0 and samples > 0.
CISTULA_INLINE int64_t mean_of(int64_t sum, uint32_t samples) {
    const int64_t whole = sum / samples;
    const int64_t twice = 2 * (sum % samples);
    return whole + (twice > samples || (twice == samples && (whole & 1)) ? 1 : 0);
}

/// mean / 2^shift * 2^radiance_exponent, rounded once. Overflow gives infinity; a subnormal result is rounded a second
/// time. |radiance_exponent| <= 1900.
template <class Real>
CISTULA_INLINE Real resolve_mean(int64_t mean, int shift, int radiance_exponent) {
    const Real rounded = static_cast<Real>(mean);
    const double value = elementary::scaled(static_cast<double>(rounded), radiance_exponent - shift);
    if (!(value <= static_cast<double>(RealTraits<Real>::largest))) return RealTraits<Real>::infinity;
    return static_cast<Real>(value);
}

/// The pixel's radiance in the scene's units: the mean of the sum of its samples.
template <class Real>
CISTULA_INLINE Real resolve(int64_t sum, int shift, uint32_t samples, int radiance_exponent) {
    return resolve_mean<Real>(mean_of(sum, samples), shift, radiance_exponent);
}

}  // namespace cistula
