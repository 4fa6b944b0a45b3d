// Faces of several solids that lie in one plane (docs/rules.md, 11): their common t, and convex solids beside such a
// plane for a ray that starts on it.
#pragma once

#include "cistula/geometry/slab.h"
#include "cistula/model/constant_scene.h"
#include "cistula/model/effects.h"

namespace cistula {

/// Whether rays of a kernel may meet shared planes. A ConstantScene has none.
template <class E, class Media>
inline constexpr bool meets_contacts = E::has(effect_contacts) && Media::contacts;

/// The shared plane of a face, or no_plane.
template <class Real>
CISTULA_INLINE uint32_t plane_of_face(const SceneView<Real>& scene, uint32_t solid, uint32_t face) {
    if (scene.shared_planes.empty()) return no_plane;
    const Solid& s = scene.solids[solid];
    if (is_ball(s)) return no_plane;
    return s.kind == SolidKind::convex ? scene.slab_planes[2 * s.first_slab + face] : scene.triangle_planes[face];
}
template <class Real>
CISTULA_INLINE uint32_t plane_of_face(const ConstantScene<Real>&, uint32_t, uint32_t) {
    return no_plane;
}

/// Sets the shared plane on which a ray starts from the face that it leaves.
template <class E, class Real, class Media, class Scene>
CISTULA_INLINE void find_start_plane(const Scene& scene, Ray<Real, Media>& ray) {
    if constexpr (meets_contacts<E, Media>)
        ray.from_plane = ray.from_solid == no_solid ? no_plane : plane_of_face(scene, ray.from_solid, ray.from_face);
}

/// The t at which a line crosses a shared plane, or that of sheets near balls, by the operations of cross_slab(), so
/// that it has the bits of a slab's face there; `otherwise` for a line that is parallel to it.
template <class Real, class Plane>
CISTULA_INLINE Real plane_time(const Plane& plane, const Vec3<Real>& origin, const Vec3<Real>& direction,
                               Real otherwise) {
    const Vec3<Real> normal = spread<Real>(plane.normal);
    const Real nd = dot(normal, direction);
    const MaskOf<Real> parallel = magnitude(nd) < least_slope<ScalarOf<Real>>;
    if (all(parallel)) return otherwise;
    return select(parallel, otherwise, (plane.offset - dot(normal, origin)) * reciprocal(nd));
}

/// The signed distance of a point from a shared plane.
template <class Real>
CISTULA_INLINE Real distance_from(const SharedPlane<ScalarOf<Real>>& plane, const Vec3<Real>& point) {
    return dot(spread<Real>(plane.normal), point) - plane.offset;
}

/// The face of a convex solid on a shared plane, or no_face. It has at most one there.
template <class Real>
CISTULA_INLINE uint32_t face_on(const SceneView<Real>& scene, const Solid& solid, uint32_t plane) {
    for (uint32_t face = 0; face < 2 * solid.slab_count; ++face)
        if (scene.slab_planes[2 * solid.first_slab + face] == plane) return face;
    return no_face;
}

/// A face of a convex solid as a half-space.
template <class Real>
struct HalfSpace {
    Vec3<Real> normal;  // outward
    Real offset;

    CISTULA_INLINE static HalfSpace of(const Slab<Real>& slab, uint32_t side) {
        return side != 0 ? HalfSpace{slab.normal, slab.high} : HalfSpace{-slab.normal, -slab.low};
    }
    /// How far a point is outside, negative inside.
    CISTULA_INLINE Real outside(const Vec3<Real>& point) const { return dot(normal, point) - offset; }
};

/// The part of a line inside a convex solid, if the ray enters it.
template <class Real>
struct EntryBeside {
    Real enter = 0;  // less than 0: the ray is inside from its start on
    Real leave = 0;
    uint32_t face = no_face;  // the face by which it enters, or no_face if it does not
};

/// How far in front of a face a start may be computed that lies on it, in units of s u M.
template <class Real>
inline constexpr Real start_margin = 16;

/// Where a ray that starts on a shared plane enters a convex solid that has `own_face` on it and is not around the ray
/// (docs/rules.md, 11, line 14). The rounding of the start lets no face decide by itself: the own face never counts,
/// and a face within start_margin s u M of the start is not passed outward. Not inlined, so its arguments are by value.
template <class Real>
CISTULA_NOINLINE EntryBeside<Real> entry_beside(const SceneView<Real>& scene, uint32_t index, uint32_t own_face,
                                                Vec3<Real> origin, Vec3<Real> direction, Real slack) {
    const Solid& solid = scene.solids[index];
    EntryBeside<Real> entry{-RealTraits<Real>::infinity, RealTraits<Real>::infinity, no_face};
    Real farthest = -RealTraits<Real>::infinity;
    uint32_t entered_before = no_face;
    uint32_t entered = no_face;
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        Slab<Real> slab = scene.slabs[solid.first_slab + i];
        for (uint32_t side = 0; side < 2; ++side) {
            if (side == 0 && slab.low == -RealTraits<Real>::infinity) continue;
            const HalfSpace<Real> half = HalfSpace<Real>::of(slab, side);
            const Real slope = dot(half.normal, direction);
            const Real out = half.outside(origin);
            if (2 * i + side == own_face) {
                if (slope > Real(0)) return {};
            } else {
                const bool leaves_at_start = out >= -start_margin<Real> * slack && !(slope < Real(0));
                if (leaves_at_start) return {};
                if (slope < Real(0) && out > farthest) {
                    farthest = out;
                    entered_before = 2 * i + side;
                }
            }
        }
        if (own_face == 2 * i) slab.low = -RealTraits<Real>::infinity;
        if (own_face == 2 * i + 1) slab.high = RealTraits<Real>::infinity;
        Real enter, leave;
        cross_slab(slab.normal, slab.low, slab.high, origin, direction, enter, leave);
        if (enter > entry.enter) {
            entry.enter = enter;
            entered = leaving_face(i, dot(slab.normal, direction)) ^ 1u;
        }
        entry.leave = min_no_nan(leave, entry.leave);
    }
    if (!(entry.enter <= entry.leave && entry.leave > Real(0))) return {};
    entry.face = entry.enter < Real(0) ? entered_before : entered;
    return entry;
}

}  // namespace cistula
