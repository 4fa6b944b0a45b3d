// Triangles of a mesh that are there more than once. Private to libcore/scene.
#pragma once

#include "scene/description/mesh_source.h"

namespace cistula {

/// For each triangle 1 if an earlier one has the same three corners in any order, else 0. Corners are numbers under
/// `vertices`.
std::vector<uint8_t> doubled_triangles(std::span<const TriangleCorners> triangles, size_t vertices);

/// For each triangle 1 if it is half of a flat quad that earlier halves cover, along the other diagonal, else 0. Flat:
/// a corner lies 2^-20 of the longest side at most from the plane of the others, as coordinates in single precision or
/// with seven digits do.
std::vector<uint8_t> crossed_halves(std::span<const glm::dvec3> vertices, std::span<const TriangleCorners> triangles);

}  // namespace cistula
