// Eight rays against a small scene at once: BruteIntersector's operations, lane by lane.
#pragma once

#include "backend_embree/lanes.h"
#include "cistula/brute.h"
#include "cistula/small_scene.h"

namespace cistula {

/// Rays side by side, with no solid around any.
template <class Real>
struct RayPacket {
    using Index = LaneIndex<Real>;

    VecLanes<Real> origin, direction;
    Lanes<Index> from_solid, from_face;  // as a Ray's

    CISTULA_INLINE Ray<Real, OneMedium> ray(int i) const {
        Ray<Real, OneMedium> one;
        one.origin = origin[i];
        one.direction = direction[i];
        one.from_solid = uint32_t(from_solid.of[i]);
        one.from_face = uint32_t(from_face.of[i]);
        return one;
    }
};

/// What each of them meets next: of lanes that closest() says hit anything.
template <class Real>
struct PacketHits {
    Lanes<Real> t;
    Lanes<LaneIndex<Real>> solid, face;  // solid -1: nothing
    Hit<Real> on_triangle[lane_count];   // where it is one
};

template <class Real, class E>
class PacketIntersector {
  public:
    using Scene = SmallScene<Real>;
    using Index = LaneIndex<Real>;

    explicit PacketIntersector(const Scene& scene) : scene_(scene) {}

    /// The lanes that hit anything. `origin`: the packet's, maybe as one that all share; `primitives`: as
    /// BruteIntersector::in_view.
    template <class Origin>
    uint32_t closest(const RayPacket<Real>& packet, const Origin& origin, uint32_t primitives, uint32_t lanes,
                     PacketHits<Real>& hits) const {
        for_lanes([&](int i) {
            const bool finite = is_finite(origin[i], packet.direction[i]);
            hits.t.of[i] = finite ? RealTraits<Real>::infinity : Real(-1);  // nothing is nearer than that
            hits.solid.of[i] = -1;
            hits.face.of[i] = 0;
        });
        if constexpr (E::solids)
            for (uint32_t left = primitives & scene_.plan.all_convex; left != 0; left &= left - 1)
                closest_solid(packet, origin, scene_.convex[lowest_bit(left)], lanes, hits);
        if constexpr (E::triangles)
            for (uint32_t left = primitives & scene_.plan.all_clusters; left != 0; left &= left - 1)
                closest_triangle(packet, lowest_bit(left) - scene_.plan.first_cluster, lanes, hits);
        return lanes & lanes_where([&](int i) { return hits.solid.of[i] >= 0; });
    }

    Hit<Real> hit(const PacketHits<Real>& hits, int i) const {
        const uint32_t solid = uint32_t(hits.solid.of[i]);
        if (!is_convex<E>(scene_.solids[solid])) return hits.on_triangle[i];
        Hit<Real> one;
        one.t = hits.t.of[i];
        one.key = make_key(CrossingKind::enter, solid, uint32_t(hits.face.of[i]));
        return one;
    }

    /// Of `lanes` those that a face keeps all light from. The lines leave one face; `distance`: how far the light is.
    uint32_t shadowed(const RayPacket<Real>& packet, uint32_t from, uint32_t light, const Lanes<Real>& distance,
                      uint32_t lanes) const {
        const uint32_t near = scene_.plan.near[from][light];
        uint32_t dark = lanes & lanes_where([&](int i) { return !is_finite(packet.origin[i], packet.direction[i]); });
        if constexpr (E::solids)
            for (uint32_t left = near & scene_.plan.all_convex; left != 0 && dark != lanes; left &= left - 1) {
                const NumberedSolid<Real>& other = scene_.convex[lowest_bit(left)];
                if (other.index != from) dark |= behind_solid(packet, other, distance, lanes & ~dark);
            }
        if constexpr (E::triangles)
            for (uint32_t left = near & scene_.plan.all_clusters; left != 0 && dark != lanes; left &= left - 1)
                dark |= behind_triangle(packet, light, lowest_bit(left) - scene_.plan.first_cluster, distance,
                                        lanes & ~dark);
        return dark;
    }

  private:
    /// Where lines are inside of all slabs of a solid, and the face by which they enter (convex_interval, convex_face).
    struct Intervals {
        Lanes<Real> enter, leave;
        Lanes<Index> face;

        CISTULA_INLINE bool met(int i, Real extent) const {
            return ConvexInterval<Real>{enter.of[i], leave.of[i]}.met(extent);
        }
    };

    template <class Origin>
    CISTULA_INLINE void cross(const Solid& solid, const Origin& origin, const VecLanes<Real>& direction,
                              Intervals& at) const {
        for_lanes([&](int i) {
            at.enter.of[i] = -RealTraits<Real>::infinity;
            at.leave.of[i] = RealTraits<Real>::infinity;
            at.face.of[i] = 0;
        });
        for (uint32_t s = 0; s < solid.slab_count; ++s) {
            const Slab<Real> slab = scene_.slabs[solid.first_slab + s];
            const Index falling = Index(leaving_face(s, Real(-1)) ^ 1u), rising = Index(leaving_face(s, Real(1)) ^ 1u);
            for_lanes([&](int i) {
                Real enter, leave;
                cross_slab(slab.normal, slab.low, slab.high, origin[i], direction[i], enter, leave);
                const Index face = dot(slab.normal, direction[i]) > Real(0) ? rising : falling;
                at.face.of[i] = enter > at.enter.of[i] ? face : at.face.of[i];
                at.enter.of[i] = greatest(enter, at.enter.of[i]);
                at.leave.of[i] = least(leave, at.leave.of[i]);
            });
        }
    }

    template <class Origin>
    CISTULA_INLINE void closest_solid(const RayPacket<Real>& packet, const Origin& origin,
                                      const NumberedSolid<Real>& next, uint32_t lanes, PacketHits<Real>& hits) const {
        const Ball<Real> ball = next.ball;
        const Index index = Index(next.index);
        const uint32_t near = lanes & lanes_where([&](int i) {
                                  return (packet.from_solid.of[i] != index) &
                                         !passes_by(ball, origin[i], packet.direction[i], hits.t.of[i]);
                              });
        if (near == 0) return;
        Intervals at;
        cross(next.solid, origin, packet.direction, at);
        const Real extent = scene_.extent;
        // All lanes: the slabs refuse what passes the ball by.
        for_lanes([&](int i) {
            const Real t = greatest(at.enter.of[i], Real(0));
            const bool nearer = (t < hits.t.of[i]) | ((t == hits.t.of[i]) & (index < hits.solid.of[i]));
            const bool takes =
                (packet.from_solid.of[i] != index) & at.met(i, extent) & nearer & (t < RealTraits<Real>::infinity);
            hits.t.of[i] = takes ? t : hits.t.of[i];
            hits.solid.of[i] = takes ? index : hits.solid.of[i];
            hits.face.of[i] = takes ? at.face.of[i] : hits.face.of[i];
        });
    }

    CISTULA_INLINE uint32_t behind_solid(const RayPacket<Real>& packet, const NumberedSolid<Real>& other,
                                         const Lanes<Real>& distance, uint32_t lanes) const {
        const Ball<Real> ball = other.ball;
        const uint32_t near = lanes & lanes_where([&](int i) {
                                  return !passes_by(ball, packet.origin[i], packet.direction[i], distance.of[i]);
                              });
        if (near == 0) return 0;
        Intervals at;
        cross(other.solid, packet.origin, packet.direction, at);
        const Real extent = scene_.extent;
        return near & lanes_where([&](int i) {
                   return at.met(i, extent) & (greatest(at.enter.of[i], Real(0)) < distance.of[i]);
               });
    }

    /// The lanes that do not surely miss a cluster's sheet.
    CISTULA_INLINE uint32_t near_sheet(const RayPacket<Real>& packet, uint32_t cluster, const Lanes<Real>& limit,
                                       uint32_t lanes) const {
        const SheetPlane<Real> plane = scene_.planes[cluster];
        return lanes & lanes_where([&](int i) {
                   return !misses_flat(plane, uint32_t(packet.from_solid.of[i]), packet.origin[i], packet.direction[i],
                                       limit.of[i]);
               });
    }

    CISTULA_INLINE void closest_triangle(const RayPacket<Real>& packet, uint32_t cluster, uint32_t lanes,
                                         PacketHits<Real>& hits) const {
        for_each_lane(near_sheet(packet, cluster, hits.t, lanes), [&](int i) {
            const Ray<Real, OneMedium> ray = packet.ray(i);
            Hit<Real> best;
            if (hits.solid.of[i] >= 0) best = hit(hits, i);
            best.t = hits.t.of[i];
            const uint64_t before = best.key;
            closest_triangles(scene_, cluster, ray, TriangleRay<Real>::of(ray.origin, ray.direction), best);
            if (best.key == before) return;
            hits.t.of[i] = best.t;
            hits.solid.of[i] = Index(key_solid(best.key));
            hits.face.of[i] = Index(key_face(best.key));
            hits.on_triangle[i] = best;
        });
    }

    CISTULA_INLINE uint32_t behind_triangle(const RayPacket<Real>& packet, uint32_t light, uint32_t cluster,
                                            const Lanes<Real>& distance, uint32_t lanes) const {
        uint32_t dark = 0;
        for_each_lane(near_sheet(packet, cluster, distance, lanes), [&](int i) {
            const ShadowRay<Real, OneMedium> shadow{packet.ray(i), distance.of[i], &scene_.lights[light]};
            const auto triangle_ray = TriangleRay<Real>::of(shadow.ray.origin, shadow.ray.direction);
            ShadowSum<E> sum;
            shadow_triangles<Real, E>(scene_, cluster, shadow, triangle_ray, sum);
            dark |= uint32_t(sum.dark()) << i;
        });
        return dark;
    }

    const Scene& scene_;
};

}  // namespace cistula
