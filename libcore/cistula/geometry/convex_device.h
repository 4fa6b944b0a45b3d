// Lines against convex solids on the device: one slab after the other, as every thread of a warp has a line of its own.
#pragma once

#include "cistula/geometry/slab.h"

namespace cistula::convex_device {

/// Where a line is inside all slabs. A line beside a slab that it is parallel to has enter = infinity.
template <class Real>
struct Interval {
    Real enter = -RealTraits<Real>::infinity, leave = RealTraits<Real>::infinity;
    uint32_t enter_slab = 0;  // number in the scene of the first slab with this value
};

/// The least time at which a line leaves a slab.
template <class Real>
struct Exit {
    Real t = RealTraits<Real>::infinity;
    uint32_t face = 0;  // the first with this value
};

/// The crossings of both sides of a slab, for a line that is not parallel to it.
template <class Real>
struct SlabCrossing {
    Real slope, at_low, at_high;

    CISTULA_INLINE SlabCrossing(const Slab<Real>& slab, const Vec3<Real>& origin, const Vec3<Real>& direction) {
        slope = dot(slab.normal, direction);
        const Real no = dot(slab.normal, origin), inverse = reciprocal(slope);
        at_low = (slab.low - no) * inverse;
        at_high = (slab.high - no) * inverse;
    }
    CISTULA_INLINE bool is_parallel() const { return magnitude(slope) < least_slope<Real>; }
    CISTULA_INLINE Real enter() const { return lesser(at_low, at_high); }
    CISTULA_INLINE Real leave() const { return greater(at_low, at_high); }
};

/// Whether a line is parallel to any of the slabs that were taken in.
template <class Real>
class ParallelSlab {
  public:
    CISTULA_INLINE void take(Real slope) { least_ = lesser(magnitude(slope), least_); }
    CISTULA_INLINE bool found() const { return least_ < least_slope<Real>; }

  private:
    Real least_ = Real(1);
};
/// By the upper halves, which decide it: integers, whose least is one instruction where that of doubles is four.
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

/// The interval of a line that may be parallel to slabs.
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
        interval.leave = lesser(leave, interval.leave);
    }
    return interval;
}

/// The interval of a line: first as if no slab were parallel to it, with more care where one was. `may_stop`: where the
/// solid is sure not to be met, that is all that is known of the interval.
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
        interval.leave = lesser(crossing.leave(), interval.leave);
        if (may_stop && interval.enter > interval.leave) break;
    }
    return parallel.found() ? careful_interval(scene, solid, origin, direction) : interval;
}

/// Where a line from inside leaves: by another face than `skipped`, whatever rounding says about where it starts.
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

/// The first face by which the line enters.
template <class Real, class Scene>
CISTULA_INLINE uint32_t face_of(const Scene& scene, const Solid& solid, const Vec3<Real>&, const Vec3<Real>& direction,
                                const Interval<Real>& interval) {
    const uint32_t i = interval.enter_slab;
    return leaving_face(i - solid.first_slab, dot(scene.slabs.data[i].normal, direction)) ^ 1u;
}

/// The first face by which the line leaves.
template <class Real, class Scene>
CISTULA_INLINE uint32_t face_of(const Scene&, const Solid&, const Vec3<Real>&, const Vec3<Real>&,
                                const Exit<Real>& exit, uint32_t) {
    return exit.face;
}

}  // namespace cistula::convex_device
