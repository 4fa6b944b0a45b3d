// Rays against convex solids on the device: a loop over single slabs, since every thread of a warp has its own ray.
#pragma once

#include "cistula/geometry/slab.h"

namespace cistula::convex_device {

/// The interval of t in which a line is inside all slabs. A line parallel to a slab and outside it has enter =
/// infinity.
template <class Real>
struct Interval {
    Real enter = -RealTraits<Real>::infinity;
    Real leave = RealTraits<Real>::infinity;
    uint32_t enter_slab = 0;  // scene-wide number of the first slab with this value
};

/// The smallest t at which a line leaves a slab.
template <class Real>
struct Exit {
    Real t = RealTraits<Real>::infinity;
    uint32_t face = 0;  // the first face with this value
};

/// The crossings of both planes of a slab, for a line that is not parallel to it.
template <class Real>
struct SlabCrossing {
    Real slope, at_low, at_high;

    CISTULA_INLINE SlabCrossing(const Slab<Real>& slab, const Vec3<Real>& origin, const Vec3<Real>& direction) {
        slope = dot(slab.normal, direction);
        const Real no = dot(slab.normal, origin);
        const Real inverse = reciprocal(slope);
        at_low = (slab.low - no) * inverse;
        at_high = (slab.high - no) * inverse;
    }
    CISTULA_INLINE bool is_parallel() const { return magnitude(slope) < least_slope<Real>; }
    CISTULA_INLINE Real enter() const { return min_no_nan(at_low, at_high); }
    CISTULA_INLINE Real leave() const { return max_no_nan(at_low, at_high); }
};

/// Whether a line is parallel to any slab whose slope was given to take().
template <class Real>
class ParallelSlab {
  public:
    CISTULA_INLINE void take(Real slope) { least_ = min_no_nan(magnitude(slope), least_); }
    CISTULA_INLINE bool found() const { return least_ < least_slope<Real>; }

  private:
    Real least_ = Real(1);
};
/// Specialization that compares only the upper 32 bits of doubles, which decide the question: an integer minimum is one
/// instruction, one of doubles four.
template <>
class ParallelSlab<double> {
  public:
    CISTULA_INLINE void take(double slope) {
        const uint32_t upper = upper_half(slope) & 0x7fffffffu;
        least_ = least_ < upper ? least_ : upper;
    }
    CISTULA_INLINE bool found() const { return least_ < upper_half(least_slope<double>); }

  private:
    CISTULA_INLINE static uint32_t upper_half(double a) { return uint32_t(bits_as<uint64_t>(a) >> 32); }

    uint32_t least_ = 0x7fffffffu;
};

/// The interval of a line, with the test for parallel slabs.
template <class Real, class Scene>
CISTULA_INLINE Interval<Real> careful_interval(const Scene& scene, const Solid& solid, const Vec3<Real>& origin,
                                               const Vec3<Real>& direction) {
    Interval<Real> interval;
    CISTULA_NOT_UNROLLED
    for (uint32_t i = solid.first_slab; i < solid.first_slab + solid.slab_count; ++i) {
        Real enter, leave;
        const Slab<Real>& slab = scene.slabs.data[i];
        cross_slab(slab.normal, slab.low, slab.high, origin, direction, enter, leave);
        if (enter > interval.enter) interval.enter = enter, interval.enter_slab = i;
        interval.leave = min_no_nan(leave, interval.leave);
    }
    return interval;
}

/// The interval of a line, computed as if no slab were parallel to it, and again by careful_interval() if one was.
/// `may_stop`: the loop may end once the line surely misses, with an interval that only says so.
template <class Real, class Scene>
CISTULA_INLINE Interval<Real> interval_of(const Scene& scene, const Solid& solid, const Vec3<Real>& origin,
                                          const Vec3<Real>& direction, bool may_stop) {
    Interval<Real> interval;
    ParallelSlab<Real> parallel;
    CISTULA_NOT_UNROLLED
    for (uint32_t i = solid.first_slab; i < solid.first_slab + solid.slab_count; ++i) {
        const SlabCrossing<Real> crossing(scene.slabs.data[i], origin, direction);
        parallel.take(crossing.slope);
        if (crossing.enter() > interval.enter) interval.enter = crossing.enter(), interval.enter_slab = i;
        interval.leave = min_no_nan(crossing.leave(), interval.leave);
        if (may_stop && interval.enter > interval.leave) break;
    }
    return parallel.found() ? careful_interval(scene, solid, origin, direction) : interval;
}

/// Where a ray from inside leaves the solid: by any face but `skipped`, whatever rounding says about its origin.
template <class Real, class Scene>
CISTULA_INLINE Exit<Real> exit_of(const Scene& scene, const Solid& solid, const Vec3<Real>& origin,
                                  const Vec3<Real>& direction, uint32_t skipped) {
    Exit<Real> exit;
    CISTULA_NOT_UNROLLED
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        const SlabCrossing<Real> crossing(scene.slabs.data[solid.first_slab + i], origin, direction);
        const uint32_t face = leaving_face(i, crossing.slope);
        if (crossing.leave() < exit.t && face != skipped && !crossing.is_parallel()) exit = {crossing.leave(), face};
    }
    return exit;
}

/// The face by which the line enters; the first one of several.
template <class Real, class Scene>
CISTULA_INLINE uint32_t face_of(const Scene& scene, const Solid& solid, const Vec3<Real>&, const Vec3<Real>& direction,
                                const Interval<Real>& interval) {
    const uint32_t i = interval.enter_slab;
    return leaving_face(i - solid.first_slab, dot(scene.slabs.data[i].normal, direction)) ^ 1u;
}

/// The face by which the line leaves; the first one of several.
template <class Real, class Scene>
CISTULA_INLINE uint32_t face_of(const Scene&, const Solid&, const Vec3<Real>&, const Vec3<Real>&,
                                const Exit<Real>& exit, uint32_t) {
    return exit.face;
}

}  // namespace cistula::convex_device
