// Scene queries of the shading code that the two scene forms answer differently: a SceneView computes what a
// ConstantScene has precomputed.
#pragma once

#include "cistula/model/constant_scene.h"

namespace cistula {

/// Whether no light passes a solid's faces; it is no medium then.
template <class Real>
CISTULA_INLINE bool is_opaque(const SceneView<Real>& scene, uint32_t solid) {
    return scene.materials[scene.solids[solid].material].transparency == Transparency::opaque;
}
template <class Real>
CISTULA_INLINE bool is_opaque(const ConstantScene<Real>& scene, uint32_t solid) {
    return (scene.opaque_solids >> solid & 1u) != 0;
}

/// Whether a solid's faces pass all light unchanged between equal indices: a clear solid's, or a closed one's that
/// splits all light by Fresnel's terms.
template <class Real>
CISTULA_INLINE bool is_clear(const SceneView<Real>& scene, uint32_t solid) {
    const Solid& one = scene.solids[solid];
    const Transparency transparency = scene.materials[one.material].transparency;
    return transparency == Transparency::clear || (transparency == Transparency::whole && one.kind != SolidKind::sheet);
}
template <class Real>
CISTULA_INLINE bool is_clear(const ConstantScene<Real>& scene, uint32_t solid) {
    return (scene.clear_solids >> solid & 1u) != 0;
}

/// Whether a solid's material transmits: kt > 0.
template <class Real>
CISTULA_INLINE bool transmits(const SceneView<Real>& scene, uint32_t solid) {
    return scene.materials[scene.solids[solid].material].transmission > 0;
}
template <class Real>
CISTULA_INLINE bool transmits(const ConstantScene<Real>& scene, uint32_t solid) {
    return (scene.transmitting_solids >> solid & 1u) != 0;
}

/// 2^-loss, the transmittance after a loss.
template <class Real>
CISTULA_INLINE Real transmittance_of(const SceneView<Real>&, uint64_t loss) {
    return transmittance_of<Real>(loss);
}
/// 2^-loss for a loss that is not among a ConstantScene's cached_transmittances.
template <class Real>
CISTULA_NOINLINE Real uncached_transmittance(uint64_t loss) {
    return transmittance_of<Real>(loss);
}
template <class Real>
CISTULA_INLINE Real transmittance_of(const ConstantScene<Real>& scene, uint64_t loss) {
    Real transmittance = Real(-1);
    for (const CachedTransmittance<Real>& known : scene.cached_transmittances)
        if (known.loss == loss) transmittance = known.transmittance;
    return transmittance >= Real(0) ? transmittance : uncached_transmittance<Real>(loss);
}

/// The outward unit normal of a triangle.
template <class Real>
CISTULA_INLINE Vec3<Real> outward_normal(const SceneView<Real>& scene, uint32_t slot) {
    Vec3<Real> corner[3];
    triangle_corners(scene, slot, corner);
    return triangle_normal(corner[1] - corner[0], corner[2] - corner[0]);
}
template <class Real>
CISTULA_INLINE Vec3<Real> outward_normal(const ConstantScene<Real>& scene, uint32_t slot) {
    return scene.sides[slot].normal;
}

/// The apex (docs/rules.md, 2) on one side of a triangle; `corner` and `normal`, the normal on that side, are the
/// triangle's.
template <class Real>
CISTULA_INLINE Apex<Real> apex_at(const SceneView<Real>& scene, uint32_t slot, const Vec3<Real> (&corner)[3],
                                  const Vec3<Real>& normal, bool outside) {
    return apex_of(scene, slot, corner, normal, outside);
}
template <class Real>
CISTULA_INLINE const Apex<Real>& apex_at(const ConstantScene<Real>& scene, uint32_t slot, const Vec3<Real> (&)[3],
                                         const Vec3<Real>&, bool outside) {
    return scene.sides[slot].apex[outside];
}

/// The plane of the flat sheet to which a cluster belongs, if any.
template <class Real>
CISTULA_INLINE SheetPlane<Real> plane_of(const SceneView<Real>& scene, uint32_t cluster) {
    const uint32_t solid = scene.clusters[cluster].solid;
    return SheetPlane<Real>::of(scene.solids[solid], solid);
}
template <class Real>
CISTULA_INLINE const SheetPlane<Real>& plane_of(const ConstantScene<Real>& scene, uint32_t cluster) {
    return scene.planes[cluster];
}
template <class Real>
CISTULA_INLINE const SheetPlane<Real>& plane_of(const BallScene<Real>& scene, uint32_t cluster) {
    return scene.planes[cluster];
}

}  // namespace cistula
