// Numbers of eight rays side by side: loops over them become vectors, of the very operations that one ray asks for.
#pragma once

#include <type_traits>

#include "cistula/vec.h"

namespace cistula {

inline constexpr int lane_count = 8;

template <class T>
struct alignas(32) Lanes {
    T of[lane_count];
};

/// An integer as wide as a Real, so that both fill vectors of as many lanes.
template <class Real>
using LaneIndex = std::conditional_t<sizeof(Real) == sizeof(float), int32_t, int64_t>;

template <class Real>
struct VecLanes {
    Lanes<Real> x, y, z;

    CISTULA_INLINE Vec3<Real> operator[](int i) const { return {x.of[i], y.of[i], z.of[i]}; }
    CISTULA_INLINE void put(int i, const Vec3<Real>& a) {
        x.of[i] = a.x;
        y.of[i] = a.y;
        z.of[i] = a.z;
    }
};

/// The same for all lanes.
template <class Real>
struct SameVec {
    Vec3<Real> value;

    CISTULA_INLINE const Vec3<Real>& operator[](int) const { return value; }
};

template <class Visit>
CISTULA_INLINE void for_lanes(const Visit& visit) {
#pragma GCC ivdep
    CISTULA_VECTORS
    for (int i = 0; i < lane_count; ++i) visit(i);
}

/// Bit i: is(i).
template <class Is>
CISTULA_INLINE uint32_t lanes_where(const Is& is) {
    alignas(32) int32_t signs[lane_count];
    for_lanes([&](int i) { signs[i] = is(i) ? -1 : 0; });
    return sign_bits(signs);
}

/// In ascending order.
template <class Visit>
CISTULA_INLINE void for_each_lane(uint32_t lanes, const Visit& visit) {
    for (; lanes != 0; lanes &= lanes - 1) visit(int(lowest_bit(lanes)));
}

}  // namespace cistula
