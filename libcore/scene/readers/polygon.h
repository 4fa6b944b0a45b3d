// Triangulation of polygons in space.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace cistula {

/// Appends size - 2 triangles with the polygon's winding, by ear clipping; convex polygons become a fan about their
/// first corner. `corners` are indices into `vertices`; fewer than 3 give nothing. Never fails: if there is no ear (the
/// polygon crosses itself), the next corner is clipped all the same.
void append_polygon(std::span<const glm::dvec3> vertices, std::vector<uint32_t> corners,
                    std::vector<std::array<uint32_t, 3>>& triangles);

}  // namespace cistula
