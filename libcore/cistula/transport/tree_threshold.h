// How a frame's cutoff is kept: branches that could add no more than a threshold are dropped, and a tree that thereby
// loses more than its budget is given up and traced again with a smaller threshold (docs/rules.md, 7). A threshold is a
// property of the whole tree, so no order of branches changes what is dropped.
#pragma once

#include "cistula/numerics/real.h"

namespace cistula {

/// A frame's settings for every ray tree.
struct TreeSettings {
    int depth = 4;          // maximum number of surfaces shaded along a path
    float fixed_scale = 1;  // 2^s of the sums (docs/rules.md, 8), exact in either Real
    float fixed_unit = 1;   // 2^-s
    int64_t budget = 0;     // truncation allowed per sample, in units of the sums; 0: no cutoff
    float threshold = 1;    // the first of a sample (TreeThreshold)
};

/// What is left of a budget that has no end.
inline constexpr int64_t endless_budget = std::numeric_limits<int64_t>::max();

/// The threshold of a sample's tree, a share of the radiance bound and a power of two. A tree that loses too much gets
/// an eighth of it, one that is too large eight times as much. Since both go the same steps, a tree that is both ends
/// with the same threshold whichever is found first.
struct TreeThreshold {
    float share;
    bool has_grown = false;  // the tree was too large; what is dropped may then exceed the budget

    /// The first threshold for a budget in units of the sums.
    CISTULA_INLINE static float first(int64_t budget, float unit) {
        const float most = float(max_or_second(budget / 8, int64_t(1)));
        return unit * bits_as<float>(bits_as<uint32_t>(most) & 0x7f800000u);
    }

    /// The threshold of branches: one unit of the sums at least.
    CISTULA_INLINE float of_branches(const TreeSettings& settings) const {
        return max_or_second(share, settings.fixed_unit);
    }
    /// What the tree may lose.
    CISTULA_INLINE int64_t left(const TreeSettings& settings) const {
        return has_grown || share <= settings.fixed_unit ? endless_budget : settings.budget;
    }
    CISTULA_INLINE void shrink() { share /= 8; }
    CISTULA_INLINE void grow() {
        share *= 8;
        has_grown = true;
    }
};

}  // namespace cistula
