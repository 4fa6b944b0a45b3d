// Rays against convex solids on the host: eight slabs at once, in plain loops that the compiler vectorizes. The face of
// a crossing is looked up only when it is needed.
#pragma once

#include "cistula/geometry/slab.h"

namespace cistula::convex_host {

/// The interval of t in which a line is inside all slabs. A line parallel to a slab and outside it has enter =
/// infinity.
template <class Real>
struct Interval {
    Real enter = -RealTraits<Real>::infinity;
    Real leave = RealTraits<Real>::infinity;
};

/// The smallest t at which a line leaves a slab.
template <class Real>
struct Exit {
    Real t = RealTraits<Real>::infinity;
};

/// The times at which a line enters and leaves each of eight slabs.
template <class Real>
CISTULA_INLINE void cross_slabs(const SlabGroup<Real>& group, const Vec3<Real>& origin, const Vec3<Real>& direction,
                                Real (&enter)[slab_lanes], Real (&leave)[slab_lanes]) {
    CISTULA_LANES
    for (int i = 0; i < slab_lanes; ++i)
        cross_slab(Vec3<Real>(group.nx[i], group.ny[i], group.nz[i]), group.low[i], group.high[i], origin, direction,
                   enter[i], leave[i]);
}

/// Maximum of eight lanes, by vectorized halves.
template <class Real>
CISTULA_INLINE Real greatest_lane(const Real (&a)[slab_lanes]) {
    alignas(32) Real half[4];
    CISTULA_VECTORS
    for (int i = 0; i < 4; ++i) half[i] = max_or_second(a[i], a[i + 4]);
    return max_or_second(max_or_second(half[0], half[2]), max_or_second(half[1], half[3]));
}
/// Minimum of eight lanes, by vectorized halves.
template <class Real>
CISTULA_INLINE Real least_lane(const Real (&a)[slab_lanes]) {
    alignas(32) Real half[4];
    CISTULA_VECTORS
    for (int i = 0; i < 4; ++i) half[i] = min_or_second(a[i], a[i + 4]);
    return min_or_second(min_or_second(half[0], half[2]), min_or_second(half[1], half[3]));
}

/// The interval of t in which a line is inside a solid; the unnamed parameter is convex_device's may_stop.
template <class Real, class Scene>
CISTULA_INLINE Interval<Real> interval_of(const Scene& scene, const Solid& solid, const Vec3<Real>& origin,
                                          const Vec3<Real>& direction, bool) {
    Interval<Real> interval;
    for (uint32_t first = 0; first < solid.slab_count; first += slab_lanes) {
        alignas(32) Real enter[slab_lanes], leave[slab_lanes];
        cross_slabs(scene.slab_groups[solid.first_group + first / slab_lanes], origin, direction, enter, leave);
        interval.enter = max_or_second(greatest_lane(enter), interval.enter);
        interval.leave = min_or_second(least_lane(leave), interval.leave);
    }
    return interval;
}

/// Where a ray from inside leaves the solid: by any face but `skipped`, whatever rounding says about its origin.
template <class Real, class Scene>
CISTULA_INLINE Exit<Real> exit_of(const Scene& scene, const Solid& solid, const Vec3<Real>& origin,
                                  const Vec3<Real>& direction, uint32_t skipped) {
    Exit<Real> exit;
    const Slab<Real>* slabs = scene.slabs.data + solid.first_slab;
    for (uint32_t first = 0; first < solid.slab_count; first += slab_lanes) {
        alignas(32) Real enter[slab_lanes], leave[slab_lanes];
        cross_slabs(scene.slab_groups[solid.first_group + first / slab_lanes], origin, direction, enter, leave);
        if (skipped / 2 - first < uint32_t(slab_lanes) &&
            leaving_face(skipped / 2, dot(slabs[skipped / 2].normal, direction)) == skipped)
            leave[skipped / 2 - first] = RealTraits<Real>::infinity;
        exit.t = min_or_second(least_lane(leave), exit.t);
    }
    return exit;
}

/// The face by which the line enters; the first one of several.
template <class Real, class Scene>
CISTULA_INLINE uint32_t face_of(const Scene& scene, const Solid& solid, const Vec3<Real>& origin,
                                const Vec3<Real>& direction, const Interval<Real>& interval) {
    const Slab<Real>* slabs = scene.slabs.data + solid.first_slab;
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        Real enter, leave;
        cross_slab(slabs[i].normal, slabs[i].low, slabs[i].high, origin, direction, enter, leave);
        if (enter == interval.enter) return leaving_face(i, dot(slabs[i].normal, direction)) ^ 1u;
    }
    return 0;
}

/// The face by which the line leaves; the first one of several.
template <class Real, class Scene>
CISTULA_INLINE uint32_t face_of(const Scene& scene, const Solid& solid, const Vec3<Real>& origin,
                                const Vec3<Real>& direction, const Exit<Real>& exit, uint32_t skipped) {
    const Slab<Real>* slabs = scene.slabs.data + solid.first_slab;
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        Real enter, leave;
        cross_slab(slabs[i].normal, slabs[i].low, slabs[i].high, origin, direction, enter, leave);
        const uint32_t face = leaving_face(i, dot(slabs[i].normal, direction));
        if (leave == exit.t && face != skipped) return face;
    }
    return 0;
}

}  // namespace cistula::convex_host
