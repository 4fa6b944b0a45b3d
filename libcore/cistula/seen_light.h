// Lights that are seen: spheres of constant radiance that end a ray and cast no shadow.
#pragma once

#include "cistula/bvh.h"

namespace cistula {

inline constexpr uint32_t no_light = 0xffffffffu;

template <class Real>
struct SeenHit {
    Real t = RealTraits<Real>::infinity;
    uint32_t light = no_light;
};

/// The front of one sphere, by the ray's closest approach (Haines et al., Ray Tracing Gems, ch. 7). From inside: nothing.
template <class Real, class Media, class Scene>
CISTULA_INLINE void see_light(const Scene& scene, uint32_t index, const Ray<Real, Media>& ray, SeenHit<Real>& best) {
    const SeenLight<Real>& light = scene.seen_lights[index];
    const Vec3<Real> to_center = light.center - ray.origin;
    const Real b = dot(to_center, ray.direction);
    const Vec3<Real> across = to_center - b * ray.direction;
    const Real square = light.radius * light.radius;
    const Real discriminant = square - dot(across, across), c = dot(to_center, to_center) - square;
    if (!(discriminant > Real(0)) || !(c > Real(0)) || !(b > Real(0))) return;
    const Real t = c / (b + square_root(discriminant));
    if (t >= ray.after.t && (t < best.t || (t == best.t && index < best.light))) best = {t, index};
}

/// A part of a line; from > to: none.
template <class Real>
struct Window {
    Real from, to;

    CISTULA_INLINE bool empty() const { return !(from <= to); }
};

/// Where a line, within `window`, may be within `reach` of two planes of a convex solid at once and so near an edge: not
/// less. Half-spaces that are moved in or out by `reach` tell when it comes near each plane and when it leaves it.
template <class Real, class Scene>
CISTULA_INLINE Window<Real> near_edges(const Scene& scene, const Solid& solid, const Vec3<Real>& origin,
                                       const Vec3<Real>& direction, Real reach, const Window<Real>& window) {
    constexpr Real infinity = RealTraits<Real>::infinity;
    // Of entering planes when the first is near, and when the last two are no longer; of leaving planes the reverse.
    Real enters = -infinity, entered = -infinity, entered_before = -infinity;
    Real left = infinity, leaves = infinity, leaves_after = infinity;
    Real slope = Real(1);
    const Slab<Real>* slabs = scene.slabs.data + solid.first_slab;
#if CISTULA_ON_DEVICE
#pragma unroll 1
#endif
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        const Slab<Real>& slab = slabs[i];
        const Real nd = dot(slab.normal, direction), no = dot(slab.normal, origin), inverse = reciprocal(nd);
        const Real at_low = (slab.low - no) * inverse, at_high = (slab.high - no) * inverse;
        const Real near = reach * magnitude(inverse);
        const Real first = lesser(at_low, at_high), last = greater(at_low, at_high);
        slope = lesser(slope, magnitude(nd));
        enters = greater(enters, first - near);
        entered_before = greater(entered_before, lesser(entered, first + near));
        entered = greater(entered, first + near);
        left = lesser(left, last + near);
        leaves_after = lesser(leaves_after, greater(leaves, last - near));
        leaves = lesser(leaves, last - near);
    }
    if (slope < Real(0x1p-60)) return window;  // beside a plane all the way, perhaps
    Window<Real> found{infinity, -infinity};
    if (!(enters <= left)) return found;
    const auto widen = [&](Real from, Real to) {
        const Window<Real> part{greatest(from, window.from), least(to, window.to)};
        if (!part.empty()) found = {least(found.from, part.from), greatest(found.to, part.to)};
    };
    widen(enters, entered_before);
    widen(leaves_after, left);
    widen(leaves, entered);
    return found;
}

/// The same for the lights of a group: all of `window` where they are anywhere.
template <class Real, class E, class Media, class Scene>
CISTULA_INLINE Window<Real> near_lights(const Scene& scene, const SeenGroup& group, const Ray<Real, Media>& ray,
                                        const Window<Real>& window) {
    if (passes_by(group, ray.origin, ray.direction, window.to)) return {Real(1), Real(0)};
    if constexpr (E::has(effect_solids))
        if (group.solid != no_solid)
            return near_edges(scene, scene.solids[group.solid], ray.origin, ray.direction, Real(group.reach), window);
    return window;
}

/// The nearest seen light at or after ray.after and before t_limit.
template <class Real, class E = Effects<all_effects>, class Media, class Scene>
CISTULA_INLINE SeenHit<Real> closest_seen_light(const Scene& scene, const Ray<Real, Media>& ray, Real t_limit) {
    SeenHit<Real> best;
    best.t = t_limit;
    if (!is_finite(ray)) return best;
    for (uint32_t g = 0; g < scene.seen_groups.size; ++g) {
        const SeenGroup& group = scene.seen_groups[g];
        // As far as rounding may be off.
        const Window<Real> whole{Real(tree_near(ray.after.t)), Real(tree_far(best.t))};
        const Window<Real> window = near_lights<Real, E>(scene, group, ray, whole);
        if (window.empty()) continue;
        if (group.root < 0) {
            for (uint32_t i = 0; i < group.count; ++i) see_light(scene, group.first + i, ray, best);
            continue;
        }
        BoxRay box_ray = BoxRay::of(ray.origin, ray.direction);
        box_ray.near_limit = tree_near(window.from);
        box_ray.far_limit = tree_far(window.to);
        const float far_limit = box_ray.far_limit;
        walk_tree(
            scene.seen_tree, scene.seen_items, box_ray,
            [&](uint32_t light) {
                see_light(scene, light, ray, best);
                return least(far_limit, tree_far(best.t));
            },
            group.root);
    }
    return best;
}

}  // namespace cistula
