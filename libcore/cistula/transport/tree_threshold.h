// How a frame's cutoff is kept: branches that could add no more than a threshold are dropped, and a tree that thereby
// loses more than its budget is traced again with a smaller threshold (docs/rules.md, 7). A threshold is a property of
// the whole tree, so no order of branches changes what is dropped.
#pragma once

#include "cistula/numerics/real.h"
#include "cistula/transport/pixel_sums.h"

namespace cistula {

/// The threshold of a sample's tree: a share of the radiance bound, a power of two of at least one unit of the sums.
struct TreeThreshold {
    float share;
    bool has_grown = false;  // the tree was too large; what is dropped may then exceed the budget

    /// The first threshold for a budget in units of the sums.
    CISTULA_INLINE static float first(int64_t budget, float unit) {
        const float most = float(max_or_second(budget / 8, int64_t(1)));
        return unit * bits_as<float>(bits_as<uint32_t>(most) & 0x7f800000u);
    }

    /// Whether a tree holds that dropped so much in each channel. If not, sets the threshold for the next try.
    CISTULA_INLINE bool holds(const TreeSettings& settings, const int64_t (&dropped)[3]) {
        const int64_t most = max_or_second(dropped[0], max_or_second(dropped[1], dropped[2]));
        if (has_grown || share == settings.fixed_unit || most <= settings.budget) return true;
        share = max_or_second(share / 8, settings.fixed_unit);
        return false;
    }
    /// Sets the threshold for the next try of a tree that is too large.
    CISTULA_INLINE void grow() {
        share *= 4;
        has_grown = true;
    }
};

}  // namespace cistula
