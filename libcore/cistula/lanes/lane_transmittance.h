// Losses and transmittances in lanes: numerics/transmittance.h, with the same bits.
#pragma once

#include "cistula/lanes/lanes.h"
#include "cistula/numerics/transmittance.h"

namespace cistula {

/// Where sums of losses saturate in lanes, which let nothing through from 1022 powers of two on: the sum of two such
/// fits a signed integer.
inline constexpr uint64_t loss_of_all = (uint64_t{1} << 62) - 1;

/// Adds losses up to loss_of_all where the mask holds.
template <int n>
CISTULA_INLINE void add_loss(const LaneMask<8, n>& active, const Lanes<int64_t, n>& added, Lanes<int64_t, n>& sum) {
    const Lanes<int64_t, n> all(int64_t{loss_of_all}), more = sum + masked(active, added);
    sum = select(more < all, more, all);
}
template <int n>
CISTULA_INLINE void add_loss(const LaneMask<8, n>& active, uint64_t added, Lanes<int64_t, n>& sum) {
    if (added != 0) add_loss(active, Lanes<int64_t, n>(int64_t(min_or_second(added, loss_of_all))), sum);
}

/// absorption_loss(), up to loss_of_all.
template <int n>
CISTULA_INLINE Lanes<int64_t, n> absorption_loss(const Lanes<double, n>& sigma_length) {
    using Wide = Lanes<double, n>;
    using Loss = Lanes<int64_t, n>;
    constexpr double log2_e_hi = 0x1.71547652b82fep+0;
    constexpr double log2_e_lo = 0x1.777d0ffda0d24p-56;
    const DoubleDoubleOf<Wide> product = two_product(sigma_length, Wide(log2_e_hi));
    const DoubleDoubleOf<Wide> log = fast_two_sum(product.high, fused(sigma_length, Wide(log2_e_lo), product.low));
    const auto none = sigma_length <= Wide(0.0);
    const auto part = log.high < Wide(1024.0);
    const Wide high = select(part, log.high, Wide(0.0)) * Wide(0x1p52);
    const Wide whole = floor_of(high);
    const Wide rest = floor_of((high - whole) + (select(part, log.low, Wide(0.0)) * Wide(0x1p52) + Wide(0.5)));
    const Loss loss = select(part, integers_of<false>(whole) + whole_of(rest), Loss(int64_t{loss_of_all}));
    return select(none, Loss(int64_t{0}), loss);
}

/// 2^-k for k in [0, 1022].
template <int n>
CISTULA_INLINE Lanes<double, n> power_of_minus(const Lanes<int64_t, n>& k) {
    if constexpr (is_pair<double, n>)
        return {power_of_minus(k.low), power_of_minus(k.high)};
    else
        return Lanes<double, n>((typename Lanes<double, n>::Vector)((1023 - k.v) << 52));
}

/// transmittance_of(), for losses up to loss_of_all.
template <class T, int n>
CISTULA_INLINE Lanes<T, n> uncached_transmittance(const Lanes<int64_t, n>& loss) {
    using Wide = Lanes<double, n>;
    using Loss = Lanes<int64_t, n>;
    constexpr int64_t lowest = int64_t(std::numeric_limits<T>::max_exponent - 2) << 52;
    const auto dark = loss > Loss(lowest);
    const Loss lit = select(dark, Loss(int64_t{0}), loss);
    const Loss k = (lit + Loss(int64_t{1} << 51)) >> 52;
    const Wide r = double_of((k << 52) - lit) * Wide(0x1p-52);
    return Lanes<T, n>(select(dark, Wide(0.0), elementary::exp2_reduced(r, Wide(0.0)) * power_of_minus(k)));
}

}  // namespace cistula
