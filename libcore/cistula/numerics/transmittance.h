// Transmittance along a straight path, kept as an integer sum of -log2: crossings may be added in any order and give
// the same bits. Zero transmittance has no logarithm; a material's `opaque` bits express it.
#pragma once

#include "cistula/numerics/elementary.h"

namespace cistula {

/// The largest loss, where sums saturate: about 4096 powers of two. A loss is -log2(transmittance) in Q11.52, an
/// integer count of 2^-52, with one bit to spare.
inline constexpr uint64_t largest_loss = ~uint64_t{0};

/// a + b, clamped to largest_loss; associative and commutative like exact addition.
CISTULA_INLINE uint64_t saturating_add(uint64_t a, uint64_t b) {
    const uint64_t sum = a + b;
    return sum < a ? largest_loss : sum;
}

/// Adds a loss to a sum, if `active`. (In lanes: lane_transmittance.h.)
CISTULA_INLINE void add_loss(bool active, uint64_t added, uint64_t& sum) {
    assign_where(active, sum, saturating_add(sum, added));
}

/// Converts a logarithm >= 0 to Q11.52, rounded to nearest with halves up. Values of 4096 and more, and NaN, saturate.
CISTULA_HD inline uint64_t loss_of_logarithm(DoubleDouble logarithm) {
    if (!(logarithm.high < 4096)) return largest_loss;
    const double high = logarithm.high * 0x1p52;
    const double whole = floor_of(high);
    const double rest = floor_of((high - whole) + (logarithm.low * 0x1p52 + 0.5));  // within 2^10, so nothing wraps
    return static_cast<uint64_t>(whole) + static_cast<uint64_t>(static_cast<int64_t>(rest));
}

/// -log2(share) for a share in (0, 1], subnormal included: exact at powers of two, 0 at 1, rounded to nearest
/// elsewhere.
CISTULA_HD inline uint64_t loss_of(double share) {
    const DoubleDouble log = elementary::log2_pair(share);
    return loss_of_logarithm({-log.high, -log.low});
}

/// 2^-loss. Exact at whole losses; 0 below the smallest normal Real. Monotonic: neighboring losses differ by at least
/// ln 2 ulps, and exp2_reduced errs by less than (1 + ln 2) / 2 ulps.
template <class Real>
CISTULA_HD inline Real transmittance_of(uint64_t loss) {
    constexpr uint64_t lowest = std::numeric_limits<Real>::max_exponent - 2;  // 126, 1022
    if (loss > lowest << 52) return 0;
    const uint64_t k = (loss + (uint64_t{1} << 51)) >> 52;
    const double r = static_cast<double>(static_cast<int64_t>((k << 52) - loss)) * 0x1p-52;
    return static_cast<Real>(elementary::exp2_reduced(r, 0) * elementary::power_of_two(-static_cast<int>(k)));
}

/// A loss and its transmittance 2^-loss, computed in advance.
template <class Real>
struct CachedTransmittance {
    uint64_t loss;
    Real transmittance;
};

/// The loss of the Beer-Lambert transmittance exp(-sigma_length), rounded to nearest. Negative arguments count as 0;
/// arguments from 4096 ln 2 = 2839.13 on, and NaN, saturate.
CISTULA_HD inline uint64_t absorption_loss(double sigma_length) {
    constexpr double log2_e_hi = 0x1.71547652b82fep+0;
    constexpr double log2_e_lo = 0x1.777d0ffda0d24p-56;
    if (sigma_length <= 0) return 0;
    const DoubleDouble product = two_product(sigma_length, log2_e_hi);
    return loss_of_logarithm(fast_two_sum(product.high, fused(sigma_length, log2_e_lo, product.low)));
}

/// sigma t rounded to the nearest 2^-32 (halves up) in Q31.32, modulo 2^32; what is not finite gives -2^31.
CISTULA_INLINE int64_t absorption_fixed(double sigma_t) {
    const double wrapped = sigma_t - floor_of(sigma_t * 0x1p-32 + 0.5) * 0x1p32;
    return static_cast<int64_t>(floor_of(clamped(wrapped, -0x1p31, 0x1p31 - 0x1p-20) * 0x1p32 + 0.5));
}

/// Optical depth of closed meshes along a path, for one channel: sigma t is added where a ray leaves a mesh and
/// subtracted where it enters. Terms and partial sums may wrap around; the whole sum, which is a sum of sigma times
/// lengths inside, is correct below 2^31: a solid of the size d has sigma d <= 2^20.
struct PathSum {
    uint64_t sum = 0;  // Q31.32, two's complement

    /// Adds (sign +1) or subtracts (sign -1) sigma times a length, for example the distance from a crossing to the end
    /// of the path. The length is clamped to [0, farthest], with farthest = 4 M.
    CISTULA_INLINE void add(int sign, double sigma, double length, double farthest) {
        const uint64_t term = static_cast<uint64_t>(absorption_fixed(sigma * clamped(length, 0.0, farthest)));
        sum += sign < 0 ? 0 - term : term;
    }

    /// The loss of the whole path. A sum below 0, which only rounding can produce for a closed mesh, counts as 0.
    CISTULA_HD inline uint64_t loss() const {
        const int64_t absorbed = static_cast<int64_t>(sum);
        return absorption_loss(static_cast<double>(absorbed) * 0x1p-32);  // exact below 2^21, and saturated long before
    }
};

}  // namespace cistula
