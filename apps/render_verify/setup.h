// The inputs of a case's rays, equal on host and device: scene, lists of the part, random draws.
#pragma once

#include "cistula/traversal/bvh.h"
#include "testing/draw/draw.h"

namespace cistula::verify {

using parity::Draw;

/// A part's scene and lists in memory readable by the running code. All lengths are in the scene's frame.
template <class Real>
struct Setup {
    SceneView<Real> scene;
    Span<Vec3<double>> points;  // targets, before they are rounded to Real as vertices are
    Span<double> numbers;       // data of the case
    double factor = 1;          // frame lengths per world length, a power of two
    uint64_t seed = 0;          // of the random draws of this part

    CISTULA_HD Draw draw(uint64_t i) const { return Draw(i, seed); }
    CISTULA_HD Vec3<Real> point(uint64_t i) const { return Vec3<Real>(points[uint32_t(i)]); }
    CISTULA_HD Real extent() const { return scene.extent; }
};

}  // namespace cistula::verify
