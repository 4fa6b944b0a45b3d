// All solids of a scene as plain triangles of floats, as Embree takes them.
#pragma once

#include <vector>

#include "cistula/model/scene_view.h"

namespace cistula {

struct NativeTriangle {
    Vec3<float> corner[3];  // counter-clockwise from outside
    uint32_t solid;
    uint32_t face;  // 2 slab + side, or the scene-wide triangle number: what a key holds
    uint32_t slot;  // meshes and sheets: 8 cluster + lane
};

/// Those of the clusters, then the faces of the convex solids as fans.
template <class Real>
std::vector<NativeTriangle> native_triangles(const SceneView<Real>& scene);

}  // namespace cistula
