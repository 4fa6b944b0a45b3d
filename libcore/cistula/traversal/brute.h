// Brute-force intersection, a loop over all primitives: the reference for all other intersectors, and the fastest one
// for few primitives.
#pragma once

#include "cistula/shading/shadow.h"

namespace cistula {

/// Whether a primitive is a convex solid; a constant where only one kind of primitive is compiled in.
template <class E, class Scene>
CISTULA_INLINE bool is_solid(const Scene& scene, uint32_t primitive) {
    return E::solids && (!E::triangles || primitive < scene.convex.size);
}

/// The exact test of one primitive against a ray; trees and Embree only choose the primitives to test.
template <class E = Effects<all_effects>, class Real, class Media, class Scene>
CISTULA_INLINE void closest_primitive(const Scene& scene, uint32_t primitive, const Ray<Real, Media>& ray,
                                      const TriangleRay<Real>& triangle_ray, Hit<Real>& best) {
    if (is_solid<E>(scene, primitive))
        closest_convex<E>(scene, scene.convex[primitive], ray, best);
    else
        closest_cluster(scene, primitive - scene.convex.size, ray, triangle_ray, best);
}

template <class Real, class E, class Media, class Scene>
CISTULA_INLINE void shadow_primitive(const Scene& scene, uint32_t primitive, const ShadowRay<Real, Media>& shadow,
                                     const TriangleRay<Real>& triangle_ray, ShadowSum<E>& sum) {
    if (is_solid<E>(scene, primitive))
        shadow_convex<Real, E>(scene, scene.convex[primitive], shadow, sum);
    else
        shadow_cluster<Real, E>(scene, primitive - scene.convex.size, shadow, triangle_ray, sum);
}

template <class Real, class MediaKind = InteriorList, class SceneKind = SceneView<Real>>
struct BruteIntersector {
    using Media = MediaKind;
    using Scene = SceneKind;
    const Scene& scene;
    /// Mask of the primitives (numbered as in ShadowPlan) of a ConstantScene that primary rays may meet in a part of
    /// the picture, as long as they go straight on.
    uint32_t in_view = ~0u;

    /// The hit with the smallest (t, key) after ray.after.
    template <class E = Effects<all_effects>>
    CISTULA_INLINE Hit<Real> closest(const Ray<Real, Media>& ray) const {
        Hit<Real> best;
        // With t = -1 a ray that is not finite finds nothing; a separate branch would make the warp diverge.
        best.t = is_finite(ray) ? RealTraits<Real>::infinity : Real(-1);
        closest_disk<E>(scene, is_finite(ray), ray, best);
        find_closest<E>(ray, best);
        if (!best.found()) best.t = RealTraits<Real>::infinity;
        return best;
    }

    /// The share of the light's intensity that reaches the ray's origin.
    template <class E>
    CISTULA_INLINE Throughput<Real, E> transmittance(const ShadowRay<Real, Media>& shadow) const {
        ShadowSum<E> sum;
        sum.opaque = is_finite(shadow.ray) ? 0u : 7u;
        shadow_start<Real, E>(scene, shadow, sum);
        if constexpr (Media::contacts) {
            for (uint32_t i = 0; E::solids && i < scene.convex.size && !sum.is_blocked(); ++i)
                shadow_convex<Real, E>(scene, scene.convex[i], shadow, sum);
            for (uint32_t i = 0; E::triangles && i < scene.clusters.size && !sum.is_blocked(); ++i)
                if (!misses_flat_sheet(scene, i, shadow.ray, shadow.distance)) add_cluster(i, shadow, sum);
        } else {
            const uint32_t light = uint32_t(shadow.light - scene.lights.data);
            const uint32_t from = shadow.ray.from_solid;
            const uint32_t near = from == no_solid ? ~0u : scene.plan.near[from][light];
            if constexpr (E::solids) add_planned_solids(near, light, shadow, sum);
            if constexpr (E::triangles) add_planned_clusters(near, shadow, sum);
        }
        return sum.template transmittance<Real>(scene);
    }

  private:
    template <class E>
    CISTULA_INLINE void find_closest(const Ray<Real, Media>& ray, Hit<Real>& best) const {
        if constexpr (E::solids)
            if (closest_solid<E>(ray, best)) return;
        if constexpr (!E::triangles) {
        } else if constexpr (Media::contacts) {
            for (uint32_t i = 0; i < scene.clusters.size; ++i) closest_in_cluster(i, ray, best);
        } else {
            for (uint32_t left = ahead_of(ray) & scene.plan.all_clusters; left != 0; left &= left - 1)
                closest_in_cluster(lowest_bit(left) - scene.plan.first_cluster, ray, best);
        }
    }

    /// Computes the shear for each cluster, of which there are few: a variable that only some paths set would hold
    /// registers on all.
    CISTULA_INLINE void closest_in_cluster(uint32_t i, const Ray<Real, Media>& ray, Hit<Real>& best) const {
        if (!misses_flat_sheet(scene, i, ray, best.t))
            closest_triangles(scene, i, ray, TriangleRay<Real>::of(ray.origin, ray.direction), best);
    }

    CISTULA_INLINE uint32_t ahead_of(const Ray<Real, Media>& ray) const {
        return ray.from_solid == no_solid ? in_view : ~0u;
    }

    /// Tests the convex solids. True if the search is over: the ray leaves a solid that nothing else touches.
    template <class E>
    CISTULA_INLINE bool closest_solid(const Ray<Real, Media>& ray, Hit<Real>& best) const {
        if constexpr (Media::contacts) {
            if (closest_enclosed<E>(scene, ray, best)) return true;
            for (const uint32_t index : scene.convex) closest_convex<E>(scene, index, ray, best);
        } else {
            const uint32_t around = E::has(effect_insides) ? ray.media.only() : no_solid;
            if constexpr (E::has(effect_insides)) {
                if (around != no_solid) closest_exit(scene, around, ray, best);
                if (around != no_solid && scene.solids[around].isolated) return true;
            }
            for (uint32_t left = ahead_of(ray) & scene.plan.all_convex; left != 0; left &= left - 1) {
                const auto& next = scene.convex[lowest_bit(left)];
                // One condition instead of several branches, so that all values are loaded at once.
                if ((next.index != around) & (next.index != ray.from_solid) &
                    !misses_bounds(next.sphere, ray.origin, ray.direction, best.t))
                    closest_entry(scene, next.index, next.solid, ray, best);
            }
        }
        return false;
    }

    template <class E>
    CISTULA_INLINE void add_planned_clusters(uint32_t near, const ShadowRay<Real, Media>& shadow,
                                             ShadowSum<E>& sum) const {
        for (uint32_t left = near & scene.plan.all_clusters; left != 0 && !sum.is_blocked(); left &= left - 1) {
            const uint32_t i = lowest_bit(left) - scene.plan.first_cluster;
            if (!misses_flat_sheet(scene, i, shadow.ray, shadow.distance)) add_cluster(i, shadow, sum);
        }
    }

    /// Adds the solids in the mask `near`, and the one around the ray.
    template <class E>
    CISTULA_INLINE void add_planned_solids(uint32_t near, uint32_t light, const ShadowRay<Real, Media>& shadow,
                                           ShadowSum<E>& sum) const {
        const uint32_t around = E::has(effect_insides) ? shadow.ray.media.only() : no_solid;
        const uint32_t from = shadow.ray.from_solid;
        if constexpr (E::has(effect_insides))
            if (around != no_solid) {
                // Only for rays that start on the solid's own face: others may start slightly off theirs.
                if (!E::has(effect_absorption) && from == around && (scene.plan.beyond[light] >> around & 1u) != 0)
                    sum.cross(scene.materials[scene.solids[around].material]);
                else
                    shadow_exit<Real, E>(scene, around, shadow, sum);
            }
        for (uint32_t left = near & scene.plan.all_convex; left != 0 && !sum.is_blocked(); left &= left - 1) {
            const auto& next = scene.convex[lowest_bit(left)];
            if ((next.index != around) & (next.index != from) &
                !misses_bounds(next.sphere, shadow.ray.origin, shadow.ray.direction, shadow.distance))
                shadow_entry<Real, E>(scene, next.index, next.solid, shadow, sum);
        }
    }

    template <class E>
    CISTULA_INLINE void add_cluster(uint32_t i, const ShadowRay<Real, Media>& shadow, ShadowSum<E>& sum) const {
        shadow_triangles<Real, E>(scene, i, shadow, TriangleRay<Real>::of(shadow.ray.origin, shadow.ray.direction),
                                  sum);
    }
};

}  // namespace cistula
