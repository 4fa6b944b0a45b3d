// A convex solid as an intersection of half-spaces.
#pragma once

#include <vector>

#include "cistula/model/scene_view.h"

namespace cistula {

/// The half-space normal.x <= offset. `face` is numbered as in hit keys: 2 slab + side.
struct SolidPlane {
    Vec3<double> normal;
    double offset;
    uint32_t face;
};

/// The half-spaces of a solid in face order. Slabs without a lower side give one.
template <class Real>
std::vector<SolidPlane> solid_planes(const SceneView<Real>& scene, const Solid& solid) {
    std::vector<SolidPlane> planes;
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        const Slab<Real>& slab = scene.slabs[solid.first_slab + i];
        const Vec3<double> normal(slab.normal);
        if (slab.low > -RealTraits<Real>::infinity) planes.push_back({-normal, -double(slab.low), 2 * i});
        planes.push_back({normal, double(slab.high), 2 * i + 1});
    }
    return planes;
}

}  // namespace cistula
