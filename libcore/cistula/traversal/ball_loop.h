// The loop over a BallScene, in which rays are inside one solid at most.
#pragma once

#include "cistula/traversal/brute.h"

namespace cistula {

template <class Real>
struct BallIntersector {
    using Media = SingleInterior;
    using Scene = BallScene<Real>;
    static constexpr bool few_are_lit = true;  // surfaces: RayTree::trace_together
    const Scene& scene;

    /// The hit with the smallest (t, key) after ray.after.
    template <class E = Effects<all_effects>>
    CISTULA_INLINE Hit<Real> closest(const Ray<Real, Media>& ray) const {
        Hit<Real> best;
        // With t = -1 a ray that is not finite finds nothing; a separate branch would make the warp diverge.
        best.t = is_finite(ray) ? RealTraits<Real>::infinity : Real(-1);
        const uint32_t around = ray.media.only();
        if (around != no_solid) closest_convex<E>(scene, around, ray, best);
        if (around == no_solid || scene.solids[around].isolated == 0) closest_outside<E>(around, ray, best);
        if (!best.found()) best.t = RealTraits<Real>::infinity;
        return best;
    }

    /// The share of the light's intensity that reaches the ray's origin.
    template <class E>
    CISTULA_INLINE Throughput<Real, E> transmittance(const ShadowRay<Real, Media>& shadow) const {
        ShadowSum<E> sum;
        sum.opaque = is_finite(shadow.ray) ? 0u : 7u;
        const uint32_t around = shadow.ray.media.only();
        if (around != no_solid) shadow_convex<Real, E>(scene, around, shadow, sum);
        for (uint32_t i = 0; i < scene.spheres.size && !sum.is_blocked(); ++i) {
            const auto& sphere = scene.spheres[i];
            const auto chord =
                BallChord<Real>::of(sphere.center, sphere.square, shadow.ray.origin, shadow.ray.direction);
            if (!(chord.square > Real(0))) continue;  // most lines miss it
            if (const uint32_t ball = scene.sphere_solids[i]; ball != around)
                shadow_ball<E>(scene, ball, shadow, false, true, sum);
        }
        for (uint32_t i = 0; i < scene.bodies.size && !sum.is_blocked(); ++i)
            if (scene.bodies[i] != around) shadow_convex<Real, E>(scene, scene.bodies[i], shadow, sum);
        for (uint32_t i = 0; i < scene.planes.size && !sum.is_blocked(); ++i)
            if (!misses_flat_sheet(scene, i, shadow.ray, shadow.distance))
                shadow_triangles<Real, E>(scene, i, shadow,
                                          TriangleRay<Real>::of(shadow.ray.origin, shadow.ray.direction), sum);
        return sum.template transmittance<Real>(scene);
    }

  private:
    /// What a ray meets beside the solid `around` it, if any.
    template <class E>
    CISTULA_INLINE void closest_outside(uint32_t around, const Ray<Real, Media>& ray, Hit<Real>& best) const {
        closest_ball_ahead(around, ray, best);
        for (const uint32_t body : scene.bodies)
            if (body != around) closest_convex<E>(scene, body, ray, best);
        for (uint32_t i = 0; i < scene.planes.size; ++i)
            if (!misses_flat_sheet(scene, i, ray, best.t))
                closest_triangles(scene, i, ray, TriangleRay<Real>::of(ray.origin, ray.direction), best);
    }

    /// The first ball that a ray enters (closest_ball). The loop keeps only which is the nearest.
    CISTULA_INLINE void closest_ball_ahead(uint32_t around, const Ray<Real, Media>& ray, Hit<Real>& best) const {
        const Real least = max_or_second(ray.after.t, Real(0));
        Real nearest = RealTraits<Real>::infinity;
        uint32_t solid = no_solid;
        for (uint32_t i = 0; i < scene.spheres.size; ++i) {
            const auto& sphere = scene.spheres[i];
            const auto chord = BallChord<Real>::of(sphere.center, sphere.square, ray.origin, ray.direction);
            if (!chord.is_ahead) continue;
            const Real half = chord.half();
            const Real t = max_or_second(chord.middle - half, least);
            const uint32_t ball = scene.sphere_solids[i];
            if (!(chord.middle + half > ray.after.t) || !(t < nearest) || ball == around || ball == ray.from_solid)
                continue;
            nearest = t;
            solid = ball;
        }
        if (solid == no_solid) return;
        const uint64_t key = make_key(CrossingKind::enter, solid, 0);
        if (best.improves(nearest, key)) best.take(true, nearest, key, Real(0), Real(0), 0, true);
    }
};

}  // namespace cistula
