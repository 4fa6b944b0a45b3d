// The normal of a triangle and its apexes, the points toward which new rays are moved off its two sides (docs/rules.md,
// 2).
#pragma once

#include "cistula/model/scene_view.h"

namespace cistula {

/// The point above a triangle's centroid toward which the origins of new rays are moved off the triangle.
template <class Real>
struct Apex {
    Vec3<Real> place;
    Real share;  // fraction of the way to the apex at which a ray starts: about 8 u M

    CISTULA_INLINE static Apex of(const Vec3<Real>& centroid, const Vec3<Real>& normal, Real height, Real extent) {
        const Real step = Real(8) * RealTraits<Real>::unit * extent;
        return {along(centroid, height, normal), step < height * Real(0.125) ? step / height : Real(0.125)};
    }
    /// The origin of a ray that leaves from a point on the triangle. The segment to the apex crosses no other triangle
    /// (docs/rules.md, 2), so the new origin is on the right side of all of them.
    CISTULA_INLINE Vec3<Real> from(const Vec3<Real>& point) const { return along(point, share, place - point); }
};

template <class Real>
CISTULA_INLINE Real largest_magnitude(const Vec3<Real>& a) {
    return max_or_second(magnitude(a.x), max_or_second(magnitude(a.y), magnitude(a.z)));
}

/// The unit normal of a triangle so small that the square of its area underflows: its edges are scaled first. Not
/// inlined, so its arguments are by value.
template <class Real>
CISTULA_NOINLINE Vec3<Real> small_triangle_normal(Vec3<Real> ab, Vec3<Real> ac) {
    const Real scale = Real(1) / max_or_second(largest_magnitude(ab), largest_magnitude(ac));
    const Vec3<Real> scaled = cross(ab * scale, ac * scale);
    return normalized(scaled / largest_magnitude(scaled));
}

/// The unit normal of a triangle from two of its edges; not finite for a triangle without area.
template <class Real>
CISTULA_INLINE Vec3<Real> triangle_normal(const Vec3<Real>& ab, const Vec3<Real>& ac) {
    const Vec3<Real> n = cross(ab, ac);
    const Real square = dot(n, n);
    return square > Real(0x1p-80) ? n / square_root(square) : small_triangle_normal(ab, ac);
}

/// The corners of the triangle with this slot (8 cluster + lane).
template <class Real, class Scene>
CISTULA_INLINE void triangle_corners(const Scene& scene, uint32_t slot, Vec3<Real> (&corner)[3]) {
    const Cluster<Real>& cluster = scene.clusters[slot / cluster_lanes];
    const uint32_t lane = slot % cluster_lanes;
    for (int c = 0; c < 3; ++c)
        corner[c] = {cluster.corner[c][0][lane], cluster.corner[c][1][lane], cluster.corner[c][2][lane]};
}

/// The apex of a triangle on the side to which `normal` points. `outside` is that side as seen by the corners:
/// counter-clockwise.
template <class Real, class Scene>
CISTULA_INLINE Apex<Real> apex_of(const Scene& scene, uint32_t slot, const Vec3<Real> (&corner)[3],
                                  const Vec3<Real>& normal, bool outside) {
    const Vec3<Real> centroid = (corner[0] + corner[1] + corner[2]) * Real(1.0 / 3.0);
    return Apex<Real>::of(centroid, normal, scene.clusters[slot / cluster_lanes].height[outside][slot % cluster_lanes],
                          scene.extent);
}

/// The outward normal and both apexes of a triangle, precomputed.
template <class Real>
struct TriangleSides {
    Vec3<Real> normal;   // on the outside
    Apex<Real> apex[2];  // inside, outside

    /// `normal`: the triangle's outward normal, or that of its shared plane.
    template <class Scene>
    static TriangleSides of(const Scene& scene, uint32_t slot, const Vec3<Real>& normal) {
        Vec3<Real> corner[3];
        triangle_corners(scene, slot, corner);
        return {normal, {apex_of(scene, slot, corner, -normal, false), apex_of(scene, slot, corner, normal, true)}};
    }
};

}  // namespace cistula
