// What a ray of a case is made of, the same on host and device: the scene, lists that the part brings, a source of
// draws.
#pragma once

#include "cistula/traversal/bvh.h"
#include "testing/draw/draw.h"

namespace cistula::verify {

using parity::Draw;

/// A part's scene and lists, where the code that runs can read them. All lengths are in the scene's frame.
template <class Real>
struct Setup {
    SceneView<Real> scene;
    Span<Vec3<double>> points;  // targets, as Real's vertices are before they are rounded
    Span<double> numbers;       // whatever the case wants
    double factor = 1;          // frame lengths per world length, a power of two
    uint64_t seed = 0;          // of this part

    CISTULA_HD Draw draw(uint64_t i) const { return Draw(i, seed); }
    CISTULA_HD Vec3<Real> point(uint64_t i) const { return Vec3<Real>(points[uint32_t(i)]); }
    CISTULA_HD Real extent() const { return scene.extent; }
};

}  // namespace cistula::verify
