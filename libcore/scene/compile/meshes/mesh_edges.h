// The edges of a mesh, along which triangles meet, and which of their halves are neighbors in a closed surface
// (docs/rules.md, 2). Private to libcore/scene.
#pragma once

#include <vector>

#include "scene/description/mesh_source.h"

namespace cistula {

/// The half-edges of triangles, by edges. Half-edge 3 triangle + corner starts at that corner.
struct MeshEdges {
    /// For each half-edge the next one along the same edge, in a ring that ascends; itself where it is alone.
    std::vector<uint32_t> next;
    // edges of one triangle, of more than two
    uint32_t open = 0;
    uint32_t crowded = 0;
};

/// The edges of triangles whose corners are numbers under `vertices`: equal numbers are one corner.
MeshEdges link_edges(std::span<const TriangleCorners> triangles, size_t vertices);

/// The edges of a mesh, all of whose vertices at one position count as one.
MeshEdges link_edges(const MeshSource& mesh);

/// Grows with the angle of (x, y), from 0 to 4.
double pseudo_angle(double x, double y);

/// For each triangle 1 if an earlier one has the same three corners in any order, else 0. Corners are numbers under
/// `vertices`.
std::vector<uint8_t> doubled_triangles(std::span<const TriangleCorners> triangles, size_t vertices);

/// For each triangle 1 if it is half of a flat quad that earlier halves cover, along the other diagonal, else 0. Flat:
/// a corner lies 2^-20 of the longest side at most from the plane of the others, as coordinates in single precision or
/// with seven digits do.
std::vector<uint8_t> crossed_halves(std::span<const glm::dvec3> vertices, std::span<const TriangleCorners> triangles);

/// Half-edges in pairs. Where an edge has more than two triangles, a pair bounds what lies between two of them.
struct EdgePairs {
    std::vector<uint32_t> mate;  // of each half-edge, numbered as in MeshEdges; none where it has none
    /// Triangles that were paired by their winding at edges where faces coincide: right only if all are turned alike.
    std::vector<uint32_t> tied;
    // edges that are not paired: of one triangle, of three or more
    uint32_t open = 0;
    uint32_t crowded = 0;

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
