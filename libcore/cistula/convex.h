// Convex solids as slabs (Kay and Kajiya 1986), with state instead of epsilons: a ray that is inside leaves through the
// least leaving plane, one that left does not come back, whatever rounding says about where it stands.
#pragma once

#include "cistula/ray.h"
#include "cistula/scene_view.h"

namespace cistula {

/// Where a line is inside all slabs. Faces as in Slab.
template <class Real>
struct ConvexInterval {
    Real enter = -RealTraits<Real>::infinity, leave = RealTraits<Real>::infinity;
    uint32_t enter_face = 0, leave_face = 0;
    bool beside = false;  // parallel to a slab and not inside it: seen from outside, a miss

    /// For an origin outside.
    CISTULA_INLINE bool met() const { return !beside && enter <= leave && leave > Real(0); }
};

inline constexpr uint32_t no_face = 0xffffffffu;

/// For an origin outside the slabs that follow a miss are left out; met() stays false whatever they say. `skipped` is a
/// face that cannot be the one to leave by.
template <class Real>
CISTULA_INLINE ConvexInterval<Real> convex_interval(const SceneView<Real>& scene, const Solid& solid,
                                                    const Vec3<Real>& origin, const Vec3<Real>& direction,
                                                    bool outside, uint32_t skipped = no_face) {
    ConvexInterval<Real> interval;
    const Slab<Real>* slabs = scene.slabs.data + solid.first_slab;
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        const Slab<Real>& slab = slabs[i];
        const Real nd = dot(slab.normal, direction), no = dot(slab.normal, origin);
        // Subnormal counts as parallel: its inverse overflows, and where the origin lies in the plane 0 * inf is NaN.
        if (magnitude(nd) < RealTraits<Real>::least_normal) {
            interval.beside |= no >= slab.high || no <= slab.low;
            continue;
        }
        const Real inverse = Real(1) / nd;
        const Real at_low = (slab.low - no) * inverse, at_high = (slab.high - no) * inverse;
        const bool upward = nd > Real(0);
        const Real enter = upward ? at_low : at_high, leave = upward ? at_high : at_low;
        const uint32_t enter_face = 2 * i + (upward ? 0 : 1), leave_face = enter_face ^ 1;
        if (enter > interval.enter) interval.enter = enter, interval.enter_face = enter_face;
        if (leave < interval.leave && leave_face != skipped) interval.leave = leave, interval.leave_face = leave_face;
        if (outside && !(interval.enter <= interval.leave && interval.leave > Real(0))) break;
    }
    return interval;
}

/// Whether a ray that starts outside surely misses: spares most rays the slabs, decides no hit.
template <class Real>
CISTULA_INLINE bool passes_by(const Solid& solid, const Vec3<Real>& origin, const Vec3<Real>& direction) {
    const Vec3<Real> to_center = Vec3<Real>(solid.center) - origin;
    const Real ahead = dot(to_center, direction), rest = dot(to_center, to_center) - Real(solid.padded_square);
    return rest > Real(0) && (ahead < Real(0) || rest > ahead * ahead);
}

/// The ray's next crossing of a convex solid, if it is less than `best`.
template <class Real>
CISTULA_CALLED void closest_convex(const SceneView<Real>& scene, uint32_t index, const Ray<Real>& ray,
                                   Hit<Real>& best) {
    const bool inside = ray.media.contains(index), own = ray.from_solid == index;
    if (own && !inside) return;
    const Solid& solid = scene.solids[index];
    if (!inside && passes_by(solid, ray.origin, ray.direction)) return;
    const ConvexInterval<Real> interval =
        convex_interval(scene, solid, ray.origin, ray.direction, !inside, own ? ray.from_face : no_face);
    Real t;
    uint64_t key;
    if (inside) {
        t = greatest(interval.leave, Real(0));
        key = make_key(CrossingKind::leave, index, interval.leave_face);
        if (!(t < RealTraits<Real>::infinity)) return;
    } else {
        if (!interval.met()) return;
        t = greatest(interval.enter, Real(0));
        key = make_key(CrossingKind::enter, index, interval.enter_face);
        if (!ray.after.before(t, key)) return;
    }
    if (best.improves(t, key)) best = {t, key, Real(0), Real(0), 0, !inside};
}

/// The next crossing of a ray inside a solid that stands alone, which is the way out of it; false for any other ray.
template <class Real>
CISTULA_INLINE bool closest_enclosed(const SceneView<Real>& scene, const Ray<Real>& ray, Hit<Real>& best) {
    if (ray.media.size != 1) return false;
    const uint32_t solid = MediaList::solid_of(ray.media.entries[0]);
    if (!scene.solids[solid].alone || MediaList::count_of(ray.media.entries[0]) <= 0) return false;
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
