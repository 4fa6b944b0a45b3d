// Convex solids as slabs (Kay and Kajiya 1986), with state instead of epsilons: a ray that is inside leaves through the
// least leaving plane, one that left does not come back, whatever rounding says about where it stands.
#pragma once

#include "cistula/ray.h"
#include "cistula/scene_view.h"

namespace cistula {

/// Where a line is inside all slabs. A line beside a slab that it is parallel to has enter = infinity.
template <class Real>
struct ConvexInterval {
    Real enter = -RealTraits<Real>::infinity, leave = RealTraits<Real>::infinity;
#if CISTULA_ON_DEVICE
    uint32_t enter_slab = 0;  // of the scene's: the first with this value; the host looks it up where it counts
#endif

    /// For an origin outside. A solid that ends where the line starts, give or take the rounding of a point on a shared
    /// face, is behind it.
    CISTULA_INLINE bool met(Real extent) const {
        return enter <= leave && leave > incidence<Real> * extent;
    }
};

/// The least t at which a line leaves a slab.
template <class Real>
struct ConvexExit {
    Real t = RealTraits<Real>::infinity;
#if CISTULA_ON_DEVICE
    uint32_t face = 0;  // the first with this value; the host looks it up where it counts
#endif
};

inline constexpr uint32_t no_face = 0xffffffffu;

/// A line at less of a slope counts as parallel to a slab: times stay finite.
template <class Real>
inline constexpr Real least_slope = Real(0x1p-100);

/// Where a line crosses one slab. Selects only, since which slab decides is unpredictable; all callers use the same
/// operations, so that the face of a value can be looked up afterwards.
template <class Real>
CISTULA_INLINE void cross_slab(const Vec3<Real>& normal, Real low, Real high, const Vec3<Real>& origin,
                               const Vec3<Real>& direction, Real& enter, Real& leave) {
    const Real nd = dot(normal, direction), no = dot(normal, origin);
    const bool parallel = magnitude(nd) < least_slope<Real>;
    const Real inverse = reciprocal(parallel ? Real(1) : nd);
    const Real at_low = (low - no) * inverse, at_high = (high - no) * inverse;
    const Real beside = no >= high || no <= low ? RealTraits<Real>::infinity : -RealTraits<Real>::infinity;
    const Real first = lesser(at_low, at_high), last = greater(at_low, at_high);
    enter = parallel ? beside : first;
    leave = parallel ? RealTraits<Real>::infinity : last;
}

#if CISTULA_ON_DEVICE
/// The same, the crossings of both sides apart, for a line that is not parallel to the slab.
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
#endif

/// The same for eight at once, as the compiler fills vectors with it.
template <class Real>
CISTULA_INLINE void cross_slabs(const SlabGroup<Real>& group, const Vec3<Real>& origin, const Vec3<Real>& direction,
                                Real (&enter)[slab_lanes], Real (&leave)[slab_lanes]) {
#pragma GCC ivdep
    for (int i = 0; i < slab_lanes; ++i)
        cross_slab(Vec3<Real>(group.nx[i], group.ny[i], group.nz[i]), group.low[i], group.high[i], origin, direction,
                   enter[i], leave[i]);
}

/// In halves, which are vectors too.
template <class Real>
CISTULA_INLINE Real greatest_lane(const Real (&a)[slab_lanes]) {
    alignas(32) Real half[4];
    CISTULA_VECTORS
    for (int i = 0; i < 4; ++i) half[i] = greatest(a[i], a[i + 4]);
    return greatest(greatest(half[0], half[2]), greatest(half[1], half[3]));
}
template <class Real>
CISTULA_INLINE Real least_lane(const Real (&a)[slab_lanes]) {
    alignas(32) Real half[4];
    CISTULA_VECTORS
    for (int i = 0; i < 4; ++i) half[i] = least(a[i], a[i + 4]);
    return least(least(half[0], half[2]), least(half[1], half[3]));
}

/// One slab after the other, parallel to the line or not.
template <class Real, class Scene>
CISTULA_INLINE ConvexInterval<Real> careful_interval(const Scene& scene, uint32_t first, uint32_t end,
                                                     const Vec3<Real>& origin, const Vec3<Real>& direction) {
    ConvexInterval<Real> interval;
#if CISTULA_ON_DEVICE
#pragma unroll 1
#endif
    for (uint32_t i = first; i < end; ++i) {
        Real enter, leave;
        const Slab<Real>& slab = scene.slabs.data[i];
        cross_slab(slab.normal, slab.low, slab.high, origin, direction, enter, leave);
        if (enter > interval.enter) {
            interval.enter = enter;
#if CISTULA_ON_DEVICE
            interval.enter_slab = i;
#endif
        }
        interval.leave = lesser(leave, interval.leave);
    }
    return interval;
}

/// `may_stop`: where it is sure not to be met, that is all that is known.
template <class Real, class Scene>
CISTULA_INLINE ConvexInterval<Real> convex_interval(const Scene& scene, const Solid& solid, const Vec3<Real>& origin,
                                                    const Vec3<Real>& direction, [[maybe_unused]] bool may_stop) {
    ConvexInterval<Real> interval;
#if CISTULA_ON_DEVICE
    // As if no slab were parallel to the line; with more care where one was.
    const uint32_t end = solid.first_slab + solid.slab_count;
    ParallelSlab<Real> parallel;
#pragma unroll 1
    for (uint32_t i = solid.first_slab; i < end; ++i) {
        const SlabCrossing<Real> crossing(scene.slabs.data[i], origin, direction);
        parallel.take(crossing.slope);
        if (crossing.enter() > interval.enter) interval.enter = crossing.enter(), interval.enter_slab = i;
        interval.leave = lesser(crossing.leave(), interval.leave);
        if (may_stop && interval.enter > interval.leave) break;
    }
    if (parallel.found()) return careful_interval(scene, solid.first_slab, end, origin, direction);
#else
    for (uint32_t first = 0; first < solid.slab_count; first += slab_lanes) {
        alignas(32) Real enter[slab_lanes], leave[slab_lanes];
        cross_slabs(scene.slab_groups[solid.first_group + first / slab_lanes], origin, direction, enter, leave);
        interval.enter = greatest(greatest_lane(enter), interval.enter);
        interval.leave = least(least_lane(leave), interval.leave);
    }
#endif
    return interval;
}

/// The face by which a line leaves a slab.
template <class Real>
CISTULA_INLINE uint32_t leaving_face(uint32_t slab, Real slope) {
    return 2 * slab + (slope > Real(0) ? 1 : 0);
}

#if CISTULA_ON_DEVICE
/// Where a slab is parallel to the line, or a face was skipped.
template <class Real, class Scene>
CISTULA_INLINE ConvexExit<Real> careful_exit(const Scene& scene, uint32_t first, uint32_t count,
                                             const Vec3<Real>& origin, const Vec3<Real>& direction, uint32_t skipped) {
    ConvexExit<Real> exit;
#pragma unroll 1
    for (uint32_t i = 0; i < count; ++i) {
        const SlabCrossing<Real> crossing(scene.slabs.data[first + i], origin, direction);
        const uint32_t face = leaving_face(i, crossing.slope);
        if (crossing.leave() < exit.t && face != skipped && !crossing.is_parallel()) exit = {crossing.leave(), face};
    }
    return exit;
}

#endif

/// Where a line from inside leaves: by another face than `skipped`, whatever rounding says about where it starts.
template <class Real, class Scene>
CISTULA_INLINE ConvexExit<Real> convex_exit(const Scene& scene, const Solid& solid, const Vec3<Real>& origin,
                                            const Vec3<Real>& direction, uint32_t skipped = no_face) {
#if CISTULA_ON_DEVICE
    return careful_exit(scene, solid.first_slab, solid.slab_count, origin, direction, skipped);
#else
    ConvexExit<Real> exit;
    const Slab<Real>* slabs = scene.slabs.data + solid.first_slab;
    for (uint32_t first = 0; first < solid.slab_count; first += slab_lanes) {
        alignas(32) Real enter[slab_lanes], leave[slab_lanes];
        cross_slabs(scene.slab_groups[solid.first_group + first / slab_lanes], origin, direction, enter, leave);
        if (skipped / 2 - first < uint32_t(slab_lanes) &&
            leaving_face(skipped / 2, dot(slabs[skipped / 2].normal, direction)) == skipped)
            leave[skipped / 2 - first] = RealTraits<Real>::infinity;
        exit.t = least(least_lane(leave), exit.t);
    }
    return exit;
#endif
}

/// The first face by which the line enters, as convex_interval found it.
template <class Real, class Scene>
CISTULA_INLINE uint32_t convex_face(const Scene& scene, const Solid& solid, [[maybe_unused]] const Vec3<Real>& origin,
                                    const Vec3<Real>& direction, const ConvexInterval<Real>& interval) {
#if CISTULA_ON_DEVICE
    const uint32_t i = interval.enter_slab;
    return leaving_face(i - solid.first_slab, dot(scene.slabs.data[i].normal, direction)) ^ 1u;
#else
    const Slab<Real>* slabs = scene.slabs.data + solid.first_slab;
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        Real enter, leave;
        cross_slab(slabs[i].normal, slabs[i].low, slabs[i].high, origin, direction, enter, leave);
        if (enter == interval.enter) return leaving_face(i, dot(slabs[i].normal, direction)) ^ 1u;
    }
    return 0;
#endif
}

/// The first face by which the line leaves, as convex_exit found it.
template <class Real, class Scene>
CISTULA_INLINE uint32_t convex_face([[maybe_unused]] const Scene& scene, [[maybe_unused]] const Solid& solid,
                                    [[maybe_unused]] const Vec3<Real>& origin,
                                    [[maybe_unused]] const Vec3<Real>& direction, const ConvexExit<Real>& exit,
                                    [[maybe_unused]] uint32_t skipped) {
#if CISTULA_ON_DEVICE
    return exit.face;
#else
    const Slab<Real>* slabs = scene.slabs.data + solid.first_slab;
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        Real enter, leave;
        cross_slab(slabs[i].normal, slabs[i].low, slabs[i].high, origin, direction, enter, leave);
        const uint32_t face = leaving_face(i, dot(slabs[i].normal, direction));
        if (leave == exit.t && face != skipped) return face;
    }
    return 0;
#endif
}

/// Whether a ray that starts outside surely misses, or meets the solid only beyond `limit`: spares most rays the slabs,
/// decides no hit.
template <class Real>
CISTULA_INLINE bool passes_by(const Ball<Real>& ball, const Vec3<Real>& origin, const Vec3<Real>& direction,
                              Real limit) {
    const Vec3<Real> to_center = ball.center - origin;
    const Real ahead = dot(to_center, direction), rest = dot(to_center, to_center) - ball.padded_square;
    const Real beyond = limit * (Real(2) * ahead - limit), beside = ahead < Real(0) ? Real(0) : ahead * ahead;
    return rest > (ahead > limit ? beyond : beside);
}

/// The way out of a convex solid that the ray is inside, if that is less than `best`: before the face is looked up,
/// what the time alone decides.
template <class Real, class Media, class Scene>
CISTULA_INLINE void closest_exit(const Scene& scene, uint32_t index, const Ray<Real, Media>& ray, Hit<Real>& best) {
    const Solid& solid = scene.solids[index];
    const uint32_t skipped = ray.from_solid == index ? ray.from_face : no_face;
    const ConvexExit<Real> exit = convex_exit(scene, solid, ray.origin, ray.direction, skipped);
    const Real t = greatest(exit.t, Real(0));
    if (!(t <= best.t && t < RealTraits<Real>::infinity)) return;
    const uint64_t key =
        make_key(CrossingKind::leave, index, convex_face(scene, solid, ray.origin, ray.direction, exit, skipped));
    if (best.improves(t, key)) best.take(t, key, Real(0), Real(0), 0, false);
}

/// Whether a line from within the planes of a solid that it is not inside goes toward a face that it starts on, give or
/// take rounding: at a slant it would go far in the film before it is out. Asked where solids touch. By value, as it is
/// called.
template <class Real, class Scene>
CISTULA_SELDOM bool ends_at_start(const Scene& scene, uint32_t index, Vec3<Real> origin, Vec3<Real> direction) {
    const Solid& solid = scene.solids[index];
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        const Slab<Real>& slab = scene.slabs[solid.first_slab + i];
        const Real nd = dot(slab.normal, direction), no = dot(slab.normal, origin);
        const Real depth = nd > Real(0) ? slab.high - no : no - slab.low;
        if (nd != Real(0) && depth <= incidence<Real> * scene.extent) return true;
    }
    return false;
}

/// The way into a convex solid that the ray neither is inside nor left, nor passes by.
template <class Real, class Media, class Scene>
CISTULA_INLINE void closest_entry(const Scene& scene, uint32_t index, const Solid& solid, const Ray<Real, Media>& ray,
                                  Hit<Real>& best) {
    const ConvexInterval<Real> interval = convex_interval(scene, solid, ray.origin, ray.direction, true);
    if (!interval.met(scene.extent)) return;
    const Real t = greatest(interval.enter, Real(0));
    if (!(t <= best.t && t < RealTraits<Real>::infinity) || t < ray.after.t) return;
    if constexpr (Media::contacts)
        if (solid.touched && interval.enter < Real(0) && ends_at_start(scene, index, ray.origin, ray.direction)) return;
    const uint64_t key =
        make_key(CrossingKind::enter, index, convex_face(scene, solid, ray.origin, ray.direction, interval));
    if (ray.after.before(t, key) && best.improves(t, key)) best.take(t, key, Real(0), Real(0), 0, true);
}

/// The ray's next crossing of a convex solid, if it is less than `best`.
template <class Real, class Media, class Scene>
CISTULA_CALLED void closest_convex(const Scene& scene, uint32_t index, const Ray<Real, Media>& ray, Hit<Real>& best) {
    if (ray.media.contains(index))
        closest_exit(scene, index, ray, best);
    else if (ray.from_solid != index &&
             !passes_by(Ball<Real>::of(scene.solids[index]), ray.origin, ray.direction, best.t))
        closest_entry(scene, index, scene.solids[index], ray, best);
}

/// The solid around a ray that meets its own way out next, since it stands alone; no_solid for any other ray.
template <class Real, class Media, class Scene>
CISTULA_INLINE uint32_t enclosing(const Scene& scene, const Ray<Real, Media>& ray) {
    const uint32_t solid = ray.media.only();
    return solid != no_solid && scene.solids[solid].alone ? solid : no_solid;
}

/// The next crossing of a ray inside such a solid; false for any other ray.
template <class Real, class Media, class Scene>
CISTULA_INLINE bool closest_enclosed(const Scene& scene, const Ray<Real, Media>& ray, Hit<Real>& best) {
    const uint32_t solid = enclosing(scene, ray);
    if (solid == no_solid) return false;
    closest_convex(scene, solid, ray, best);
    return true;
}

/// Strictly inside all planes.
template <class Real, class Scene>
CISTULA_HD inline bool inside_convex(const Scene& scene, const Solid& solid, const Vec3<Real>& point) {
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        const Slab<Real>& slab = scene.slabs[solid.first_slab + i];
        const Real n = dot(slab.normal, point);
        if (!(n > slab.low && n < slab.high)) return false;
    }
    return true;
}

}  // namespace cistula
