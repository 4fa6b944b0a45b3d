// The intersector of lanes: a loop over the primitives where they are few, else a tree over them.
#pragma once

#include "cistula/lanes/ball_lanes.h"
#include "cistula/lanes/lane_shadow.h"
#include "cistula/lanes/lane_tree.h"
#include "cistula/lanes/lane_triangles.h"

namespace cistula {

template <class Real>
struct LaneIntersector {
    using Scene = LaneScene<ScalarOf<Real>>;
    using Media = LaneMedia<Real>;
    using Mask = MaskOf<Real>;
    using Index = IndexOf<Real>;
    using T = ScalarOf<Real>;
    using Integer = ScalarOf<Index>;
    const Scene& scene;

    /// The hits with the smallest (t, key) after ray.after, where `active` holds.
    template <class E>
    CISTULA_NOINLINE Hit<Real> closest(const Ray<Real, Media>& ray, const Mask& active) const {
        Hit<Real> best;
        // With t = -1 a ray that is not finite, or not asked for, finds nothing.
        const Mask traced = active & is_finite(ray);
        best.t = select(traced, Real(RealTraits<Real>::infinity), Real(-1));
        Mask enclosed = false;  // by solids that nothing else comes near
        if constexpr (E::solids && E::has(effect_insides)) enclosed = traced & (ray.media.among(scene.isolated) != 0);
        closest_disk<E>(scene, traced & !enclosed, ray, best);
        const Index beside = beside_start<E>(ray);
        if constexpr (E::has(effect_spheres))
            if (scene.columns.count > 0) closest_balls(scene.columns, ray, traced, traced & !enclosed, best);
        if (scene.loops)
            closest_in_loop<E>(ray, traced, traced & !enclosed, beside, best);
        else
            closest_in_tree<E>(ray, enclosed, traced & !enclosed, beside, best);
        assign_where(!best.found(), best.t, Real(RealTraits<Real>::infinity));
        return best;
    }

    /// The share of the light's intensity that reaches the rays' origins, where `active` holds.
    template <class E>
    CISTULA_NOINLINE Throughput<Real, E> transmittance(const ShadowRay<Real, Media>& shadow, const Mask& active) const {
        ShadowSum<E, Real> sum;
        assign_where(!(active & is_finite(shadow.ray)), sum.opaque, Index(7));
        if constexpr (E::has(effect_absorption))
            if (scene.meshes.any) shadow_start(scene, shadow, active, sum);
        shadow_disks<E>(scene, shadow, !sum.is_blocked(), sum);
        const Index beside = beside_start<E>(shadow.ray);
        if (scene.loops)
            shadow_in_loop(shadow, beside, sum);
        else
            shadow_in_tree(shadow, beside, sum);
        return sum.template transmittance<Real>(scene);
    }

  private:
    /// The convex solids with a face on the shared planes on which rays start, a bit each; the planes, if solids are
    /// named.
    template <class E>
    CISTULA_INLINE Index beside_start(const Ray<Real, Media>& ray) const {
        if constexpr (E::has(effect_contacts))
            if (!scene.shared_planes.empty()) return scene.named ? ray.from_plane : bodies_at_start(scene, ray);
        return scene.named ? Index(Integer(no_plane)) : Index(0);
    }

    /// `free`: the rays of `active` that may hit more than the solid that they are in.
    template <class E>
    CISTULA_INLINE void closest_in_loop(const Ray<Real, Media>& ray, const Mask& active, const Mask& free,
                                        const Index& beside, Hit<Real>& best) const {
        for (uint32_t i = 0; E::solids && i < scene.convex_copies.size; ++i)
            closest_solid<E>(i, ray, active, free, beside, best);
        for (uint32_t i = 0; E::triangles && i < scene.clusters.size; ++i) {
            const Mask reaches = reaching(i, ray, free, best.t);
            if (any(reaches))
                closest_in_cluster(i, ray, LaneTriangleRay<Real>(ray.origin, ray.direction), reaches, best);
        }
    }

    template <class E>
    CISTULA_INLINE void closest_in_tree(const Ray<Real, Media>& ray, const Mask& enclosed, const Mask& free,
                                        const Index& beside, Hit<Real>& best) const {
        for_each_value(enclosed, ray.media.among(scene.isolated), [&](uint32_t set, const Mask& same) {
            const uint32_t solid = InteriorSet{set, scene.named}.last();
            closest_solid<E>(scene.convex_places[solid], ray, same, false, beside, best);
        });
        if (!any(free)) return;
        const LaneTriangleRay<Real> triangle_ray(ray.origin, ray.direction);
        traverse_tree(
            scene.tree, scene.tree_items, LaneBoxRay<Real>(ray.origin, ray.direction, tree_near(ray.after.t)), free,
            [&] { return tree_far(best.t); },
            [&](uint32_t primitive, const Mask& near) {
                if (is_solid<E>(scene, primitive)) return closest_solid<E>(primitive, ray, near, near, beside, best);
                const uint32_t cluster = primitive - scene.convex.size;
                const Mask reaches = reaching(cluster, ray, near, best.t);
                if (any(reaches)) closest_in_cluster(cluster, ray, triangle_ray, reaches, best);
            });
    }

    /// The rays of `active` that may reach a cluster's triangles up to `limit`.
    CISTULA_INLINE Mask reaching(uint32_t cluster, const Ray<Real, Media>& ray, const Mask& active,
                                 const Real& limit) const {
        if (scene.planes[cluster].flat == 0) return active;
        return active & !misses_flat_sheet(scene, cluster, ray, limit);
    }

    /// A convex solid, by its place among them. `free`: the rays of `active` that may hit it from outside.
    template <class E>
    CISTULA_INLINE void closest_solid(uint32_t place, const Ray<Real, Media>& ray, const Mask& active, const Mask& free,
                                      const Index& beside, Hit<Real>& best) const {
        const IndexedSolid<ScalarOf<Real>>& next = scene.convex_copies[place];
        const uint32_t index = next.index;
        if constexpr (E::has(effect_spheres))
            if (scene.columns.count > 0 && is_ball(next.solid)) return;  // tested already
        Mask inside = false;
        if constexpr (E::has(effect_insides)) inside = active & ray.media.contains(index);
        if constexpr (E::has(effect_spheres))
            if (is_ball(next.solid)) return closest_ball(scene, index, ray, inside, free & !inside, best);
        const Mask near = free & (!inside) & !misses_bounds(next.sphere, ray.origin, ray.direction, best.t);
        const Mask on_plane = is_beside<E>(index, beside);
        const Mask outside = near & (!on_plane) & (ray.from_solid != int(index));
        if (any(inside | outside)) {
            const Index left = faces_left<E>(scene, index, ray, inside & on_plane);
            closest_in_solid(next, ray, left, inside, outside, best);
        }
        if constexpr (E::has(effect_contacts))
            if (any(near & on_plane)) closest_beside(index, ray, near & on_plane, best);
    }

    /// The rays that start on a shared plane where a convex solid has a face.
    template <class E>
    CISTULA_INLINE Mask is_beside(uint32_t index, const Index& beside) const {
        Mask found = false;
        if constexpr (E::has(effect_contacts)) {
            if (!scene.named) return (beside & Index(int(1u << index))) != 0;
            for_each_value(beside != Index(Integer(no_plane)), beside, [&](uint32_t plane, const Mask& same) {
                if (inner_side(scene, index, plane) != 0) found |= same;
            });
        }
        return found;
    }

    /// The crossings by which rays enter a convex solid that has a face on the shared plane on which they start.
    CISTULA_NOINLINE void closest_beside(uint32_t index, const Ray<Real, Media>& ray, const Mask& active,
                                         Hit<Real>& best) const {
        const LaneEntries<Real> entries = entries_beside(scene, index, ray, active);
        const Real t = max_or_second(entries.enter, Real(0));
        const KeyOf<Real> key = KeyFormat<Real>::make(CrossingKind::enter, index, entries.face);
        best.take(entries.found & ray.after.before(t, key) & best.improves(t, key), t, key, Real(0), Real(0), 0, true);
    }

    template <class E>
    CISTULA_INLINE void shadow_in_loop(const ShadowRay<Real, Media>& shadow, const Index& beside,
                                       ShadowSum<E, Real>& sum) const {
        Mask open = !sum.is_blocked();
        uint32_t passed_by = 0;  // balls, a bit each of their solids
        if constexpr (E::has(effect_spheres))
            if (scene.columns.count > 0)
                passed_by = scene.columns.solids ^ balls_on_lines(scene.columns, shadow.ray, open);
        for (uint32_t p = 0; E::solids && p < scene.convex_copies.size && any(open); ++p) {
            if (passed_by != 0 && (passed_by >> scene.convex_copies[p].index & 1u) != 0) continue;
            shadow_solid(p, shadow, open, beside, sum);
            open = !sum.is_blocked();
        }
        for (uint32_t i = 0; E::triangles && i < scene.clusters.size && any(open); ++i) {
            shadow_cluster_in_loop(i, shadow, open, sum);
            open = !sum.is_blocked();
        }
    }

    /// Out of line, so that the compiler moves nothing of it out of the loop.
    template <class E>
    CISTULA_NOINLINE void shadow_cluster_in_loop(uint32_t i, const ShadowRay<Real, Media>& shadow, const Mask& asked,
                                                 ShadowSum<E, Real>& sum) const {
        const Ray<Real, Media>& ray = shadow.ray;
        const Mask reaches = reaching(i, ray, asked, shadow.distance);
        if (any(reaches)) shadow_cluster(i, shadow, LaneTriangleRay<Real>(ray.origin, ray.direction), reaches, sum);
    }

    template <class E>
    CISTULA_INLINE void shadow_in_tree(const ShadowRay<Real, Media>& shadow, const Index& beside,
                                       ShadowSum<E, Real>& sum) const {
        const Ray<Real, Media>& ray = shadow.ray;
        const LaneTriangleRay<Real> triangle_ray(ray.origin, ray.direction);
        const Real far = tree_far(shadow.distance);
        traverse_tree(
            scene.tree, scene.tree_items, LaneBoxRay<Real>(ray.origin, ray.direction, Real(0)), !sum.is_blocked(),
            [&] { return select(sum.is_blocked(), Real(-1), far); },
            [&](uint32_t primitive, const Mask& near) {
                if (is_solid<E>(scene, primitive)) return shadow_solid(primitive, shadow, near, beside, sum);
                const uint32_t cluster = primitive - scene.convex.size;
                const Mask reaches = reaching(cluster, ray, near, shadow.distance);
                if (any(reaches)) shadow_cluster(cluster, shadow, triangle_ray, reaches, sum);
            });
    }

    /// Adds a convex solid, by its place among them.
    template <class E>
    CISTULA_INLINE void shadow_solid(uint32_t place, const ShadowRay<Real, Media>& shadow, const Mask& active,
                                     const Index& beside, ShadowSum<E, Real>& sum) const {
        const Ray<Real, Media>& ray = shadow.ray;
        const IndexedSolid<ScalarOf<Real>>& next = scene.convex_copies[place];
        const uint32_t index = next.index;
        Mask inside = false;
        Mask outside = true;
        if constexpr (E::has(effect_insides)) {
            const Mask contains = ray.media.contains(index);
            inside = active & contains;
            outside = !contains;
        }
        if constexpr (E::has(effect_spheres))
            if (is_ball(next.solid)) return shadow_ball<E>(scene, index, shadow, inside, active & outside, sum);
        const Mask on_plane = is_beside<E>(index, beside);
        Mask reaches = active & outside;
        if constexpr (!E::has(effect_contacts)) reaches &= ray.from_solid != int(index);
        if (any(reaches))
            reaches &= !misses_bounds(next.sphere, ray.origin, ray.direction, shadow.distance);
        else if (!any(inside))
            return;
        const Mask others = reaches & (!on_plane) & (ray.from_solid != int(index));
        if (any(inside | others)) {
            const Index left = faces_left<E>(scene, index, ray, inside & on_plane);
            cistula::shadow_solid<E>(scene, index, next.solid, shadow, left, inside, others, sum);
        }
        if constexpr (E::has(effect_contacts))
            if (any(reaches & on_plane)) shadow_beside(scene, index, next.solid, shadow, reaches & on_plane, sum);
    }

    CISTULA_INLINE void closest_in_solid(const IndexedSolid<ScalarOf<Real>>& next, const Ray<Real, Media>& ray,
                                         const Index& left, const Mask& inside, const Mask& outside,
                                         Hit<Real>& best) const {
        const auto crossing = any(inside) ? convex_lanes::cross<Real, convex_lanes::entering | convex_lanes::inside>(
                                                scene, next.solid, ray.origin, ray.direction, left)
                                          : convex_lanes::cross<Real, convex_lanes::entering>(
                                                scene, next.solid, ray.origin, ray.direction, left);
        if (any(inside))
            take_exit<Real>(
                inside, next.index, crossing.leave, [&] { return crossing.leave_face; }, best);
        const Mask meets = outside & is_met(crossing, scene.extent);
        if (any(meets))
            take_entry<Real>(
                meets, next.index, crossing.enter, [&] { return crossing.enter_face; }, ray, best);
    }

    CISTULA_INLINE void closest_in_cluster(uint32_t index, const Ray<Real, Media>& ray,
                                           const LaneTriangleRay<Real>& triangle_ray, const Mask& active,
                                           Hit<Real>& best) const {
        const auto& cluster = scene.clusters[index];
        const bool is_mesh = scene.meshes.has(cluster.solid);
        for_each_crossing(cluster, triangle_ray, active,
                          [&](uint32_t lane, const Mask& accepted, const TriangleCrossing<Real>& c) {
                              const uint32_t triangle = cluster.triangle[lane];
                              const uint32_t slot = index * uint32_t(cluster_lanes) + lane;
                              if (is_mesh)
                                  closest_mesh_crossing(scene, accepted, cluster.solid, triangle, slot, c, ray, best);
                              else
                                  closest_crossing(scene, accepted, cluster.solid, triangle, slot, c, ray, best);
                          });
    }

    template <class E>
    CISTULA_INLINE void shadow_cluster(uint32_t index, const ShadowRay<Real, Media>& shadow,
                                       const LaneTriangleRay<Real>& triangle_ray, const Mask& active,
                                       ShadowSum<E, Real>& sum) const {
        const auto& cluster = scene.clusters[index];
        for_each_crossing(cluster, triangle_ray, active,
                          [&](uint32_t triangle, const Mask& accepted, const TriangleCrossing<Real>& c) {
                              shadow_crossing<Real, E>(scene, accepted, cluster.solid, cluster.triangle[triangle], c,
                                                       shadow, sum);
                          });
    }
};

}  // namespace cistula
