// A sample's way into its pixel: radiance and what truncation took away, in integers (docs/rules.md, 7 and 8).
#pragma once

#include "cistula/model/pixel_record.h"
#include "cistula/numerics/fixed_sum.h"
#include "cistula/numerics/vec.h"

namespace cistula {

/// What a frame asks of every ray tree.
struct TreeSettings {
    int depth = 4;          // surfaces shaded along a path, the first included
    float fixed_scale = 1;  // 2^s of the sums, a power of two that every Real has
    float fixed_unit = 1;   // 2^-s
    int64_t budget = 0;     // truncation allowed per sample, in units of the sums
};

/// The bits of a number as an integer. Numbers in [0, 1] are in its order, and all others (-0, NaN) are above them.
CISTULA_INLINE uint32_t word_of(float a) {
    return bits_as<uint32_t>(a);
}
CISTULA_INLINE uint64_t word_of(double a) {
    return bits_as<uint64_t>(a);
}
template <class Real>
CISTULA_INLINE auto greatest_word(const Vec3<Real>& a) {
    return greatest(word_of(a.x), greatest(word_of(a.y), word_of(a.z)));
}

/// A radiance in units of the sums that is not in [0, 1] is a fault, and counts as 0, without a jump: no other channel
/// is touched by it. `scale` is settings.fixed_scale.
template <class Real>
CISTULA_INLINE bool clear_fault(Real& units, Real scale) {
    const bool is_fault = word_of(units) > word_of(scale);
    units = is_fault ? Real(0) : units;
    return is_fault;
}

template <class Real>
class PixelSums {
  public:
    /// For one sample. Weights have a share per color, or one for all.
    template <class Scene>
    CISTULA_INLINE PixelSums(const TreeSettings& settings, const Scene& scene, PixelRecord& record, uint32_t& flags)
        : settings_(settings),
          bound_(scene.bound),
          largest_bound_(scene.largest_bound),
          record_(record),
          flags_(flags),
          left_(settings.budget) {}

    CISTULA_INLINE void add(const Vec3<Real>& radiance) {
        const Vec3<Real> units = in_units(radiance, Real(settings_.fixed_scale), flags_);
        for (int c = 0; c < 3; ++c) record_.radiance[c] += whole_of(units[c]);
    }

    /// Whether to follow a branch of this weight; if not, the ledger has it. Not followed is what fits in a tenth of
    /// the budget that is left, and what could add one unit of the sums at most.
    template <class Share>
    CISTULA_INLINE bool afford(const Share& weight) {
        if (left_ == 0 && clearly_counts(weight)) return true;
        int64_t most[3];
        const int64_t worst = most_of(bounded(weight), Real(settings_.fixed_scale), flags_, most);
        if (worst > 1 && worst > left_ / 10) return true;
        for (int c = 0; c < 3; ++c) record_.pruned[c] += most[c];
        left_ = worst < left_ ? left_ - worst : 0;
        return false;
    }

    /// A branch beyond the depth.
    template <class Share>
    CISTULA_INLINE void cut(const Share& weight) {
        int64_t most[3];
        most_of(bounded(weight), Real(settings_.fixed_scale), flags_, most);
        for (int c = 0; c < 3; ++c) record_.cut[c] += most[c];
    }

    CISTULA_INLINE void flag(uint32_t bits) { flags_ |= bits; }

  private:
    /// Whether the branch could add more than one unit of the sums; what is not finite or beyond the bound is left to
    /// most_of.
    CISTULA_INLINE bool clearly_counts(const Vec3<Real>& weight) const {
        return counts(greatest_word(weight * bound_));
    }
    CISTULA_INLINE bool clearly_counts(Real weight) const { return counts(word_of(weight * largest_bound_)); }

    template <class Word>
    CISTULA_INLINE bool counts(Word most) const {
        return most <= word_of(Real(1)) && most > word_of(Real(settings_.fixed_unit));
    }

    /// The most a branch can add; B's slack of 2^-10 covers the rounding of all weights below it.
    template <class Share>
    CISTULA_INLINE Vec3<Real> bounded(const Share& weight) const {
        return {channel(weight, 0) * bound_[0], channel(weight, 1) * bound_[1], channel(weight, 2) * bound_[2]};
    }

    /// The bounds by channel in units of the sums, rounded up, as `most`; gives the greatest.
    CISTULA_INLINE static int64_t most_of(const Vec3<Real>& bounded, Real scale, uint32_t& flags, int64_t (&most)[3]) {
        const Vec3<Real> units = in_units(bounded, scale, flags);
        int64_t worst = 0;
        for (int c = 0; c < 3; ++c) {
            most[c] = whole_above(units[c]);
            worst = most[c] > worst ? most[c] : worst;
        }
        return worst;
    }

    /// Exact.
    CISTULA_INLINE static Vec3<Real> in_units(const Vec3<Real>& a, Real scale, uint32_t& flags) {
        const Real zero = Real(0);
        Vec3<Real> units(fused(a.x, scale, zero), fused(a.y, scale, zero), fused(a.z, scale, zero));  // makes 0 of -0
        bool has_fault = false;
        for (int c = 0; c < 3; ++c) has_fault |= clear_fault(units[c], scale);
        if (has_fault) flags |= flag_not_finite;
        return units;
    }

    const TreeSettings& settings_;
    const Vec3<Real>& bound_;  // the scene's radiance bound B
    const Real& largest_bound_;
    PixelRecord& record_;
    uint32_t& flags_;
    int64_t left_;
};

}  // namespace cistula
