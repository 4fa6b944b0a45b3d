// The intersector of lanes: a loop over the few primitives of a ConstantScene, like BruteIntersector for one ray.
#pragma once

#include "cistula/lanes/lane_shadow.h"

namespace cistula {

template <class Real>
struct LaneLoop {
    using Scene = ConstantScene<ScalarOf<Real>>;
    using Media = SingleInteriorOf<Real>;
    using Mask = MaskOf<Real>;
    const Scene& scene;
    uint32_t isolated = 0;  // bit i: no other primitive comes near solid i

    explicit LaneLoop(const Scene& of) : scene(of) {
        for (const IndexedSolid<ScalarOf<Real>>& next : scene.convex) isolated |= next.solid.isolated << next.index;
    }

    /// The hits with the smallest (t, key) after ray.after, where `who` holds.
    template <class E>
    CISTULA_NOINLINE Hit<Real> closest(const Ray<Real, Media>& ray, const Mask& who) const {
        Hit<Real> best;
        // With t = -1 a ray that is not finite, or not asked for, finds nothing.
        Mask traced = who & is_finite(ray);
        best.t = select(traced, Real(RealTraits<Real>::infinity), Real(-1));
        if constexpr (E::solids) {
            Mask free = traced;  // not inside an isolated solid
            if constexpr (E::has(effect_insides))
                free = traced & !((ray.media.solid != int(no_solid)) & has_bit(isolated, ray.media.solid));
            for (const IndexedSolid<ScalarOf<Real>>& next : scene.convex) {
                Mask inside = false;
                if constexpr (E::has(effect_insides)) inside = traced & ray.media.contains(int(next.index));
                const Mask outside = free & (!inside) & (ray.from_solid != int(next.index)) &
                                     !misses_bounds(next.sphere, ray.origin, ray.direction, best.t);
                if (any(inside | outside)) closest_in_solid(next, ray, inside, outside, best);
            }
            traced = free;
        }
        if constexpr (E::triangles) {
            for (uint32_t i = 0; i < scene.clusters.size; ++i) {
                const Mask reaches = traced & !misses_flat_sheet(scene, i, ray, best.t);
                if (any(reaches)) closest_in_cluster(i, ray, reaches, best);
            }
        }
        assign_where(!best.found(), best.t, Real(RealTraits<Real>::infinity));
        return best;
    }

    /// The share of the light's intensity that reaches the rays' origins, where `who` holds.
    template <class E>
    CISTULA_NOINLINE Throughput<Real, E> transmittance(const ShadowRay<Real, Media>& shadow, const Mask& who) const {
        using Index = IndexOf<Real>;
        const Ray<Real, Media>& ray = shadow.ray;
        ShadowSum<E, Real> sum;
        assign_where(!(who & is_finite(ray)), sum.opaque, Index(7));
        const uint32_t light = uint32_t(shadow.light - scene.lights.data);
        Index near = -1;  // the plan's masks
        for_each_value(who & (ray.from_solid != int(no_solid)), ray.from_solid, [&](uint32_t from, const Mask& same) {
            assign_where(same, near, Index(int32_t(scene.plan.near[from][light])));
        });
        Mask open = !sum.is_blocked();
        for (uint32_t p = 0; E::solids && p < scene.convex.size && any(open); ++p) {
            const IndexedSolid<ScalarOf<Real>>& next = scene.convex[p];
            Mask inside = false;
            if constexpr (E::has(effect_insides)) {
                inside = open & ray.media.contains(int(next.index));
                if (!E::has(effect_absorption) && (scene.plan.beyond[light] >> next.index & 1u) != 0) {
                    const Mask leaves = inside & (ray.from_solid == int(next.index));
                    sum.cross(scene.materials[next.solid.material], leaves);
                    inside = inside & !leaves;
                }
            }
            const Mask others = open & ((near & int32_t(1u << p)) != 0) & !ray.media.contains(int(next.index)) &
                                (ray.from_solid != int(next.index)) &
                                !misses_bounds(next.sphere, ray.origin, ray.direction, shadow.distance);
            if (any(inside | others)) shadow_solid<E>(scene, next.index, next.solid, shadow, inside, others, sum);
            open = !sum.is_blocked();
        }
        for (uint32_t i = 0; E::triangles && i < scene.clusters.size && any(open); ++i) {
            const Mask reaches = open & ((near & int32_t(1u << (ShadowPlan::first_cluster + i))) != 0) &
                                 !misses_flat_sheet(scene, i, ray, shadow.distance);
            if (any(reaches)) shadow_cluster(i, shadow, reaches, sum);
            open = !sum.is_blocked();
        }
        return sum.template transmittance<Real>(scene);
    }

  private:
    CISTULA_INLINE void closest_in_solid(const IndexedSolid<ScalarOf<Real>>& next, const Ray<Real, Media>& ray,
                                         const Mask& inside, const Mask& outside, Hit<Real>& best) const {
        const auto line =
            convex_lanes::cross(scene, next.solid, ray.origin, ray.direction, convex_lanes::face_left(next.index, ray));
        if (any(inside))
            take_exit<Real>(
                inside, next.index, line.leave, [&] { return line.leave_face; }, best);
        const Mask meets = outside & is_met(line, scene.extent);
        if (any(meets))
            take_entry<Real>(
                meets, next.index, line.enter, [&] { return line.enter_face; }, ray, best);
    }

    CISTULA_INLINE void closest_in_cluster(uint32_t index, const Ray<Real, Media>& ray, const Mask& who,
                                           Hit<Real>& best) const {
        for_each_crossing(index, ray, who, [&](uint32_t lane, const Mask& accepted, const TriangleCrossing<Real>& c) {
            closest_crossing(scene, accepted, scene.clusters[index].solid, scene.clusters[index].triangle[lane],
                             index * uint32_t(cluster_lanes) + lane, c, ray, best);
        });
    }

    template <class E>
    CISTULA_INLINE void shadow_cluster(uint32_t index, const ShadowRay<Real, Media>& shadow, const Mask& who,
                                       ShadowSum<E, Real>& sum) const {
        for_each_crossing(index, shadow.ray, who,
                          [&](uint32_t lane, const Mask& accepted, const TriangleCrossing<Real>& c) {
                              shadow_crossing<Real, E>(scene, accepted, scene.clusters[index].solid,
                                                       scene.clusters[index].triangle[lane], c, shadow, sum);
                          });
    }

    /// Calls visit(triangle's lane, mask, crossings) for the triangles of a cluster that rays cross.
    template <class Visit>
    CISTULA_INLINE void for_each_crossing(uint32_t index, const Ray<Real, Media>& ray, const Mask& who,
                                          const Visit& visit) const {
        const auto& cluster = scene.clusters[index];
        const TriangleRay<Real> triangle_ray = TriangleRay<Real>::of(ray.origin, ray.direction);
        for (uint32_t lane = 0; lane < cluster.count; ++lane) {
            TriangleCrossing<Real> c{};
            const Mask accepted =
                who & cross_triangle(ShearedTriangle<Real>::of(cluster, int(lane), triangle_ray), triangle_ray, c);
            if (any(accepted)) visit(lane, accepted, c);
        }
    }
};

}  // namespace cistula
