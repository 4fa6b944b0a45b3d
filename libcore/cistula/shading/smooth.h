// Smooth meshes, whose corners have normals (docs/rules.md, 17). What a ray meets, and on which side new ones start, is
// that of the flat triangles; these normals say where light is mirrored and bent, and how it falls on a face.
#pragma once

#include "cistula/geometry/hit.h"
#include "cistula/model/effects.h"
#include "cistula/model/scene_view.h"
#include "cistula/shading/snell.h"

namespace cistula {

/// Whether rays of a kernel may meet smooth meshes. A ConstantScene has none.
template <class E, class Media>
inline constexpr bool meets_smooth = E::has(effect_smooth) && Media::contacts;

/// The normals at the corners of the triangle with this slot; null if it is flat.
template <class Real>
CISTULA_INLINE const Vec3<Real>* corner_normals(const SceneView<Real>& scene, uint32_t slot) {
    const Cluster<Real>& cluster = scene.clusters[slot / cluster_lanes];
    const Solid& solid = scene.solids[cluster.solid];
    if (!is_smooth(solid)) return nullptr;
    const uint32_t triangle = cluster.triangle[slot % cluster_lanes] - solid.first_triangle;
    const Vec3<Real>* normals = scene.normals.data + (solid.first_slab - 1 + 3 * triangle);
    return dot(normals[0], normals[0]) > Real(0) ? normals : nullptr;
}

/// The normal at a hit between those of the triangle's corners, on the viewer's side, of any length.
template <class Real>
CISTULA_INLINE Vec3<Real> normal_between(const Vec3<ScalarOf<Real>>* normals, const Hit<Real>& hit) {
    const Vec3<Real> outward = spread<Real>(normals[0]) * ((Real(1) - hit.u) - hit.v) +
                               spread<Real>(normals[1]) * hit.u + spread<Real>(normals[2]) * hit.v;
    return select(hit.enters, outward, -outward);
}

/// The least cosine of mirrored rays to a face, and of bent ones beyond it.
template <class Real>
inline constexpr Real least_lift = 8 * RealTraits<Real>::unit;

/// Bends a unit normal, where it mirrors a ray into the face or too flat over it, and gives the mirrored direction,
/// which is on the viewer's side. `face`: the face's normal there. Continuous where bending begins (lines 4 and 5).
template <class Real>
CISTULA_INLINE void bend_normal(const Vec3<Real>& direction, const Vec3<Real>& face, Vec3<Real>& normal,
                                Vec3<Real>& mirrored) {
    const Real across = dot(direction, normal);
    const Real least = max_or_second(magnitude(dot(direction, face)) * Real(0.25), Real(least_lift<ScalarOf<Real>>));
    mirrored = reflected(direction, normal);
    const Real up = dot(mirrored, face);
    const MaskOf<Real> bends = !((up >= least) & (across < Real(0)));
    if (!any(bends)) return;
    const Real lift = least - up;
    assign_where(bends, mirrored, normalized(along(mirrored, lift, face)));
    assign_where(bends, normal, normalized(along(normal * (Real(-2) * across), lift, face)));
}

/// The way from a point on a triangle to the surface that its normals stand for, outward as the viewer sees it: by the
/// tangent planes at the corners (Hanika, Hacking the Shadow Terminator, Ray Tracing Gems II, 2021).
template <class Real>
CISTULA_INLINE Vec3<Real> bulge(const Vec3<ScalarOf<Real>> (&corner)[3], const Vec3<ScalarOf<Real>>* normals,
                                const Hit<Real>& hit, const Vec3<Real>& point) {
    const Real weights[3] = {(Real(1) - hit.u) - hit.v, hit.u, hit.v};
    const Real side = select(hit.enters, Real(1), Real(-1));
    Vec3<Real> way(Real(0));
    for (int c = 0; c < 3; ++c) {
        const Vec3<Real> normal = spread<Real>(normals[c]) * side;
        const Real below = dot(normal, spread<Real>(corner[c]) - point);
        way = along(way, weights[c] * max_or_second(below, Real(0)), normal);
    }
    return way;
}

}  // namespace cistula
