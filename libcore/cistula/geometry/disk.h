// Disks, and planes without end, which are large ones (docs/rules.md, 18): sheets on shared planes that lie in no tree.
// Every query tests them all.
#pragma once

#include "cistula/geometry/triangle.h"

namespace cistula {

/// Whether rays of a kernel may meet disks. A ConstantScene has none.
template <class E, class Media>
inline constexpr bool meets_disks = E::has(effect_planes) && Media::contacts;

/// Whether places are farther from the scene's center than rays start by rounding: beyond the sphere of radius 2 M.
template <class Real>
CISTULA_INLINE MaskOf<Real> is_beyond(ScalarOf<Real> extent, const Vec3<Real>& place) {
    return dot(place, place) > Real(ScalarOf<Real>(4.5) * extent * extent);
}

/// By how much slack grows where rays meet planes far away: 1 in the scene, 2^60 at most.
template <class Real>
CISTULA_INLINE Real far_factor(ScalarOf<Real> extent, const Vec3<Real>& place) {
    using T = ScalarOf<Real>;
    const MaskOf<Real> beyond = is_beyond(extent, place);
    if (!any(beyond)) return Real(1);
    const Real size = length(place * Real(T(0x1p-32))) * Real(T(0x1p32) / extent);  // whose square may be too large
    return select(beyond, min_or_second(size, Real(T(0x1p60))), Real(1));
}

/// Moves the start of rays beyond the sphere of radius 2 M to where they enter it, if they do, and returns by how much.
/// `after` then says that disks are met from -moved on.
template <class E, class Real, class Media, class Scene>
CISTULA_INLINE Real start_near(const Scene& scene, Ray<Real, Media>& ray) {
    Real moved(0);
    if constexpr (meets_disks<E, Media>) {
        if (scene.disks.empty()) return moved;
        using Wide = WideOf<Real>;
        const ScalarOf<Real> extent = scene.extent;
        const MaskOf<Real> far = is_beyond(extent, ray.origin) & is_finite(ray);
        if (!any(far)) return moved;
        const Vec3<Wide> origin(Wide(ray.origin.x), Wide(ray.origin.y), Wide(ray.origin.z));
        const Vec3<Wide> direction(Wide(ray.direction.x), Wide(ray.direction.y), Wide(ray.direction.z));
        const Wide ahead = -dot(origin, direction);
        const Vec3<Wide> closest = along(origin, ahead, direction);
        const Wide rest = Wide(4 * double(extent) * double(extent)) - dot(closest, closest);
        const MaskOf<Real> enters = far & narrowed<Real>((rest > Wide(0.0)) & (ahead > Wide(0.0)));
        if (!any(enters)) return moved;
        const Wide way = ahead - square_root(max_or_second(rest, Wide(0.0)));
        const Vec3<Wide> start = along(origin, way, direction);
        assign_where(enters, ray.origin, Vec3<Real>(Real(start.x), Real(start.y), Real(start.z)));
        assign_where(enters, moved, Real(way));
        assign_where(enters, ray.after.t, Real(-1) - moved);
    }
    return moved;
}

/// The t from which on rays meet anything: 0 or, of those that start_near() moved, where they started before; that of
/// the last crossing, if there is one.
template <class Real, class Media>
CISTULA_INLINE Real begin_of(const Ray<Real, Media>& ray) {
    return select(ray.after.key == KeyOf<Real>(0), min_or_second(ray.after.t + Real(1), Real(0)), ray.after.t);
}

/// Where rays cross a disk, at t. `at` is that place.
template <class Real, class Media, class Scene>
CISTULA_INLINE MaskOf<Real> cross_disk(const Scene& scene, const Disk<ScalarOf<Real>>& disk,
                                       const Ray<Real, Media>& ray, Real& t, Vec3<Real>& at) {
    const MaskOf<Real> starts_there = ray.from_plane == disk.plane;
    if (all(starts_there)) return !starts_there;
    t = plane_time(scene.shared_planes[disk.plane], ray.origin, ray.direction, Real(-RealTraits<Real>::infinity));
    const Solid& solid = scene.solids[disk.solid];
    if (is_sheet_near_ball(solid)) t = time_near_ball(scene, solid, t, ray);
    at = along(ray.origin, t, ray.direction);
    const Vec3<Real> off = at - spread<Real>(disk.center);
    const Real slope = magnitude(dot(spread<Real>(scene.shared_planes[disk.plane].normal), ray.direction));
    const MaskOf<Real> on = (dot(off, off) <= Real(disk.square)) | (slope >= Real(disk.least_slope));
    return (!starts_there) & (t >= begin_of(ray)) & on;
}

/// Takes crossings of disks as `best` if they are the rays' next, where `active` holds.
template <class E, class Real, class Media, class Scene>
CISTULA_INLINE void closest_disk(const Scene& scene, const MaskOf<Real>& active, const Ray<Real, Media>& ray,
                                 Hit<Real>& best) {
    if constexpr (meets_disks<E, Media>)
        for (uint32_t i = 0; i < scene.disks.size; ++i) {
            const Disk<ScalarOf<Real>>& disk = scene.disks[i];
            Real t;
            Vec3<Real> at;
            const MaskOf<Real> meets = active & cross_disk(scene, disk, ray, t, at);
            if (!any(meets)) continue;
            const KeyOf<Real> key = KeyFormat<Real>::make(CrossingKind::sheet, disk.solid, disk.face);
            const MaskOf<Real> first = meets & ray.after.before(t, key) & best.improves(t, key);
            if (!any(first)) continue;
            const Vec3<Real> normal = spread<Real>(scene.shared_planes[disk.plane].normal);
            best.take(first, t, key, dot(spread<Real>(disk.axes[0]), at) + Real(disk.shift[0]),
                      dot(spread<Real>(disk.axes[1]), at) + Real(disk.shift[1]), 0,
                      dot(normal, ray.direction) < Real(0));
        }
}

}  // namespace cistula
