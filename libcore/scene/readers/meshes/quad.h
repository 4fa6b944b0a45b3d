// Conversion of a quad (four points in space) to two triangles.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "scene/description/description.h"

namespace cistula {

/// Tolerance for a quad's planarity and convexity, relative to its longer diagonal.
inline constexpr double quad_tolerance = 1e-6;

/// An error text unless the corners make a planar and strictly convex quad.
std::optional<std::string> quad_problem(const std::array<glm::dvec3, 4>& corners);

/// Triangles (0, 1, 2) and (0, 2, 3). The corners' uv are (0, 0), (1, 0), (1, 1), (0, 1), so a texture's top row runs
/// from the first corner to the second.
TrianglesObject quad_triangles(const std::array<glm::dvec3, 4>& corners);

}  // namespace cistula
