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

    /// For an origin outside. A solid that ends where the line starts, give or take the rounding of a point on a shared
    /// face, is behind it.
    CISTULA_INLINE bool met(Real extent) const { return enter <= leave && leave > incidence<Real> * extent; }
};

inline constexpr uint32_t no_face = 0xffffffffu;

/// Where a line crosses one slab. Selects only, since which slab decides is unpredictable; all callers use the same
/// operations, so that the face of a value can be looked up afterwards.
template <class Real>
CISTULA_INLINE void cross_slab(const Vec3<Real>& normal, Real low, Real high, const Vec3<Real>& origin,
                               const Vec3<Real>& direction, Real& enter, Real& leave) {
    const Real nd = dot(normal, direction), no = dot(normal, origin);
    const Real inverse = Real(1) / nd;
    const Real at_low = (low - no) * inverse, at_high = (high - no) * inverse;
    // Subnormal counts as parallel: its inverse overflows, and where the origin lies in the plane 0 * inf is NaN.
    const bool parallel = magnitude(nd) < RealTraits<Real>::least_normal;
    const Real beside = no >= high || no <= low ? RealTraits<Real>::infinity : -RealTraits<Real>::infinity;
    const Real first = at_low < at_high ? at_low : at_high, last = at_low < at_high ? at_high : at_low;
    enter = parallel ? beside : first;
    leave = parallel ? RealTraits<Real>::infinity : last;
}

/// The same for eight at once, as the compiler fills vectors with it.
template <class Real>
CISTULA_INLINE void cross_slabs(const SlabGroup<Real>& group, const Vec3<Real>& origin, const Vec3<Real>& direction,
                                Real (&enter)[slab_lanes], Real (&leave)[slab_lanes]) {
#pragma GCC ivdep
    for (int i = 0; i < slab_lanes; ++i)
        cross_slab(Vec3<Real>(group.nx[i], group.ny[i], group.nz[i]), group.low[i], group.high[i], origin, direction,
                   enter[i], leave[i]);
}

template <class Real>
CISTULA_INLINE Real greatest_lane(const Real (&a)[slab_lanes]) {
    return greatest(greatest(greatest(a[0], a[4]), greatest(a[2], a[6])), greatest(greatest(a[1], a[5]), greatest(a[3], a[7])));
}
template <class Real>
CISTULA_INLINE Real least_lane(const Real (&a)[slab_lanes]) {
    return least(least(least(a[0], a[4]), least(a[2], a[6])), least(least(a[1], a[5]), least(a[3], a[7])));
}

/// `skipped` is a face that cannot be the one to leave by.
template <class Real>
CISTULA_INLINE ConvexInterval<Real> convex_interval(const SceneView<Real>& scene, const Solid& solid,
                                                    const Vec3<Real>& origin, const Vec3<Real>& direction,
                                                    uint32_t skipped = no_face) {
    ConvexInterval<Real> interval;
    const Slab<Real>* slabs = scene.slabs.data + solid.first_slab;
    const auto leaves_by_skipped = [&] {
        return (dot(slabs[skipped / 2].normal, direction) > Real(0)) == ((skipped & 1u) != 0);
    };
#if CISTULA_ON_DEVICE
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        Real enter, leave;
        cross_slab(slabs[i].normal, slabs[i].low, slabs[i].high, origin, direction, enter, leave);
        interval.enter = greatest(enter, interval.enter);
        if (skipped / 2 != i || !leaves_by_skipped()) interval.leave = least(leave, interval.leave);
    }
#else
    for (uint32_t first = 0; first < solid.slab_count; first += slab_lanes) {
        alignas(32) Real enter[slab_lanes], leave[slab_lanes];
        cross_slabs(scene.slab_groups[solid.first_group + first / slab_lanes], origin, direction, enter, leave);
        if (skipped / 2 - first < uint32_t(slab_lanes) && leaves_by_skipped())
            leave[skipped / 2 - first] = RealTraits<Real>::infinity;
        interval.enter = greatest(greatest_lane(enter), interval.enter);
        interval.leave = least(least_lane(leave), interval.leave);
    }
#endif
    return interval;
}

/// The first face by which the line enters or leaves at t, as convex_interval found it.
template <class Real>
CISTULA_INLINE uint32_t convex_face(const SceneView<Real>& scene, const Solid& solid, const Vec3<Real>& origin,
                                    const Vec3<Real>& direction, Real t, bool leaves, uint32_t skipped = no_face) {
    const Slab<Real>* slabs = scene.slabs.data + solid.first_slab;
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        Real enter, leave;
        cross_slab(slabs[i].normal, slabs[i].low, slabs[i].high, origin, direction, enter, leave);
        const uint32_t face = 2 * i + ((dot(slabs[i].normal, direction) > Real(0)) == leaves ? 1 : 0);
        if ((leaves ? leave : enter) == t && face != skipped) return face;
    }
    return 0;
}

/// Whether a ray that starts outside surely misses: spares most rays the slabs, decides no hit.
template <class Real>
CISTULA_INLINE bool passes_by(const Solid& solid, const Vec3<Real>& origin, const Vec3<Real>& direction) {
    const Vec3<Real> to_center = Vec3<Real>(solid.center) - origin;
    const Real ahead = dot(to_center, direction), rest = dot(to_center, to_center) - Real(solid.padded_square);
    return rest > Real(0) && (ahead < Real(0) || rest > ahead * ahead);
}

/// The ray's next crossing of a convex solid, if it is less than `best`.
template <class Real, class Media>
CISTULA_CALLED void closest_convex(const SceneView<Real>& scene, uint32_t index, const Ray<Real, Media>& ray,
                                   Hit<Real>& best) {
    const bool inside = ray.media.contains(index), own = ray.from_solid == index;
    if (own && !inside) return;
    const Solid& solid = scene.solids[index];
    if (!inside && passes_by(solid, ray.origin, ray.direction)) return;
    const uint32_t skipped = own ? ray.from_face : no_face;
    const ConvexInterval<Real> interval = convex_interval(scene, solid, ray.origin, ray.direction, skipped);
    if (!inside && !interval.met(scene.extent)) return;
    // Before the face, which takes a look at every slab, what the time alone decides.
    const Real found = inside ? interval.leave : interval.enter, t = greatest(found, Real(0));
    if (!(t <= best.t && t < RealTraits<Real>::infinity) || (!inside && t < ray.after.t)) return;
    const uint32_t face = convex_face(scene, solid, ray.origin, ray.direction, found, inside, skipped);
    const uint64_t key = make_key(inside ? CrossingKind::leave : CrossingKind::enter, index, face);
    if (!inside && !ray.after.before(t, key)) return;
    if (best.improves(t, key)) best = {t, key, Real(0), Real(0), 0, !inside};
}

/// The next crossing of a ray inside a solid that stands alone, which is the way out of it; false for any other ray.
template <class Real, class Media>
CISTULA_INLINE bool closest_enclosed(const SceneView<Real>& scene, const Ray<Real, Media>& ray, Hit<Real>& best) {
    const uint32_t solid = ray.media.only();
    if (solid == no_solid || !scene.solids[solid].alone) return false;
    closest_convex(scene, solid, ray, best);
    return true;
}

/// Strictly inside all planes.
template <class Real>
CISTULA_HD inline bool inside_convex(const SceneView<Real>& scene, const Solid& solid, const Vec3<Real>& point) {
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        const Slab<Real>& slab = scene.slabs[solid.first_slab + i];
        const Real n = dot(slab.normal, point);
        if (!(n > slab.low && n < slab.high)) return false;
    }
    return true;
}

}  // namespace cistula
