// Flat faces of solids that come near another solid: faces of convex solids, and triangles. Private to libcore/scene.
#pragma once

#include <vector>

#include "scene/compile/compile_solids.h"
#include "scene/compile/compiled_scene.h"

namespace cistula {

struct Patch {
    uint32_t solid;
    int32_t convex;  // index among the convex solids, or -1
    uint32_t face;   // 2 slab + side, or the triangle's scene-wide number
    std::vector<glm::dvec3> corners;
    Box box;
    glm::dvec3 normal;  // unit
    double offset;
    double area;
    bool with_own = false;  // of a sheet that may overlap itself: compared with patches of its own solid, too

    /// The largest distance of another patch's corners from this one's plane.
    double farthest(const Patch& other) const;
};

/// The mean of a polygon's corners.
glm::dvec3 middle(const std::vector<glm::dvec3>& corners);

/// Whether two boxes, each grown by `pad`, touch.
bool touch(const Box& a, const Box& b, double pad);
Box padded(const Box& box, double pad);

/// Whether two patches of one plane overlap by more than `least` in every direction.
bool overlap(const Patch& a, const Patch& b, double least);

/// The largest open sheet that is searched for faces of its own that overlap, in triangles.
constexpr uint32_t most_with_own = 4096;

/// The faces of all solids that come within `pad` of another solid's box, and all triangles of sheets of up to
/// most_with_own, in the order of solids. Triangles have the corners that the tracer sees. Empty where no two
/// boxes touch and no sheet can overlap itself.
template <class Real>
std::vector<Patch> touching_patches(const CompiledScene<Real>& scene, const std::vector<ConvexSolid>& convex,
                                    const std::vector<Box>& boxes, double pad);

}  // namespace cistula
