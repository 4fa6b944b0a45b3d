// The triangles of one mesh, wherever they come from.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/description/coordinate_rounding.h"

namespace cistula {

/// The corners of a triangle, by the numbers of its mesh's vertices.
using TriangleCorners = std::array<uint32_t, 3>;

/// Triangles in scene units: owned (read from a file) or borrowed from the description. Moving it keeps the spans
/// valid.
struct MeshSource {
    std::span<const glm::dvec3> vertices;
    std::span<const TriangleCorners> triangles;
    std::span<const glm::dvec2> uvs;      // one per vertex, or none
    std::span<const glm::dvec3> normals;  // one per vertex, or none; of any length
    uint32_t doubled_polygons = 0;        // of the file, left out since an earlier one has the same corners

    CoordinateRounding rounding;  // of the vertices, in scene units

    std::vector<glm::dvec3> owned_vertices;
    std::vector<TriangleCorners> owned_triangles;
    std::vector<glm::dvec2> owned_uvs;
    std::vector<glm::dvec3> owned_normals;

    MeshSource() = default;
    MeshSource(MeshSource&&) = default;
    MeshSource& operator=(MeshSource&&) = default;

    void view_owned() {
        vertices = owned_vertices;
        triangles = owned_triangles;
        uvs = owned_uvs;
        normals = owned_normals;
    }
    /// These triangles, borrowed from this, which must outlive them.
    MeshSource borrowed() const {
        MeshSource mesh;
        mesh.vertices = vertices;
        mesh.triangles = triangles;
        mesh.uvs = uvs;
        mesh.doubled_polygons = doubled_polygons;
        mesh.rounding = rounding;
        return mesh;
    }
    /// These triangles, owned.
    MeshSource copy() const {
        MeshSource mesh = borrowed();
        mesh.owned_vertices.assign(vertices.begin(), vertices.end());
        mesh.owned_triangles.assign(triangles.begin(), triangles.end());
        mesh.owned_uvs.assign(uvs.begin(), uvs.end());
        mesh.view_owned();
        return mesh;
    }
};

inline constexpr uint32_t no_vertex = 0xffffffffu;

/// For every vertex the lowest-numbered one at exactly its position (-0 equals 0); no_vertex if it is not finite.
std::vector<uint32_t> weld(std::span<const glm::dvec3> vertices);

}  // namespace cistula
