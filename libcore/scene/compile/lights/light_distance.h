// How near to lights there is anything that they can light (docs/rules.md, 7). Private to libcore/scene.
#pragma once

#include <array>
#include <vector>

#include "scene/compile/lights/compile_lights.h"
#include "scene/compile/meshes/mesh_apex.h"

namespace cistula {

/// Lights with falloff that come nearer than this to a solid's box, times M, and have no larger radius, are bounded by
/// their distance to its faces.
inline constexpr double small_reach = 0x1p-12;

/// The distance of a point from a triangle; of one without area from its edges.
double distance_to_triangle(const std::array<glm::dvec3, 3>& corner, const glm::dvec3& p);

/// A light that is bounded by its distance to a solid's faces, which is no less than this.
struct LightDistance {
    uint32_t light;
    double distance;
};

/// The distance of a point from a box; 0 inside.
double distance_to_box(const Box& box, const glm::dvec3& p);

/// The distances of lights from a convex solid's faces, in their order. `rounding`: 32 u M, more than rounding moves
/// faces and what lies on them.
std::vector<LightDistance> light_distances(const std::vector<NormalizedLight>& lights, const ConvexSolid& solid,
                                           const LightFaces& faces, double extent, double rounding);

/// The distances of lights from a ball's surface.
std::vector<LightDistance> light_distances(const std::vector<NormalizedLight>& lights, const PlacedBall& ball,
                                           double extent, double rounding);

/// The distances of lights from a disk; of a plane without end all, wherever they are.
std::vector<LightDistance> light_distances(const std::vector<NormalizedLight>& lights, const PlacedDisk& disk,
                                           const LightFaces& faces, double extent, double rounding);

/// The distances of lights from a mesh's triangles, found through the tree over their groups; they may be stated as
/// half of what they are.
std::vector<LightDistance> light_distances(const std::vector<NormalizedLight>& lights, const NormalizedMesh& mesh,
                                           const Groups& groups, const Tree& tree, uint32_t solid,
                                           uint32_t first_triangle, const LightFaces& faces, double extent,
                                           double rounding);

}  // namespace cistula
