// What a mesh file says, before its polygons are cut and placed.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/description/description.h"

namespace cistula {

/// Polygons of any number of corners, one after another. Corners are indices into `vertices`, and in range.
struct PolygonMesh {
    std::string name;
    std::optional<MaterialDescription> material;
    std::vector<glm::dvec3> vertices;
    std::vector<glm::dvec2> uvs;    // one per vertex, or none; v counts from the bottom of the picture
    std::vector<uint32_t> corners;  // of all polygons
    std::vector<size_t> ends;       // of each polygon, in `corners`
    /// One per corner, or none: they replace `uvs`. Those of the last corners may lack, and are 0.
    std::vector<glm::dvec2> corner_uvs;

    std::span<const uint32_t> polygon(size_t number) const {
        const size_t first = number == 0 ? 0 : ends[number - 1];
        return std::span(corners).subspan(first, ends[number] - first);
    }
};

}  // namespace cistula
