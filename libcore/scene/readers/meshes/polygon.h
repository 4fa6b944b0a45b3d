// Polygons in space: their triangulation, that of quads, and which are there more than once.
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/description/description.h"
#include "scene/readers/meshes/polygon_mesh.h"

namespace cistula {

/// Corners up to which ears are clipped in order, so that convex polygons become a fan about their first corner. Of
/// larger polygons the ear with the shortest diagonal is clipped first: its triangles are near one another, and few are
/// slivers.
inline constexpr size_t most_corners_in_order = 64;

/// Appends size - 2 triangles with the polygon's winding, by ear clipping, in O(n log n) for polygons that do not fold
/// back on themselves everywhere. `corners` are indices into `vertices`; fewer than 3 give nothing. Never fails: if
/// there is no ear (the polygon crosses itself), the next corner is clipped all the same.
void append_polygon(std::span<const glm::dvec3> vertices, std::span<const uint32_t> corners,
                    std::vector<std::array<uint32_t, 3>>& triangles);

/// For each polygon of a mesh whose vertices are placed, whether an earlier one has the same corners in the same cyclic
/// order or in its reverse; corners at equal positions are the same. Polygons with fewer than four corners, or one that
/// is not finite, never count: find_pieces compares triangles.
std::vector<bool> doubled_polygons(std::span<const glm::dvec3> vertices, const PolygonMesh& mesh);

/// Tolerance for a quad's planarity and convexity, relative to its longer diagonal.
inline constexpr double quad_tolerance = 1e-6;

/// An error text unless the corners make a planar and strictly convex quad.
std::optional<std::string> quad_problem(const std::array<glm::dvec3, 4>& corners);

/// Triangles (0, 1, 2) and (0, 2, 3). The corners' uv are (0, 0), (1, 0), (1, 1), (0, 1), so a texture's top row runs
/// from the first corner to the second.
TrianglesObject quad_triangles(const std::array<glm::dvec3, 4>& corners);

}  // namespace cistula
