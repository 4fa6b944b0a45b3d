// A quick rejection for visible lights along the edges of convex solids, of which there may be hundreds: a ray that is
// nowhere near two faces of one solid at once meets none of them. Used on the host, which tests eight slabs at once; on
// the device it takes as long as traversing the tree over the lights.
#pragma once

#include "cistula/geometry/convex.h"

namespace cistula {

/// The maximum number of solids that are tested, and of slabs of each.
// a bit each
inline constexpr uint32_t most_solids_of_edge_lights = 16;
inline constexpr uint32_t most_slabs_of_edge_lights = 32;

/// Whether a line between `from` and `to` misses the bounding sphere of a solid's edge lights.
template <class Real>
CISTULA_INLINE bool passes_edge_lights(const Solid& solid, Real square, const Vec3<Real>& origin,
                                       const Vec3<Real>& direction, Real from, Real to) {
    const Vec3<Real> to_center = Vec3<Real>(solid.center) - origin;
    const Real ahead = dot(to_center, direction);
    const Real rest = dot(to_center, to_center) - square;
    const Real nearest = clamped(ahead, from, to);
    return rest > nearest * (Real(2) * ahead - nearest);
}

/// A lane mask: bit i is set if a[i] >= limit (lanes_from) or a[i] <= limit (lanes_to).
CISTULA_INLINE uint32_t lanes_from(const float (&a)[slab_lanes], float limit) {
    alignas(32) int32_t is[slab_lanes];
    CISTULA_VECTORS
    for (int i = 0; i < slab_lanes; ++i) is[i] = a[i] >= limit ? -1 : 0;
    return sign_bits(is);
}
CISTULA_INLINE uint32_t lanes_to(const float (&a)[slab_lanes], float limit) {
    alignas(32) int32_t is[slab_lanes];
    CISTULA_VECTORS
    for (int i = 0; i < slab_lanes; ++i) is[i] = a[i] <= limit ? -1 : 0;
    return sign_bits(is);
}

/// Whether a line comes within `reach` of two faces of a solid at once between `from` and `to`, which are narrowed to
/// where it does. The line is near an entering plane up to some t and near a leaving plane from some t on. Single
/// precision suffices for either Real: `reach` exceeds the lights by 2^-14 M, and rounding errors are under 2^-19 M.
template <class Real>
CISTULA_INLINE bool nears_edge(const SlabGroup<Real>* groups, uint32_t slabs, float reach, const Vec3<float>& origin,
                               const Vec3<float>& direction, float& from, float& to) {
    constexpr int most_groups = most_slabs_of_edge_lights / slab_lanes;
    alignas(32) float past[most_groups][slab_lanes], soon[most_groups][slab_lanes];
    const int count = int(slabs + slab_lanes - 1) / slab_lanes;
    for (int g = 0; g < count; ++g) {
        alignas(32) float enter[slab_lanes], leave[slab_lanes];
        const SlabGroup<Real>& group = groups[g];
        CISTULA_LANES
        for (int i = 0; i < slab_lanes; ++i) {
            const Vec3<float> normal(float(group.nx[i]), float(group.ny[i]), float(group.nz[i]));
            const float nd = dot(normal, direction);
            const float no = dot(normal, origin);
            // A line parallel to a slab is near its planes almost everywhere or nowhere.
            const float inverse = 1.0f / (magnitude(nd) < 0x1p-60f ? 0x1p-60f : nd);
            const float at_low = (float(group.low[i]) - no) * inverse;
            const float at_high = (float(group.high[i]) - no) * inverse;
            const float half = reach * magnitude(inverse);
            const float in = min_no_nan(at_low, at_high);
            const float out = max_no_nan(at_low, at_high);
            enter[i] = in - half;
            past[g][i] = in + half;
            soon[g][i] = out - half;
            leave[i] = out + half;
        }
        from = max_or_second(convex_host::greatest_lane(enter), from);
        to = min_or_second(convex_host::least_lane(leave), to);
    }
    if (!(from <= to)) return false;
    // masks of planes near which the line is at `from`, at `to`
    uint32_t entering = 0;
    uint32_t leaving = 0;
    float first = to;
    float last = from;
    for (int g = 0; g < count; ++g) {
        entering |= lanes_from(past[g], from) << g * slab_lanes;
        leaving |= lanes_to(soon[g], to) << g * slab_lanes;
        first = min_or_second(convex_host::least_lane(soon[g]), first);
        last = max_or_second(convex_host::greatest_lane(past[g]), last);
    }
    const bool two_at_first = (entering & (entering - 1)) != 0;
    const bool two_at_last = (leaving & (leaving - 1)) != 0;
    if (!two_at_first && !two_at_last && (entering == 0 || leaving == 0)) return false;
    if (!two_at_first) from = max_or_second(first, from);
    if (!two_at_last) to = min_or_second(last, to);
    return from <= to;
}

/// The solid of an entry of scene.convex, which holds copies or indices.
template <class Real, class Scene>
CISTULA_INLINE const Solid& listed(const Scene&, const IndexedSolid<Real>& copy) {
    return copy.solid;
}
template <class Scene>
CISTULA_INLINE const Solid& listed(const Scene& scene, uint32_t index) {
    return scene.solids[index];
}

/// Whether a ray may meet a visible light between `from` and `to`, which are narrowed to where it may.
template <class Real, class Media, class Scene>
CISTULA_INLINE bool may_hit_visible_lights(const Scene& scene, const Ray<Real, Media>& ray, Real& from, Real& to) {
    if (scene.slab_groups.empty() || scene.slab_groups[0].light_reach == RealTraits<Real>::infinity) return true;
    const Vec3<float> origin(ray.origin), direction(ray.direction);
    const auto near = [&](const Solid& solid, const SlabGroup<Real>& first, Real& near_from, Real& near_to) {
        float first_near = float(near_from);
        float last_near = float(near_to);
        const bool nears =
            nears_edge(&first, solid.slab_count, float(first.light_reach), origin, direction, first_near, last_near);
        near_from = first_near;
        near_to = last_near;
        return nears;
    };
    const bool ends = to < RealTraits<Real>::infinity;  // at a hit; inside a solid, at its exit or before
    if (const uint32_t around = ends ? enclosing(scene, ray) : no_solid;
        around != no_solid && !is_ball(scene.solids[around])) {
        const SlabGroup<Real>& first = scene.slab_groups[scene.solids[around].first_group];
        if (first.lights_apart) return near(scene.solids[around], first, from, to);
    }
    Real earliest = to;
    Real latest = from;
    for (const auto& entry : scene.convex) {
        const Solid& solid = listed(scene, entry);
        if (is_ball(solid)) continue;
        const SlabGroup<Real>& first = scene.slab_groups[solid.first_group];
        Real near_from = from;
        Real near_to = to;
        if (passes_edge_lights(solid, first.light_square, ray.origin, ray.direction, from, to) ||
            !near(solid, first, near_from, near_to))
            continue;
        earliest = min_or_second(near_from, earliest);
        latest = max_or_second(near_to, latest);
    }
    from = earliest;
    to = latest;
    return earliest <= latest;
}

}  // namespace cistula
