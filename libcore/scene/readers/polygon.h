// Polygons in space to triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace cistula {

/// Appends size - 2 triangles with the polygon's winding, by cutting ears; convex ones become a fan about their first
/// corner. `corners` are numbers of `vertices`; fewer than 3 give nothing. Never fails: where no ear is found (a
/// polygon that crosses itself), the next corner is cut all the same.
void append_polygon(std::span<const glm::dvec3> vertices, std::vector<uint32_t> corners,
                    std::vector<std::array<uint32_t, 3>>& triangles);

}  // namespace cistula
