// Which half-edges of a mesh are neighbors in a closed surface (docs/rules.md, 2). Private to libcore/scene.
#pragma once

#include "scene/compile/meshes/mesh_edges.h"

namespace cistula {

/// Half-edges in pairs. Where an edge has more than two triangles, a pair bounds what lies between two of them.
struct EdgePairs {
    std::vector<uint32_t> mate;  // of each half-edge, numbered as in MeshEdges; none where it has none
    /// Triangles that were paired by their winding at edges where faces coincide: right only if all are turned alike.
    std::vector<uint32_t> tied;
    uint32_t open = 0, crowded = 0;  // edges that are not paired: of one triangle, of three or more

    static constexpr uint32_t none = 0xffffffffu;
    bool complete() const { return open == 0 && crowded == 0; }
};

/// What becomes of edges of more than two triangles.
enum class AtCrowdedEdges { none, pairs };

/// The pairs of triangles whose corners are numbers of vertices, or these plus the number of all.
EdgePairs pair_edges(std::span<const glm::dvec3> vertices, std::span<const TriangleCorners> triangles,
                     AtCrowdedEdges crowded);

/// For each triangle 1 if every edge of all triangles that are joined to it has two: it is closed without the others.
std::vector<uint8_t> closed_without_others(std::span<const TriangleCorners> triangles, size_t vertices);

}  // namespace cistula
