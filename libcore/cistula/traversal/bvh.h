// BVH traversal with a float ray that only finds candidates; the primitive tests decide, so that no tree changes a bit
// (docs/rules.md, 1). Used on the GPU; the host runs it in tests.
#pragma once

#include "cistula/traversal/brute.h"

namespace cistula {

/// The ray of box tests: rounded to float, which the padding of the boxes covers. Times are fused products instead of
/// quotients of differences, which adds an error of a few u of the coordinates' size.
struct BoxRay {
    float inverse[3], shift[3];  // see plane_t()
    float near_limit, far_limit;

    template <class Real>
    CISTULA_INLINE static BoxRay of(const Vec3<Real>& origin, const Vec3<Real>& direction) {
        constexpr float least_step = 0x1p-60f;  // keeps times finite if the ray is parallel to a plane
        BoxRay r;
        for (int k = 0; k < 3; ++k) {
            const float step = float(direction[k]);
            r.inverse[k] = reciprocal(magnitude(step) < least_step ? least_step : step);
            r.shift[k] = -float(origin[k]) * r.inverse[k];
        }
        return r;
    }

    /// The time at which x[k] = plane.
    CISTULA_INLINE float plane_t(int k, float plane) const { return fused(plane, inverse[k], shift[k]); }

    /// The time at which the ray enters the box, or infinity.
    CISTULA_INLINE float enter(const float low[3], const float high[3]) const {
        float near_t = near_limit;
        float far_t = far_limit;
        for (int k = 0; k < 3; ++k) {
            const float at_low = plane_t(k, low[k]);
            const float at_high = plane_t(k, high[k]);
            near_t = max_no_nan(min_no_nan(at_low, at_high), near_t);
            far_t = min_no_nan(max_no_nan(at_low, at_high), far_t);
        }
        return near_t <= far_t ? near_t : RealTraits<float>::infinity;
    }
};

/// Outward slack of the limits of a box ray: relative for the rounding of t, absolute for that of the boxes' sides and
/// for contact_reach (triangle.h).
inline constexpr float tree_slack_relative = 0x1p-21f;
inline constexpr float tree_slack_absolute = 0x1p-11f;

template <class Real>
CISTULA_INLINE float tree_far(Real t) {
    return t < Real(0x1p100) ? float(t) * (1.0f + tree_slack_relative) + tree_slack_absolute
                             : RealTraits<float>::infinity;
}
template <class Real>
CISTULA_INLINE float tree_near(Real t) {
    return max_or_second(float(t) * (1.0f - tree_slack_relative) - tree_slack_absolute, 0.0f);
}

/// Calls visit(item) for the candidates of box_ray, nearer boxes first; visit returns the new far limit.
template <class Visit>
CISTULA_INLINE void traverse_tree(const Span<TreeNode>& nodes, const Span<uint32_t>& items, BoxRay box_ray,
                                  const Visit& visit) {
    if (nodes.empty()) return;
    int32_t pending[max_tree_depth + 1];
    int depth = 0;
    int32_t node = 0;
    for (;;) {
        const TreeNode n = nodes[uint32_t(node)];  // copied whole, for wide loads
        const float t0 = box_ray.enter(n.low[0], n.high[0]);
        const float t1 = box_ray.enter(n.low[1], n.high[1]);
        const bool swap = t1 < t0;
        int32_t next = -1;
        int32_t later = -1;
        // Orders the children by selects: an index would force the node into memory.
        for (int i = 0; i < 2; ++i) {
            const bool second = (i == 1) != swap;
            const float t = second ? t1 : t0;
            if (!(t <= box_ray.far_limit) || t == RealTraits<float>::infinity) continue;
            const int32_t child = second ? n.child[1] : n.child[0];
            if (child >= 0) {
                if (next < 0)
                    next = child;
                else
                    later = child;
                continue;
            }
            const uint32_t count = second ? n.count[1] : n.count[0];
            for (uint32_t k = 0; k < count; ++k) box_ray.far_limit = visit(items[uint32_t(~child) + k]);
        }
        if (later >= 0) pending[depth++] = later;
        if (next < 0) {
            if (depth == 0) return;
            next = pending[--depth];
        }
        node = next;
    }
}

template <class Real, class MediaKind = InteriorList, class SceneKind = SceneView<Real>>
struct BvhIntersector {
    using Media = MediaKind;
    using Scene = SceneKind;
    const Scene& scene;

    template <class E = Effects<all_effects>>
    CISTULA_INLINE Hit<Real> closest(const Ray<Real, Media>& ray) const {
        Hit<Real> best;
        if (!is_finite(ray) || (E::has(effect_insides) && closest_enclosed<E>(scene, ray, best))) return best;
        const TriangleRay<Real> triangle_ray = TriangleRay<Real>::of(ray.origin, ray.direction);
        BoxRay box_ray = BoxRay::of(ray.origin, ray.direction);
        box_ray.near_limit = tree_near(ray.after.t);
        closest_disk<E>(scene, true, ray, best);
        box_ray.far_limit = tree_far(best.t);
        const uint32_t left = flat_start(scene, ray);
        traverse_tree(scene.tree, scene.tree_items, box_ray, [&](uint32_t primitive) {
            if (!is_solid<E>(scene, primitive) && !scene.facets.empty())
                closest_facet(scene, primitive - scene.convex.size, ray, triangle_ray, left, best);
            else
                closest_primitive<E>(scene, primitive, ray, triangle_ray, best);
            return tree_far(best.t);
        });
        return best;
    }

    template <class E>
    CISTULA_INLINE Throughput<Real, E> transmittance(const ShadowRay<Real, Media>& shadow) const {
        ShadowSum<E> sum;
        if (!is_finite(shadow.ray)) return Throughput<Real, E>(Real(0));
        shadow_start<Real, E>(scene, shadow, sum);
        const TriangleRay<Real> triangle_ray = TriangleRay<Real>::of(shadow.ray.origin, shadow.ray.direction);
        BoxRay box_ray = BoxRay::of(shadow.ray.origin, shadow.ray.direction);
        box_ray.near_limit = 0.0f;
        box_ray.far_limit = tree_far(shadow.distance);
        const uint32_t left = flat_start(scene, shadow.ray);
        traverse_tree(scene.tree, scene.tree_items, box_ray, [&](uint32_t primitive) {
            if (!is_solid<E>(scene, primitive) && !scene.facets.empty())
                shadow_facet<Real, E>(scene, primitive - scene.convex.size, shadow, triangle_ray, left, sum);
            else
                shadow_primitive<Real, E>(scene, primitive, shadow, triangle_ray, sum);
            return sum.is_blocked() ? -1.0f : tree_far(shadow.distance);
        });
        return sum.template transmittance<Real>(scene);
    }
};

}  // namespace cistula
