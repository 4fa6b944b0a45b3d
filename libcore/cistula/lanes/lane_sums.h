// Sums of the pixels of a tile, to which lanes add: integers, so that the order of rays leaves no trace.
#pragma once

#include "cistula/lanes/lane_pixel.h"
#include "cistula/lanes/lanes.h"
#include "cistula/transport/layered_sums.h"

namespace cistula {

/// floor(a), or ceil(a), as integers, for a in [0, 2^63).
template <bool above, int n>
CISTULA_INLINE Lanes<int64_t, n> integers_of(const Lanes<double, n>& a) {
    if constexpr (is_pair<double, n>) {
        return {integers_of<above>(a.low), integers_of<above>(a.high)};
    } else {
        const native::Longs bits = (native::Longs)a.v;
        // The significand, shifted by the exponent; shifts by 64 and more give 0.
        const native::Longs exponent = bits >> 52;
        const native::Longs whole = (bits & ((int64_t(1) << 52) - 1)) | int64_t(1) << 52;
        const native::Longs left = exponent - 1075;
        const native::Longs right = 1075 - exponent;
        const native::Longs floor = native::shifted_left(whole, left) | native::shifted_right(whole, right);
        if constexpr (!above) return Lanes<int64_t, n>(floor);
        using Integers = Lanes<int64_t, n>;
        const auto lost = (Integers(right) > Integers(int64_t(0))) &
                          (Integers(native::shifted_left(floor, right)) != Integers(whole)) &
                          (a > Lanes<double, n>(0.0));
        return Integers(floor) - minus_one_where(lost);
    }
}

/// The sums of a pixel's radiance, and its rays.
struct alignas(32) SumRow {
    int64_t of[4];
};
/// Adds numbers of four lanes to the rows of these lanes.
template <class Index>
CISTULA_INLINE void add_to_rows(SumRow* rows, const Index* numbers, __m256i a, __m256i b, __m256i c, __m256i d) {
    const __m256i ab_even = _mm256_unpacklo_epi64(a, b);
    const __m256i ab_odd = _mm256_unpackhi_epi64(a, b);
    const __m256i cd_even = _mm256_unpacklo_epi64(c, d);
    const __m256i cd_odd = _mm256_unpackhi_epi64(c, d);
    const __m256i of[4] = {
        _mm256_permute2x128_si256(ab_even, cd_even, 0x20), _mm256_permute2x128_si256(ab_odd, cd_odd, 0x20),
        _mm256_permute2x128_si256(ab_even, cd_even, 0x31), _mm256_permute2x128_si256(ab_odd, cd_odd, 0x31)};
    for (int i = 0; i < 4; ++i) {
        auto* row = reinterpret_cast<__m256i*>(&rows[uint32_t(numbers[i])]);
        _mm256_store_si256(row, _mm256_add_epi64(_mm256_load_si256(row), of[i]));
    }
}

template <class Real>
class LaneSums {
  public:
    using T = ScalarOf<Real>;
    using Mask = MaskOf<Real>;
    static constexpr int lanes = LaneTraits<Real>::lanes;

    template <class Scene>
    LaneSums(const TreeSettings& settings, const Scene& scene, LanePixel* pixels, uint32_t& flags)
        : pixels_(pixels), settings_(settings), bounds_{scene.bound, scene.largest_bound}, flags_(flags) {}

    /// Begins with these branches, and ends with them.
    template <class Branch>
    CISTULA_INLINE void begin(const Branch& branch) {
        pixel_ = branch.pixel & IndexOf<Real>(Branch::by_mirror - 1);
        rays_ = 0;
        cuts_ = false;
        for (int c = 0; c < 3; ++c) radiance_[c] = int64_t(0);
    }
    /// Sums of all pixels are to be added to these rows.
    void collect(SumRow* rows) { rows_ = rows; }
    CISTULA_INLINE void end(const Mask&) {
        alignas(lane_bytes) int64_t whole[3][lanes];
        for (int c = 0; c < 3; ++c) memcpy(whole[c], &radiance_[c], sizeof radiance_[c]);
        const LaneArray<IndexOf<Real>> numbers(pixel_), counts(rays_);
        for (int lane = 0; lane < lanes; lane += 4) {
            const auto four = [&](int c) {
                return _mm256_load_si256(reinterpret_cast<const __m256i*>(&whole[c][lane]));
            };
            __m256i rays;
            if constexpr (sizeof counts.of[0] == 4)
                rays = _mm256_cvtepi32_epi64(_mm_load_si128(reinterpret_cast<const __m128i*>(&counts.of[lane])));
            else
                rays = _mm256_load_si256(reinterpret_cast<const __m256i*>(&counts.of[lane]));
            add_to_rows(rows_, &numbers.of[lane], four(0), four(1), four(2), rays);
        }
        if (any(cuts_)) give(cut_, cuts_, &PixelRecord::cut);
    }

    CISTULA_INLINE void add(const Vec3<Real>& radiance, LightSource, const Mask& active) {
        Integers added[3];
        add_units(radiance, active, added);
    }
    /// Adds what is at the end of branches. Which of them meet visible lights matters to LayeredLaneSums alone.
    CISTULA_INLINE void add_end(const Vec3<Real>& radiance, const Mask&, const Mask& active) {
        add(radiance, LightSource::background, active);
    }
    template <class Diffuse>
    CISTULA_INLINE void add_light(const Vec3<Real>& radiance, uint32_t, const Diffuse&, const Mask& active) {
        add(radiance, LightSource::background, active);
    }

    /// The branches to follow; the bounds of others are added to the ledger (PixelSums::afford).
    template <class Weight>
    CISTULA_INLINE Mask afford(const Weight& weight, const Mask& active) {
        const Real most = largest_component(bounded(weight));
        const Mask counts = (most <= Real(1)) & (most > thresholds_of(active));
        Mask followed = active & counts;
        for_each_lane(active & !counts, [&](int lane) {
            LanePixel& pixel = pixels_[pixel_[lane]];
            const TreeLimit<T, true> limit(pixel.threshold.of_branches(settings_), pixel.left);
            PixelSums<T, true> sums(settings_, bounds_, *pixel.record, flags_, limit);
            if (sums.afford(lane_of(weight, lane))) followed |= Mask::of_bits(1u << lane);
            pixel.left = sums.left();
        });
        return followed;
    }

    template <class Weight>
    CISTULA_INLINE void cut(const Weight& weight, const Mask& active) {
        const Vec3<Real> units = in_units(bounded(weight), active);
        if (!any(cuts_))
            for (int c = 0; c < 3; ++c) cut_[c] = int64_t(0);
        for (int c = 0; c < 3; ++c) cut_[c] += integers_of<true>(Lanes<double, lanes>(units[c]));
        cuts_ |= active;
    }

    CISTULA_INLINE void flag(uint32_t bits) { flags_ |= bits; }

    /// The rays that were counted since begin().
    CISTULA_INLINE const IndexOf<Real>& rays() const { return rays_; }
    /// Counts rays.
    CISTULA_INLINE void count(const Mask& active) { rays_ -= minus_one_where(active); }

  protected:
    using Integers = Lanes<int64_t, lanes>;

    /// A radiance in units of the sums; 0 in other lanes.
    CISTULA_INLINE void units_of(const Vec3<Real>& radiance, const Mask& active, Integers (&to)[3]) {
        if constexpr (sizeof(T) == 4) {
            const Mask usual = native::are_below_one(radiance.x.v, radiance.y.v, radiance.z.v);
            if (!any(active & !usual)) {
                const Real scale(T(settings_.fixed_scale) * T(0x1p-31));
                for (int c = 0; c < 3; ++c)
                    native::whole_of(masked(active, radiance[c] * scale).v, to[c].low.v, to[c].high.v);
                return;
            }
        }
        const Vec3<Real> units = in_units(radiance, active);
        for (int c = 0; c < 3; ++c) to[c] = integers_of<false>(Lanes<double, lanes>(units[c]));
    }
    /// Adds a radiance, and tells how many units that is.
    CISTULA_INLINE void add_units(const Vec3<Real>& radiance, const Mask& active, Integers (&added)[3]) {
        units_of(radiance, active, added);
        for (int c = 0; c < 3; ++c) radiance_[c] += added[c];
    }

    LanePixel* const pixels_;
    SumRow* rows_ = nullptr;
    IndexOf<Real> pixel_ = 0;
    Integers radiance_[3];

  private:
    /// The part of a scene that PixelSums reads.
    struct Bounds {
        const Vec3<T>& bound;
        const T& largest_bound;
    };

    template <class Weight>
    CISTULA_INLINE Vec3<Real> bounded(const Weight& weight) const {
        return {channel(weight, 0) * bounds_.bound.x, channel(weight, 1) * bounds_.bound.y,
                channel(weight, 2) * bounds_.bound.z};
    }

    /// The thresholds of samples (tree_threshold.h).
    CISTULA_INLINE Real thresholds_of(const Mask& active) const {
        const Real unit(T(settings_.fixed_unit));
        if (settings_.budget == 0) return unit;
        LaneArray<Real> thresholds(unit);
        for_each_lane(
            active, [&](int lane) { thresholds.of[lane] = T(pixels_[pixel_[lane]].threshold.of_branches(settings_)); });
        return thresholds.all();
    }

    /// PixelSums::in_units in lanes; 0 in others.
    CISTULA_INLINE Vec3<Real> in_units(const Vec3<Real>& a, const Mask& active) {
        const Real scale(T(settings_.fixed_scale)), zero(0);
        Vec3<Real> units(fused(a.x, scale, zero), fused(a.y, scale, zero), fused(a.z, scale, zero));
        Mask right = true;
        for (int c = 0; c < 3; ++c) {
            const Mask is_right = (units[c] >= zero) & (units[c] <= scale);
            units[c] = select(active & is_right, units[c], zero);
            right &= is_right;
        }
        if (any(active & !right)) flags_ |= flag_not_finite;
        return units;
    }

    CISTULA_INLINE void give(const Integers (&from)[3], const Mask& active, int64_t (PixelRecord::*to)[3]) {
        alignas(lane_bytes) int64_t whole[3][lanes];
        for (int c = 0; c < 3; ++c) memcpy(whole[c], &from[c], sizeof from[c]);
        for_each_lane(active, [&](int lane) {
            int64_t(&sum)[3] = pixels_[pixel_[lane]].record->*to;
            for (int c = 0; c < 3; ++c) sum[c] += whole[c][lane];
        });
    }

    const TreeSettings& settings_;
    const Bounds bounds_;
    uint32_t& flags_;
    IndexOf<Real> rays_ = 0;
    Integers cut_[3];
    Mask cuts_ = false;
};

template <class T, int n, bool limited>
struct SumsType<Lanes<T, n>, false, limited> {
    using Type = LaneSums<Lanes<T, n>>;
};

}  // namespace cistula
