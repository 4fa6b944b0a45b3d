// The interior lists of lanes.
#pragma once

#include "cistula/lanes/lane_scene.h"
#include "cistula/lanes/lanes.h"

namespace cistula {

/// InteriorSets in lanes. A ray whose count of a mesh is neither 0 nor 1, or that is inside too many solids, is traced
/// by itself (lane_single.h).
template <class Real>
struct LaneMedia {
    static constexpr bool contacts = true;
    static constexpr bool meshes = false;
    using Index = IndexOf<Real>;
    using Mask = MaskOf<Real>;

    Index bits = 0;
    bool named = false;

    CISTULA_INLINE Mask contains(uint32_t solid) const {
        if (named) return places_of(Index(int(solid))) != 0;
        return (bits & Index(int(1u << solid))) != 0;
    }
    CISTULA_INLINE Mask contains(const Index& solid) const {
        if (named) return places_of(solid) != 0;
        return (bits & bit_of(solid)) != 0;
    }
    CISTULA_INLINE Mask empty() const { return bits == 0; }
    /// The sets' solids that a SolidSet has.
    CISTULA_INLINE Index among(const SolidSet& solids) const {
        if (!named) return bits & Index(int(solids.bits));
        Index kept = 0;
        if (solids.any)
            for_each_value(!empty(), bits, [&](uint32_t set, const Mask& same) {
                const InteriorSet some = InteriorSet{set, true}.among([&](uint32_t i) { return solids.each[i] != 0; });
                assign_where(same, kept, Index(int(some.bits)));
            });
        return kept;
    }
    template <class Scene>
    CISTULA_INLINE Index medium(const Scene& scene) const {
        Index last = no_solid;
        const Index media = among(scene.transparent);
        if constexpr (sizeof(ScalarOf<Index>) == 4)
            if (!named) return select(media == 0, last, Index(native::highest_bits(media.v)));
        for_each_value(media != 0, media, [&](uint32_t set, const Mask& same) {
            assign_where(same, last, Index(int(InteriorSet{set, named}.last())));
        });
        return last;
    }

    /// Records that a closed solid is entered or left. False, without a change, where that is impossible or the solids
    /// are more than an InteriorList, or this, holds.
    CISTULA_INLINE Mask cross(const Mask& enters, const Mask& leaves, const Index& solid) {
        if (named) return cross_named(enters, leaves, solid);
        const Index bit = bit_of(solid);
        const Mask is_inside = (bits & bit) != 0;
        Mask fits = (enters & !is_inside) | (leaves & is_inside);
        // A set with as many solids as fit is not less than this.
        constexpr int full = (1 << InteriorList::capacity) - 1;
        if (any(enters & (bits >= Index(full))))
            for_each_value(enters & !empty(), bits, [&](uint32_t set, const Mask& same) {
                if (__builtin_popcount(set) == InteriorList::capacity) fits = fits & !(enters & same);
            });
        assign_where(fits, bits, bits ^ bit);
        return fits | !(enters | leaves);
    }

    CISTULA_INLINE void take_where(const Mask& active, const LaneMedia& other) {
        assign_where(active, bits, other.bits);
    }
    CISTULA_INLINE InteriorSet of(int lane) const { return {uint32_t(bits[lane]), named}; }

  private:
    /// The lowest and the highest bit of each number.
    static constexpr int lowest = 1 | 1 << 10 | 1 << 20;
    static constexpr int highest = lowest << 9;

    CISTULA_INLINE static Index bit_of(const Index& solid) { return Index(1) << (solid & 31); }
    /// The highest bits of the zeros among numbers; of two zeros with a one between them, perhaps a bit too many.
    CISTULA_INLINE static Index zeros_of(const Index& numbers) {
        return (numbers - Index(lowest)) & (numbers ^ Index(-1)) & Index(highest);
    }
    /// Where a solid's number is: the highest bit of its place, or 0.
    CISTULA_INLINE Index places_of(const Index& solid) const {
        const Index number = solid + Index(1);
        const Index zeros = zeros_of(bits ^ (number | number << 10 | number << 20));
        return zeros & (Index(0) - zeros);
    }
    CISTULA_NOINLINE Mask cross_named(const Mask& enters, const Mask& leaves, const Index& solid) {
        const Index own = places_of(solid);
        const Index free = zeros_of(bits);
        const Index first_free = free & (Index(0) - free);
        const Mask enters_now = enters & (own == 0) & (free != 0);
        const Mask leaves_now = leaves & (own != 0);
        const Index number = solid + Index(1);
        assign_where(enters_now, bits, bits + number * (first_free >> 9));
        assign_where(leaves_now, bits, bits - number * (own >> 9));
        return enters_now | leaves_now | !(enters | leaves);
    }
};

}  // namespace cistula
