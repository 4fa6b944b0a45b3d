// Convex solids as intersections of slabs (Kay and Kajiya 1986), with state in place of epsilons (docs/rules.md, 3): a
// ray inside leaves through the nearest leaving plane, and a ray that has left a solid does not hit it again, whatever
// rounding says about its origin.
#pragma once

#include "cistula/geometry/ball.h"
#include "cistula/geometry/convex_device.h"
#include "cistula/geometry/convex_host.h"
#include "cistula/geometry/shared_plane.h"

namespace cistula {

#if CISTULA_ON_DEVICE
namespace convex_here = convex_device;
#else
namespace convex_here = convex_host;
#endif

/// Bounding sphere test: whether a ray from outside surely misses the solid or meets it only beyond `limit`. A quick
/// rejection that never decides a hit.
template <class Real>
CISTULA_INLINE MaskOf<Real> misses_bounds(const BoundingSphere<ScalarOf<Real>>& sphere, const Vec3<Real>& origin,
                                          const Vec3<Real>& direction, Real limit) {
    const Vec3<Real> to_center = spread<Real>(sphere.center) - origin;
    const Real ahead = dot(to_center, direction);
    const Real rest = dot(to_center, to_center) - sphere.padded_square;
    const Real beyond = limit * (Real(2) * ahead - limit);
    const Real beside = select(ahead < Real(0), Real(0), ahead * ahead);
    return rest > select(ahead > limit, beyond, beside);
}

/// The face of a convex solid on the shared plane on which a ray starts, or no_face.
template <class Real, class Media, class Scene>
CISTULA_INLINE uint32_t face_at_start(const Scene& scene, uint32_t index, const Ray<Real, Media>& ray) {
    if constexpr (Media::contacts)
        if (ray.from_plane != no_plane) return face_on(scene, scene.solids[index], ray.from_plane);
    return no_face;
}

/// The face of a convex solid by which a ray inside it does not leave: that on which the ray starts.
template <class Real, class Media, class Scene>
CISTULA_INLINE uint32_t face_left(const Scene& scene, uint32_t index, const Ray<Real, Media>& ray) {
    return ray.from_solid == index ? ray.from_face : face_at_start(scene, index, ray);
}

/// Takes the crossing at `leave` as `best` if it is less, for rays inside a convex solid. face() gives the face; it is
/// called only if the time does not reject the crossing.
template <class Real, class Face>
CISTULA_INLINE void take_exit(const MaskOf<Real>& inside, uint32_t index, Real leave, const Face& face,
                              Hit<Real>& best) {
    const Real t = max_or_second(leave, Real(0));
    const MaskOf<Real> in_time = inside & (t <= best.t) & (t < RealTraits<Real>::infinity);
    if (!any(in_time)) return;
    const KeyOf<Real> key = KeyFormat<Real>::make(CrossingKind::leave, index, face());
    best.take(in_time & best.improves(t, key), t, key, Real(0), Real(0), 0, false);
}

/// The crossing by which a ray leaves the convex solid that it is inside, if it is less than `best`.
template <class Real, class Media, class Scene>
CISTULA_INLINE void closest_exit(const Scene& scene, uint32_t index, const Ray<Real, Media>& ray, Hit<Real>& best) {
    const Solid& solid = scene.solids[index];
    const uint32_t skipped = face_left(scene, index, ray);
    const auto exit = convex_here::exit_of(scene, solid, ray.origin, ray.direction, skipped);
    take_exit<Real>(
        true, index, exit.t,
        [&] { return convex_here::face_of(scene, solid, ray.origin, ray.direction, exit, skipped); }, best);
}

/// Whether a ray from outside meets the solid. An interval that ends at the ray's origin, to within the rounding of a
/// point on a shared face, is behind it.
template <class Interval, class Real>
CISTULA_INLINE auto is_met(const Interval& interval, Real extent) {
    return (interval.enter <= interval.leave) & (interval.leave > incidence<Real> * extent);
}

/// Takes the crossing at `enter` as `best` if it is less and the ray has not passed it, for rays that meet a convex
/// solid from outside. face() gives the face; it is called only if the time does not reject the crossing.
template <class Real, class Media, class Face>
CISTULA_INLINE void take_entry(const MaskOf<Real>& meets, uint32_t index, Real enter, const Face& face,
                               const Ray<Real, Media>& ray, Hit<Real>& best) {
    const Real t = max_or_second(enter, Real(0));
    const MaskOf<Real> in_time = meets & (t <= best.t) & (t < RealTraits<Real>::infinity) & !(t < ray.after.t);
    if (!any(in_time)) return;
    const KeyOf<Real> key = KeyFormat<Real>::make(CrossingKind::enter, index, face());
    best.take(in_time & ray.after.before(t, key) & best.improves(t, key), t, key, Real(0), Real(0), 0, true);
}

/// The crossing by which a ray enters a convex solid that it is not inside, has not just left and does not pass by.
template <class Real, class Media, class Scene>
CISTULA_INLINE void closest_entry(const Scene& scene, uint32_t index, const Solid& solid, const Ray<Real, Media>& ray,
                                  Hit<Real>& best) {
    const auto interval = convex_here::interval_of(scene, solid, ray.origin, ray.direction, true);
    if (!is_met(interval, scene.extent)) return;
    take_entry<Real>(
        true, index, interval.enter,
        [&] { return convex_here::face_of(scene, solid, ray.origin, ray.direction, interval); }, ray, best);
}

/// The crossing by which a ray enters a convex solid that has a face on the shared plane on which the ray starts.
template <class Real, class Media, class Scene>
CISTULA_INLINE void closest_entry_beside(const Scene& scene, uint32_t index, uint32_t own_face,
                                         const Ray<Real, Media>& ray, Hit<Real>& best) {
    if constexpr (Media::contacts) {
        const EntryBeside<Real> entry =
            entry_beside(scene, index, own_face, ray.origin, ray.direction, scene.shared_planes[ray.from_plane].slack);
        if (entry.face == no_face) return;
        const Real t = max_or_second(entry.enter, Real(0));
        const uint64_t key = make_key(CrossingKind::enter, index, entry.face);
        best.take(ray.after.before(t, key) && best.improves(t, key), t, key, Real(0), Real(0), 0, true);
    }
}

/// The ray's next crossing of a convex solid, if it is less than `best`.
template <class E = Effects<all_effects>, class Real, class Media, class Scene>
CISTULA_HOST_NOINLINE void closest_convex(const Scene& scene, uint32_t index, const Ray<Real, Media>& ray,
                                          Hit<Real>& best) {
    if constexpr (meets_balls<E, Scene>)
        if (is_ball(scene.solids[index])) {
            const bool inside = ray.media.contains(index);
            return closest_ball(scene, index, ray, inside, !inside, best);
        }
    if (ray.media.contains(index))
        closest_exit(scene, index, ray, best);
    else if (const uint32_t own_face = face_at_start(scene, index, ray); own_face != no_face)
        closest_entry_beside(scene, index, own_face, ray, best);
    else if (ray.from_solid != index &&
             !misses_bounds(BoundingSphere<Real>::of(scene.solids[index]), ray.origin, ray.direction, best.t))
        closest_entry(scene, index, scene.solids[index], ray, best);
}

/// The solid around a ray whose next hit is surely that solid's own face, since nothing else is inside it; no_solid for
/// any other ray.
template <class Real, class Media, class Scene>
CISTULA_INLINE uint32_t enclosing(const Scene& scene, const Ray<Real, Media>& ray) {
    const uint32_t solid = ray.media.only();
    return solid != no_solid && scene.solids[solid].isolated ? solid : no_solid;
}

/// The next crossing of a ray for which enclosing() gives a solid; false for any other ray.
template <class E = Effects<all_effects>, class Real, class Media, class Scene>
CISTULA_INLINE bool closest_enclosed(const Scene& scene, const Ray<Real, Media>& ray, Hit<Real>& best) {
    const uint32_t solid = enclosing(scene, ray);
    if (solid == no_solid) return false;
    closest_convex<E>(scene, solid, ray, best);
    return true;
}

/// Whether a point is strictly inside all planes of a convex solid.
template <class Real, class Scene>
CISTULA_HD inline bool inside_convex(const Scene& scene, const Solid& solid, const Vec3<Real>& point) {
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        const Slab<Real>& slab = scene.slabs[solid.first_slab + i];
        const Real n = dot(slab.normal, point);
        if (!(n > slab.low && n < slab.high)) return false;
    }
    return true;
}

/// Whether a camera is inside a convex solid. Of a ball, double decides.
template <class Scene>
CISTULA_HD inline bool is_in_convex(const Scene& scene, const Solid& solid, const Vec3<double>& camera) {
    if constexpr (holds_balls<Scene>)
        if (is_ball(solid)) {
            const auto& ball = scene.balls[solid.first_slab];
            const Vec3<double> off = camera - Vec3<double>(ball.center);
            return dot(off, off) < double(ball.radius) * double(ball.radius);
        }
    return inside_convex(scene, solid, Vec3<typename Scene::Scalar>(camera));
}

}  // namespace cistula
