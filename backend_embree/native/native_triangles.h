// All solids of a scene as float triangles, for Embree's triangle geometry.
#pragma once

#include <vector>

#include "cistula/model/scene_view.h"

namespace cistula {

struct NativeTriangle {
    Vec3<float> corner[3];  // counter-clockwise from outside
    uint32_t solid;
    uint32_t face;  // 2 slab + side, or the scene-wide triangle number, as in a key
    uint32_t slot;  // meshes and sheets: 8 cluster + lane
};

/// The triangles of the clusters, followed by the faces of convex solids as fans.
template <class Real>
std::vector<NativeTriangle> native_triangles(const SceneView<Real>& scene);

}  // namespace cistula
