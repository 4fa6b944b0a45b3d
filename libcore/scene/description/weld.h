// Vertices of a mesh by their positions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace cistula {

inline constexpr uint32_t no_vertex = 0xffffffffu;

/// For every vertex the lowest-numbered one at exactly its position (-0 equals 0); no_vertex if it is not finite.
std::vector<uint32_t> weld(std::span<const glm::dvec3> vertices);

}  // namespace cistula
