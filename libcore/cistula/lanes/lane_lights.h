// Visible lights and rays in lanes.
#pragma once

#include "cistula/lanes/convex_lanes.h"
#include "cistula/lights/visible_light.h"

namespace cistula {

/// Rays that may come within `reach` of two faces of a solid at once between `from` and `to`: nears_edge() in lanes.
template <class Real, class Scene>
CISTULA_INLINE MaskOf<Real> near_edges(const Scene& scene, const Solid& solid, ScalarOf<Real> reach,
                                       const Vec3<Real>& origin, const Vec3<Real>& direction, Real from, Real to) {
    Real past[most_slabs_of_edge_lights], soon[most_slabs_of_edge_lights];
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        const Slab<ScalarOf<Real>>& slab = scene.slabs.data[solid.first_slab + i];
        const Vec3<Real> normal = spread<Real>(slab.normal);
        const Real slope = dot(normal, direction);
        const Real no = dot(normal, origin);
        constexpr auto least = ScalarOf<Real>(0x1p-60);
        const Real inverse = reciprocal(select(magnitude(slope) < least, Real(least), slope));
        const Real at_low = (slab.low - no) * inverse;
        const Real at_high = (slab.high - no) * inverse;
        const Real half = reach * magnitude(inverse);
        const Real in = min_no_nan(at_low, at_high);
        const Real out = max_no_nan(at_low, at_high);
        past[i] = in + half;
        soon[i] = out - half;
        from = max_or_second(in - half, from);
        to = min_or_second(out + half, to);
    }
    MaskOf<Real> near = from <= to;
    if (!any(near)) return near;
    MaskOf<Real> entering = false;
    MaskOf<Real> two_entering = false;
    MaskOf<Real> leaving = false;
    MaskOf<Real> two_leaving = false;
    Real first = to;
    Real last = from;
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        const MaskOf<Real> enters = past[i] >= from;
        const MaskOf<Real> leaves = soon[i] <= to;
        two_entering |= entering & enters;
        entering |= enters;
        two_leaving |= leaving & leaves;
        leaving |= leaves;
        first = min_or_second(soon[i], first);
        last = max_or_second(past[i], last);
    }
    near &= two_entering | two_leaving | (entering & leaving);
    assign_where(!two_entering, from, max_or_second(first, from));
    assign_where(!two_leaving, to, min_or_second(last, to));
    return near & (from <= to);
}

/// Rays that may meet a visible light between `from` and `to`.
template <class Real, class Media, class Scene>
CISTULA_INLINE MaskOf<Real> may_hit_visible_lights(const Scene& scene, const Ray<Real, Media>& ray,
                                                   const MaskOf<Real>& active, const Real& from, const Real& to) {
    if (scene.slab_groups.empty() || scene.slab_groups[0].light_reach == RealTraits<Real>::infinity) return active;
    MaskOf<Real> may = false;
    for (const IndexedSolid<ScalarOf<Real>>& entry : scene.convex_copies) {
        if (is_ball(entry.solid)) continue;
        const SlabGroup<ScalarOf<Real>>& group = scene.slab_groups[entry.solid.first_group];
        const Vec3<Real> to_center = spread<Real>(entry.sphere.center) - ray.origin;
        const Real ahead = dot(to_center, ray.direction);
        const Real rest = dot(to_center, to_center) - group.light_square;
        const Real nearest = clamped(ahead, from, to);
        const MaskOf<Real> passes = rest > nearest * (Real(2) * ahead - nearest);
        const MaskOf<Real> left = active & !may & !passes;
        if (any(left))
            may |= left & near_edges(scene, entry.solid, group.light_reach, ray.origin, ray.direction, from, to);
    }
    return may;
}

/// The nearest visible light at or after ray.after and before the limit, where `active` holds.
template <class T, int n, class Media, class Scene>
CISTULA_INLINE VisibleLightHit<Lanes<T, n>> closest_visible_light(const Scene& scene,
                                                                  const Ray<Lanes<T, n>, Media>& ray,
                                                                  const Lanes<T, n>& limit,
                                                                  const MaskOf<Lanes<T, n>>& active) {
    using Real = Lanes<T, n>;
    VisibleLightHit<Real> best;
    best.t = limit;
    MaskOf<Real> asked = active & is_finite(ray);
    if (scene.visible_light_tree.empty()) {
        best.t = select(asked, limit, Real(-1));
        for (uint32_t i = 0; i < scene.visible_lights.size; ++i) intersect_visible_light(scene, i, ray, best);
        return best;
    }
    asked = may_hit_visible_lights(scene, ray, asked, max_or_second(ray.after.t, Real(0)), limit);
    for_each_lane(asked, [&](int lane) {
        const VisibleLightHit<T> one = closest_visible_light(scene, lane_of(ray, lane), limit[lane]);
        best.t.set(lane, one.t);
        best.light.set(lane, int32_t(one.light == no_light ? best.none : one.light));
    });
    return best;
}

/// The radiances of a sky that rays in lanes end on, where `active` holds.
template <class T, int n, class Scene>
CISTULA_NOINLINE Vec3<Lanes<T, n>> sky_radiance(const Scene& scene, const Vec3<Lanes<T, n>>& directions,
                                                const MaskOf<Lanes<T, n>>& active) {
    LaneVectors<Lanes<T, n>> radiances(Vec3<Lanes<T, n>>(Lanes<T, n>(T(0))));
    for_each_lane(active, [&](int lane) { radiances.set(lane, sky_radiance(scene, lane_of(directions, lane))); });
    return radiances.all();
}

}  // namespace cistula
