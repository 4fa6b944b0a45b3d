// Lanes of rays against convex solids: one slab after the other, each against all rays. Rays from outside and from
// inside share the loop.
#pragma once

#include "cistula/geometry/convex.h"
#include "cistula/lanes/lane_hit.h"

namespace cistula::convex_lanes {

/// What is asked of a line: the face by which it enters; that by which a ray inside leaves, but for one.
inline constexpr int entering = 1;
inline constexpr int inside = 2;

/// Where lines enter and leave a solid, with the first faces that have these times.
template <class Real>
struct SolidCrossing {
    Real enter = -RealTraits<Real>::infinity;
    Real leave = RealTraits<Real>::infinity;
    IndexOf<Real> enter_face = 0;
    IndexOf<Real> leave_face = 0;

    /// Takes the crossings of slab i, whose leaving face is `leaving`; `skipped` is not left by.
    template <int asked>
    CISTULA_INLINE void take(const Real& in, const Real& out, const IndexOf<Real>& leaving,
                             const IndexOf<Real>& skipped) {
        if constexpr ((asked & entering) != 0) enter_face = select(in > enter, leaving, enter_face);
        enter = max_or_second(in, enter);
        if constexpr ((asked & inside) != 0) {
            const MaskOf<Real> sooner = (out < leave) & (leaving != skipped);
            leave = select(sooner, out, leave);
            leave_face = select(sooner, leaving, leave_face);
        } else {
            leave = min_or_second(out, leave);
        }
    }
};

/// Computed as if no slab were parallel to a line, and again with the test for that if one was.
template <class Real, bool careful, int asked, class Scene>
CISTULA_INLINE SolidCrossing<Real> cross_all(const Scene& scene, const Solid& solid, const Vec3<Real>& origin,
                                             const Vec3<Real>& direction, const IndexOf<Real>& skipped, Real& least) {
    SolidCrossing<Real> crossing;
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        const Slab<ScalarOf<Real>>& slab = scene.slabs.data[solid.first_slab + i];
        const Vec3<Real> normal = spread<Real>(slab.normal);
        const Real slope = dot(normal, direction);
        Real in, out;
        if constexpr (careful) {
            cross_slab(normal, Real(slab.low), Real(slab.high), origin, direction, in, out);
        } else {
            const Real no = dot(normal, origin);
            const Real inverse = reciprocal(slope);
            const Real at_low = (slab.low - no) * inverse;
            const Real at_high = (slab.high - no) * inverse;
            in = min_no_nan(at_low, at_high);
            out = max_no_nan(at_low, at_high);
            least = min_or_second(magnitude(slope), least);
        }
        IndexOf<Real> leaving;
        if constexpr (asked != 0) leaving = IndexOf<Real>(int(2 * i)) - minus_one_where(slope > Real(0));
        crossing.template take<asked>(in, out, leaving, skipped);
    }
    crossing.enter_face = crossing.enter_face ^ 1;
    return crossing;
}

template <class Real, int asked, class Scene>
CISTULA_INLINE SolidCrossing<Real> cross(const Scene& scene, const Solid& solid, const Vec3<Real>& origin,
                                         const Vec3<Real>& direction, const IndexOf<Real>& skipped) {
    Real least(1);
    const SolidCrossing<Real> crossing = cross_all<Real, false, asked>(scene, solid, origin, direction, skipped, least);
    if (!any(least < least_slope<ScalarOf<Real>>)) return crossing;
    return cross_all<Real, true, asked>(scene, solid, origin, direction, skipped, least);
}

}  // namespace cistula::convex_lanes
