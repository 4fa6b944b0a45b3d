// What a mesh file says, or a program that has no file, before its polygons are cut and placed.
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

/// Polygons of any number of corners, one after another, or triangles alone. Corners are indices into `vertices`.
struct PolygonMesh {
    std::string name;
    std::optional<MaterialDescription> material;
    std::vector<glm::dvec3> vertices;
    std::vector<glm::dvec2> uvs;      // one per vertex, or none; in MeshData, v counts from the top of the picture
    std::vector<glm::dvec3> normals;  // one per vertex, or none; of any length, 0 where the file gives none
    std::vector<uint32_t> corners;    // of all polygons
    std::vector<size_t> ends;         // of each polygon, in `corners`; none: triangles
    /// One per corner, or none, of the readers alone: they replace `uvs`. Those of the last corners may lack, and are
    /// 0.
    std::vector<glm::dvec2> corner_uvs;

    size_t size() const { return ends.empty() ? corners.size() / 3 : ends.size(); }
    std::span<const uint32_t> polygon(size_t number) const {
        if (ends.empty()) return std::span(corners).subspan(3 * number, 3);
        const size_t first = number == 0 ? 0 : ends[number - 1];
        return std::span(corners).subspan(first, ends[number] - first);
    }
};

/// All of a mesh: groups that have a material each, or none.
struct MeshData {
    std::vector<PolygonMesh> groups;    // in file order
    std::vector<std::string> warnings;  // of reading the file, which they name
    std::vector<std::string> files;     // the mesh's, its material libraries and their maps, which may be missing
};

}  // namespace cistula
