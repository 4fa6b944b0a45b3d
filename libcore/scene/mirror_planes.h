// The flat faces of a small scene that mirror, numbered, and the planes in which they do so. Inside libcore/scene.
#pragma once

#include <vector>

#include "cistula/camera.h"
#include "cistula/small_scene.h"

namespace cistula {

/// As many solids as have room, in their order.
template <class Real>
MirrorNumbers number_mirrors(const SceneView<Real>& scene);

/// A face that has a number. Points of it are within `thickness` of the plane; `shift`: how far from where they meet it
/// the lines start that it sends back, beyond rounding.
struct MirrorPlane {
    uint32_t number, solid;
    Vec3<double> normal;  // unit; not finite for a triangle without area
    double offset;        // normal.x on it
    double thickness = 0, shift = 0;
};

/// None of a scene of more solids or triangles than a SmallScene holds.
template <class Real>
std::vector<MirrorPlane> mirror_planes(const SceneView<Real>& scene);

/// The camera that sees straight on what a mirror shows.
Camera mirrored(const Camera& camera, const MirrorPlane& mirror);

}  // namespace cistula
