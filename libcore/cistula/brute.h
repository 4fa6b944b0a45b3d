// The plain loop over all primitives: the oracle, and the fastest way where there are few.
#pragma once

#include "cistula/shadow.h"

namespace cistula {

/// The exact test of one primitive against one ray; trees and Embree only choose which ones to call it on.
template <class Real, class Media, class Scene>
CISTULA_INLINE void closest_primitive(const Scene& scene, uint32_t primitive, const Ray<Real, Media>& ray,
                                      const TriangleRay<Real>& triangle_ray, Hit<Real>& best) {
    if (primitive < scene.convex.size)
        closest_convex(scene, scene.convex[primitive], ray, best);
    else
        closest_cluster(scene, primitive - scene.convex.size, ray, triangle_ray, best);
}

template <class Real, class E, class Media, class Scene>
CISTULA_INLINE void shadow_primitive(const Scene& scene, uint32_t primitive, const ShadowRay<Real, Media>& shadow,
                                     const TriangleRay<Real>& triangle_ray, ShadowSum& sum) {
    if (primitive < scene.convex.size)
        shadow_convex<Real, E>(scene, scene.convex[primitive], shadow, sum);
    else
        shadow_cluster<Real, E>(scene, primitive - scene.convex.size, shadow, triangle_ray, sum);
}

template <class Real, class MediaKind = MediaList, class SceneKind = SceneView<Real>>
struct BruteIntersector {
    using Media = MediaKind;
    using Scene = SceneKind;
    const Scene& scene;

    /// The least (t, key) after ray.after that the primitive tests accept.
    CISTULA_INLINE Hit<Real> closest(const Ray<Real, Media>& ray) const {
        Hit<Real> best;
        if (!is_finite(ray)) return best;
        if constexpr (Media::contacts) {
            if (closest_enclosed(scene, ray, best)) return best;
            for (const uint32_t index : scene.convex) closest_convex(scene, index, ray, best);
        } else {
            const uint32_t around = ray.media.only();
            if (around != no_solid) closest_exit(scene, around, ray, best);
            if (around != no_solid && scene.solids[around].alone) return best;
            for (uint32_t i = 0; i < scene.convex.size; ++i) {
                const NumberedSolid& next = scene.convex[i];
                // All conditions in one, so that their values are waited for but once.
                if ((next.index != around) & (next.index != ray.from_solid) &
                    !passes_by(next.solid, ray.origin, ray.direction, best.t))
                    closest_entry(scene, next.index, next.solid, ray, best);
            }
        }
        // The shear anew for each of the few: a variable that only some paths set would hold registers on all of them.
        for (uint32_t i = 0; i < scene.clusters.size; ++i)
            if (!misses_flat(scene, i, ray, best.t))
                closest_cluster(scene, i, ray, TriangleRay<Real>::of(ray.origin, ray.direction), best);
        return best;
    }

    /// The share of the light's intensity that reaches the ray's origin, per channel.
    template <class E>
    CISTULA_INLINE Vec3<Real> transmittance(const ShadowRay<Real, Media>& shadow) const {
        ShadowSum sum;
        if (!is_finite(shadow.ray)) return Vec3<Real>(Real(0));
        shadow_start<Real, E>(scene, shadow, sum);
        if constexpr (Media::contacts) {
            for (uint32_t i = 0; i < scene.convex.size && !sum.dark(); ++i)
                shadow_convex<Real, E>(scene, scene.convex[i], shadow, sum);
            for (uint32_t i = 0; i < scene.clusters.size && !sum.dark(); ++i)
                if (!misses_flat(scene, i, shadow.ray, shadow.distance))
                    shadow_cluster<Real, E>(scene, i, shadow,
                                            TriangleRay<Real>::of(shadow.ray.origin, shadow.ray.direction), sum);
        } else {
            const uint32_t light = uint32_t(shadow.light - scene.lights.data);
            const uint32_t around = shadow.ray.media.only(), from = shadow.ray.from_solid;
            if (around != no_solid) {
                // From its own face, as lines from other faces may start a little off theirs.
                if (!E::has(effect_absorption) && from == around && (scene.plan.beyond[light] >> around & 1u) != 0)
                    sum.cross<E>(scene.materials[scene.solids[around].material]);
                else
                    shadow_exit<Real, E>(scene, around, shadow, sum);
            }
            const uint32_t near = from == no_solid ? ~0u : scene.plan.near[from][light];
            for (uint32_t left = near & scene.plan.all_convex; left != 0 && !sum.dark(); left &= left - 1) {
                const NumberedSolid& next = scene.convex[lowest_bit(left)];
                if ((next.index != around) & (next.index != from) &
                    !passes_by(next.solid, shadow.ray.origin, shadow.ray.direction, shadow.distance))
                    shadow_entry<Real, E>(scene, next.index, next.solid, shadow, sum);
            }
            for (uint32_t left = near & scene.plan.all_clusters; left != 0 && !sum.dark(); left &= left - 1) {
                const uint32_t i = lowest_bit(left) - scene.plan.first_cluster;
                if (!misses_flat(scene, i, shadow.ray, shadow.distance))
                    shadow_cluster<Real, E>(scene, i, shadow,
                                            TriangleRay<Real>::of(shadow.ray.origin, shadow.ray.direction), sum);
            }
        }
        return sum.template share<E, Real>();
    }
};

}  // namespace cistula
