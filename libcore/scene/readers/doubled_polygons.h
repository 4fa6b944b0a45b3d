// Polygons of a mesh file that are there more than once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace cistula {

/// For each polygon, whether an earlier one has the same corners in the same cyclic order or in its reverse; corners at
/// equal positions are the same. Polygons with fewer than four corners, or one that is not finite, never count:
/// find_pieces compares triangles.
std::vector<bool> doubled_polygons(std::span<const glm::dvec3> vertices,
                                   const std::vector<std::span<const uint32_t>>& polygons);

}  // namespace cistula
