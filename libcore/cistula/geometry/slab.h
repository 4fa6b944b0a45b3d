// The crossings of a line and a slab, the space between two parallel planes (Kay and Kajiya 1986).
#pragma once

#include "cistula/geometry/ray.h"
#include "cistula/model/scene_view.h"

namespace cistula {

inline constexpr uint32_t no_face = 0xffffffffu;

/// Lines with less slope than this count as parallel to a slab, which keeps times finite.
template <class Real>
inline constexpr Real least_slope = Real(0x1p-100);

/// The times at which a line enters and leaves a slab. A line parallel to the slab leaves at infinity; it enters at
/// infinity if it lies outside the slab, else at -infinity. Uses selects only, since branches would be unpredictable.
/// All callers use the same operations, so that the face of a value can be looked up afterwards.
template <class Real>
CISTULA_INLINE void cross_slab(const Vec3<Real>& normal, Real low, Real high, const Vec3<Real>& origin,
                               const Vec3<Real>& direction, Real& enter, Real& leave) {
    constexpr auto infinity = RealTraits<Real>::infinity;
    const Real nd = dot(normal, direction);
    const Real no = dot(normal, origin);
    const MaskOf<Real> parallel = magnitude(nd) < least_slope<ScalarOf<Real>>;
    const Real inverse = reciprocal(select(parallel, Real(1), nd));
    const Real at_low = (low - no) * inverse;
    const Real at_high = (high - no) * inverse;
    const Real beside = select((no >= high) | (no <= low), Real(infinity), Real(-infinity));
    const Real first = min_no_nan(at_low, at_high);
    const Real last = max_no_nan(at_low, at_high);
    enter = select(parallel, beside, first);
    leave = select(parallel, Real(infinity), last);
}

/// The face of a convex solid by which a line with this slope leaves a slab.
template <class Real>
CISTULA_INLINE uint32_t leaving_face(uint32_t slab, Real slope) {
    return 2 * slab + (slope > Real(0) ? 1 : 0);
}

}  // namespace cistula
