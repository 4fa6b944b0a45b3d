// The interior lists of lanes.
#pragma once

#include "cistula/geometry/ray.h"
#include "cistula/lanes/lane_scene.h"
#include "cistula/lanes/lanes.h"

namespace cistula {

/// The closed solids of a LaneScene that contain a point, a bit each.
struct InteriorSet {
    uint32_t bits = 0;

    /// Calls visit(solid, 1) for every solid.
    template <class Visit>
    CISTULA_INLINE void for_each(const Visit& visit) const {
        for (uint32_t left = bits; left != 0; left &= left - 1) visit(lowest_bit(left), 1);
    }
    CISTULA_INLINE uint32_t only() const { return bits != 0 && (bits & (bits - 1)) == 0 ? lowest_bit(bits) : no_solid; }
    /// The solids of an interior list.
    CISTULA_INLINE static InteriorSet of(const InteriorList& list) {
        InteriorSet set;
        list.for_each([&](uint32_t solid, int) { set.bits |= 1u << solid; });
        return set;
    }
    /// Whether all counts of a list are 1.
    CISTULA_INLINE static bool holds(const InteriorList& list) {
        bool holds = true;
        list.for_each([&](uint32_t, int count) { holds &= count == 1; });
        return holds;
    }
    CISTULA_INLINE InteriorList list() const {
        InteriorList list;
        for_each([&](uint32_t solid, int count) { list.add(solid, count); });
        return list;
    }

    /// The last of one or more solids.
    CISTULA_INLINE uint32_t highest() const { return 31u - uint32_t(__builtin_clz(bits)); }
};

/// InteriorSets in lanes. A ray whose count of a mesh is neither 0 nor 1 is traced by itself (lane_single.h).
template <class Real>
struct LaneMedia {
    static constexpr bool contacts = true, meshes = false;
    using Index = IndexOf<Real>;
    using Mask = MaskOf<Real>;

    Index bits = 0;

    CISTULA_INLINE Mask contains(uint32_t solid) const { return (bits & Index(int(1u << solid))) != 0; }
    CISTULA_INLINE Mask contains(const Index& solid) const { return (bits & bit_of(solid)) != 0; }
    CISTULA_INLINE Mask empty() const { return bits == 0; }
    /// The transparent solids among them.
    template <class Scene>
    CISTULA_INLINE Index transparent(const Scene& scene) const {
        return bits & Index(int(scene.transparent));
    }
    template <class Scene>
    CISTULA_INLINE Index medium(const Scene& scene) const {
        Index highest = no_solid;
        const Index media = transparent(scene);
        if constexpr (sizeof(ScalarOf<Index>) == 4)
            return select(media == 0, highest, Index(native::highest_bits(media.v)));
        for_each_value(media != 0, media, [&](uint32_t set, const Mask& same) {
            assign_where(same, highest, Index(int(InteriorSet{set}.highest())));
        });
        return highest;
    }

    /// Records that a closed solid is entered or left. False, without a change, where that is impossible or the solids
    /// are more than an InteriorList holds.
    CISTULA_INLINE Mask cross(const Mask& enters, const Mask& leaves, const Index& solid) {
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

    CISTULA_INLINE void take_where(const Mask& who, const LaneMedia& other) { assign_where(who, bits, other.bits); }
    CISTULA_INLINE InteriorSet of(int lane) const { return {uint32_t(bits[lane])}; }

  private:
    CISTULA_INLINE static Index bit_of(const Index& solid) { return Index(1) << (solid & 31); }
};

}  // namespace cistula
