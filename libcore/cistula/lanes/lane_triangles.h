// Rays in lanes against clusters of triangles: a triangle after the other against all rays, or a ray after the other
// against all triangles, whichever is less work.
#pragma once

#include "cistula/geometry/triangle.h"
#include "cistula/lanes/lanes.h"

namespace cistula {

/// The shears of rays: of all lanes in registers, and in memory for rays by themselves.
template <class Real>
class LaneTriangleRay {
  public:
    using T = ScalarOf<Real>;
    TriangleRay<Real> all;

    CISTULA_INLINE LaneTriangleRay(const Vec3<Real>& origin, const Vec3<Real>& direction)
        : all(TriangleRay<Real>::of(origin, direction)),
          axes_{LaneArray<Index>(all.kx), LaneArray<Index>(all.ky), LaneArray<Index>(all.kz)},
          shear_{LaneArray<Real>(all.sx), LaneArray<Real>(all.sy), LaneArray<Real>(all.sz)},
          origin_{LaneArray<Real>(all.ox), LaneArray<Real>(all.oy), LaneArray<Real>(all.oz)} {}

    CISTULA_INLINE TriangleRay<T> of(int lane) const {
        TriangleRay<T> one;
        one.kx = uint32_t(axes_[0].of[lane]), one.ky = uint32_t(axes_[1].of[lane]),
        one.kz = uint32_t(axes_[2].of[lane]);
        one.sx = shear_[0].of[lane], one.sy = shear_[1].of[lane], one.sz = shear_[2].of[lane];
        one.ox = origin_[0].of[lane], one.oy = origin_[1].of[lane], one.oz = origin_[2].of[lane];
        return one;
    }

  private:
    using Index = IndexOf<Real>;
    LaneArray<Index> axes_[3];
    LaneArray<Real> shear_[3], origin_[3];
};

/// Calls visit(triangle's lane in the cluster, rays, crossings) for the triangles of a cluster that rays of `active`
/// cross.
template <class Real, class Visit>
CISTULA_INLINE void for_each_crossing(const Cluster<ScalarOf<Real>>& cluster, const LaneTriangleRay<Real>& ray,
                                      const MaskOf<Real>& active, const Visit& visit) {
    using T = ScalarOf<Real>;
    using Mask = MaskOf<Real>;
    constexpr uint32_t registers = cluster_lanes * sizeof(T) / 32;  // of a ray's test against a whole cluster
    if (uint32_t(__builtin_popcount(active.bits())) * registers >= cluster.count) {
        for (uint32_t triangle = 0; triangle < cluster.count; ++triangle) {
            TriangleCrossing<Real> c;  // not set to 0, which takes longer than the test
            const Mask accepted =
                active & cross_triangle(ShearedTriangle<Real>::of(cluster, int(triangle), ray.all), ray.all, c);
            if (any(accepted)) visit(triangle, accepted, c);
        }
        return;
    }
    for_each_lane(active, [&](int lane) {
        for_each_crossing(cluster, ray.of(lane), [&](uint32_t triangle, const TriangleCrossing<T>& c) {
            visit(triangle, Mask::of_bits(1u << lane), TriangleCrossing<Real>{c.t, c.edge_u, c.edge_v, c.det});
        });
    });
}

/// Takes accepted crossings of a closed mesh, where `active` holds, as `best` if they are the rays' next
/// (closest_crossing).
template <class Real, class Media, class Scene>
CISTULA_INLINE void closest_mesh_crossing(const Scene& scene, const MaskOf<Real>& active, uint32_t solid,
                                          uint32_t triangle, uint32_t slot, const TriangleCrossing<Real>& c,
                                          const Ray<Real, Media>& ray, Hit<Real>& best) {
    using Mask = MaskOf<Real>;
    const Real t = crossing_time(scene, solid, triangle, c.t, ray);
    const Mask starts_there = (ray.from_solid == int(solid)) & (ray.from_face == int(triangle));
    const Mask enters = c.enters();
    const Mask is_inside = ray.media.contains(solid);
    const Mask wrong = (ray.after.t <= Real(-1)) & ((enters & is_inside) | !(enters | is_inside));
    const Mask meets = active & (t >= Real(0)) & !starts_there;
    assign_where(meets & wrong, best.wrong_side_t, min_no_nan(t, best.wrong_side_t));
    using Keys = KeyFormat<Real>;
    const auto face = KeyOf<Real>(int32_t(triangle));
    const KeyOf<Real> key =
        select(enters, Keys::make(CrossingKind::enter, solid, face), Keys::make(CrossingKind::leave, solid, face));
    const Mask first = meets & !wrong & ray.after.before(t, key) & best.improves(t, key);
    if (any(first)) best.take(first, t, key, c.u(), c.v(), int32_t(slot), enters);
}

}  // namespace cistula
