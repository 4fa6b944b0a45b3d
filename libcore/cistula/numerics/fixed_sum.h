// Sums of radiance as integers: addition is then associative, and threads, tiles and several GPUs agree on every bit.
// Contributions are truncated: the parts of a branch then never add up to more than its truncated bound, so that
// 0 <= reference - image <= ledger holds in integers, however small the weights are.
#pragma once

#include "cistula/numerics/elementary.h"

namespace cistula {

/// The fraction bits of a pixel's sums: 62 - ceil(log2(samples)). Samples of at most 1 each then add up to 2^62 at
/// most.
CISTULA_INLINE int fixed_shift(uint32_t samples) {
    int bits = 0;
    while (uint64_t{1} << bits < samples) ++bits;
    return 62 - bits;
}

/// 2^shift, which to_fixed wants ready made.
CISTULA_INLINE double fixed_scale(int shift) {
    return elementary::power_of_two(shift);
}

/// out = floor(x * scale), exactly, for x in [0, 1]; anything else (NaN too) gives false and leaves out alone.
/// Radiances are scaled to a bound of at most 1, so that a larger one is as much a fault as an infinite one.
template <class Real, class Scale>
CISTULA_INLINE bool to_fixed(Real x, Scale scale, int64_t& out) {
    const Real value = x * static_cast<Real>(scale);  // exact, scale being a power of two
    if (!(x >= 0 && x <= 1)) return false;
    out = whole_of(value);
    return true;
}

/// out = ceil(x * scale), exactly, for x in [0, 1]; anything else (NaN too) gives false and leaves out alone. For the
/// ledger.
template <class Real, class Scale>
CISTULA_INLINE bool to_fixed_up(Real x, Scale scale, int64_t& out) {
    const Real value = x * static_cast<Real>(scale);
    if (!(x >= 0 && x <= 1)) return false;
    out = whole_above(value);
    return true;
}

/// sum / samples, to nearest, halves to even. Sum >= 0, samples > 0.
CISTULA_INLINE int64_t mean_of(int64_t sum, uint32_t samples) {
    const int64_t whole = sum / samples, twice = 2 * (sum % samples);
    return whole + (twice > samples || (twice == samples && (whole & 1)) ? 1 : 0);
}

/// mean / 2^shift * 2^radiance_exponent, rounded once. Beyond the largest Real infinity; below the smallest normal one
/// rounded a second time. |radiance_exponent| <= 1900.
template <class Real>
CISTULA_INLINE Real resolve_mean(int64_t mean, int shift, int radiance_exponent) {
    const Real rounded = static_cast<Real>(mean);
    const double value = elementary::scaled(static_cast<double>(rounded), radiance_exponent - shift);
    if (!(value <= static_cast<double>(RealTraits<Real>::largest))) return RealTraits<Real>::infinity;
    return static_cast<Real>(value);
}

/// What a pixel shows: the mean of its samples' sum, in the scene's own units.
template <class Real>
CISTULA_INLINE Real resolve(int64_t sum, int shift, uint32_t samples, int radiance_exponent) {
    return resolve_mean<Real>(mean_of(sum, samples), shift, radiance_exponent);
}

}  // namespace cistula
