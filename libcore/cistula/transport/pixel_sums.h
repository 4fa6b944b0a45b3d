// Accumulation of samples in a pixel: radiance and what truncation removed, as integers (docs/rules.md, 7 and 8).
#pragma once

#include "cistula/model/layers.h"
#include "cistula/numerics/fixed_sum.h"
#include "cistula/numerics/vec.h"
#include "cistula/transport/tree_threshold.h"

namespace cistula {

/// The bits of a number as an integer. For numbers in [0, 1] integers have the same order; all others (-0 and NaN
/// included) give greater integers.
CISTULA_INLINE uint32_t word_of(float a) {
    return bits_as<uint32_t>(a);
}
CISTULA_INLINE uint64_t word_of(double a) {
    return bits_as<uint64_t>(a);
}
template <class Real>
CISTULA_INLINE auto greatest_word(const Vec3<Real>& a) {
    return max_or_second(word_of(a.x), max_or_second(word_of(a.y), word_of(a.z)));
}

/// Replaces a value that is not in [0, scale] by 0, without a branch, and tells whether it did. Such a value is an
/// error; other channels are not affected. `scale` is settings.fixed_scale.
template <class Real>
CISTULA_INLINE bool clear_fault(Real& units, Real scale) {
    const bool is_fault = word_of(units) > word_of(scale);
    units = is_fault ? Real(0) : units;
    return is_fault;
}

/// What a tree may lose to truncation: nothing but branches of one unit of the sums at most.
template <class Real, bool limited>
class TreeLimit {
  public:
    CISTULA_INLINE explicit TreeLimit(const TreeSettings& settings) : settings_(settings) {}

    CISTULA_INLINE Real threshold() const { return Real(settings_.fixed_unit); }
    CISTULA_INLINE void spend(int64_t) {}

  private:
    const TreeSettings& settings_;
};
/// A threshold for branches, a share of the radiance bound, and what is left of the tree's budget; below 0: it has lost
/// too much.
template <class Real>
class TreeLimit<Real, true> {
  public:
    CISTULA_INLINE explicit TreeLimit(const TreeSettings& settings)
        : threshold_(settings.fixed_unit), left_(endless_budget) {}
    CISTULA_INLINE TreeLimit(float threshold, int64_t left) : threshold_(threshold), left_(left) {}

    CISTULA_INLINE Real threshold() const { return threshold_; }
    CISTULA_INLINE int64_t left() const { return left_; }
    CISTULA_INLINE void spend(int64_t units) {
        if (left_ != endless_budget) left_ -= units;
    }

  private:
    const Real threshold_;
    int64_t left_;
};

/// Sums of one sample. Weights are a share per channel, or one for all. `limited`: of frames with a cutoff or a target
/// error.
template <class Real, bool limited = false>
class PixelSums {
  public:
    template <class Scene>
    CISTULA_INLINE PixelSums(const TreeSettings& settings, const Scene& scene, PixelRecord& record, uint32_t& flags)
        : PixelSums(settings, scene, record, flags, TreeLimit<Real, limited>(settings)) {}
    template <class Scene>
    CISTULA_INLINE PixelSums(const TreeSettings& settings, const Scene& scene, PixelRecord& record, uint32_t& flags,
                             const TreeLimit<Real, limited>& limit)
        : settings_(settings),
          bound_(scene.bound),
          largest_bound_(scene.largest_bound),
          record_(record),
          flags_(flags),
          limit_(limit) {}

    CISTULA_INLINE void add(const Vec3<Real>& radiance, LightSource = LightSource::background, bool = true) {
        const Vec3<Real> units = in_units(radiance, Real(settings_.fixed_scale), flags_);
        for (int c = 0; c < 3; ++c) record_.radiance[c] += whole_of(units[c]);
    }
    /// Adds what a point light sends. The light's number and the diffuse part matter to LayeredSums alone.
    template <class Diffuse>
    CISTULA_INLINE void add_light(const Vec3<Real>& radiance, uint32_t, const Diffuse&, bool = true) {
        add(radiance);
    }

    /// Whether to follow a branch with this throughput; if its bound is no greater than the threshold, it is not, and
    /// the bound is added to the ledger.
    template <class Throughput>
    CISTULA_INLINE bool afford(const Throughput& weight) {
        if (clearly_counts(weight)) return true;
        int64_t most[3];
        const int64_t worst = most_of(bounded(weight), Real(settings_.fixed_scale), flags_, most);
        if (worst > whole_of(limit_.threshold() * Real(settings_.fixed_scale))) return true;
        for (int c = 0; c < 3; ++c) record_.pruned[c] += most[c];
        limit_.spend(worst);
        return false;
    }
    /// What is left of a limited tree's budget.
    CISTULA_INLINE int64_t left() const { return limit_.left(); }

    /// Adds the bound of a branch beyond the depth limit to the ledger.
    template <class Throughput>
    CISTULA_INLINE void cut(const Throughput& weight) {
        int64_t most[3];
        most_of(bounded(weight), Real(settings_.fixed_scale), flags_, most);
        for (int c = 0; c < 3; ++c) record_.cut[c] += most[c];
    }

    CISTULA_INLINE void flag(uint32_t bits) { flags_ |= bits; }

  protected:
    /// A radiance in units of the sums.
    CISTULA_INLINE void units_of(const Vec3<Real>& radiance, int64_t (&to)[3]) {
        const Vec3<Real> units = in_units(radiance, Real(settings_.fixed_scale), flags_);
        for (int c = 0; c < 3; ++c) to[c] = whole_of(units[c]);
    }
    /// Adds a radiance, and tells how many units that is.
    CISTULA_INLINE void add_units(const Vec3<Real>& radiance, int64_t (&added)[3]) {
        units_of(radiance, added);
        for (int c = 0; c < 3; ++c) record_.radiance[c] += added[c];
    }

  private:
    /// Whether the branch could add more than the threshold. False for values that are not finite or exceed the
    /// bound, which most_of handles.
    CISTULA_INLINE bool clearly_counts(const Vec3<Real>& weight) const {
        return counts(greatest_word(weight * bound_));
    }
    CISTULA_INLINE bool clearly_counts(Real weight) const { return counts(word_of(weight * largest_bound_)); }

    template <class Word>
    CISTULA_INLINE bool counts(Word most) const {
        return most <= word_of(Real(1)) && most > word_of(limit_.threshold());
    }

    /// The bound on what a branch can add. The slack of 2^-10 in B covers the rounding of all weights below it.
    template <class Throughput>
    CISTULA_INLINE Vec3<Real> bounded(const Throughput& weight) const {
        return {channel(weight, 0) * bound_[0], channel(weight, 1) * bound_[1], channel(weight, 2) * bound_[2]};
    }

    /// Writes the bounds per channel in units of the sums, rounded up, to `most`, and returns the greatest.
    CISTULA_INLINE static int64_t most_of(const Vec3<Real>& bounded, Real scale, uint32_t& flags, int64_t (&most)[3]) {
        const Vec3<Real> units = in_units(bounded, scale, flags);
        int64_t worst = 0;
        for (int c = 0; c < 3; ++c) {
            most[c] = whole_above(units[c]);
            worst = most[c] > worst ? most[c] : worst;
        }
        return worst;
    }

    /// The radiance in units of the sums, exactly; channels outside [0, 1] become 0 and set flag_not_finite.
    CISTULA_INLINE static Vec3<Real> in_units(const Vec3<Real>& a, Real scale, uint32_t& flags) {
        const Real zero = Real(0);
        Vec3<Real> units(fused(a.x, scale, zero), fused(a.y, scale, zero), fused(a.z, scale, zero));  // turns -0 into 0
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
    TreeLimit<Real, limited> limit_;
};

}  // namespace cistula
