// Topology of a mesh: degenerate triangles, shared edges, whether it encloses an inside.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "cistula/numerics/vec.h"
#include "scene/compile/scene_normalization.h"
#include "scene/description/mesh_source.h"

namespace cistula {

/// Topology of a mesh, in which vertices at one position count as one. A mesh is closed if every edge is shared by
/// exactly two triangles in opposite directions and the volume is not zero. Triangles are numbered among the kept ones;
/// half-edge 3 triangle + corner starts at that corner, in the source's winding.
struct MeshTopology {
    bool closed = false;
    bool flipped = false;  // closed, but wound clockwise seen from outside
    uint32_t count = 0;    // number of kept triangles
    bool all_kept = true;
    std::vector<uint32_t> kept;     // source numbers of the kept triangles, ascending; empty where all are
    std::vector<uint32_t> doubles;  // those of the triangles that `doubled` counts, ascending
    /// For each kept triangle whether it is wound unlike its neighbors, in a mesh that had a face's two sides and kept
    /// the wrong one; empty where none is.
    std::vector<uint8_t> turned;
    /// For each half-edge the next one along the same edge, in a ring; itself where the edge has no other triangle.
    std::vector<uint32_t> next_along_edge;

    uint32_t repeated_vertex = 0, not_finite = 0, zero_area = 0;  // triangles left out
    /// Triangles left out: an earlier one, or an earlier pair, has the same corners, in either winding.
    uint32_t doubled = 0;
    // Edges that prevent it from being closed: of one triangle, of more than two, of two that run through them alike.
    uint32_t open_edges = 0, crowded_edges = 0, turned_edges = 0;

    bool has_closed_edges() const { return open_edges == 0 && crowded_edges == 0 && turned_edges == 0; }
    uint32_t source_triangle(uint32_t triangle) const { return all_kept ? triangle : kept[triangle]; }
    /// Whether a kept triangle is rendered with the reverse of the source's winding.
    bool reverses(uint32_t triangle) const { return flipped != (!turned.empty() && turned[triangle] != 0); }
    /// A summary: "left out 3 triangles with a repeated vertex and 1 of zero area"; empty if there are none.
    std::string left_out() const;
    /// Why it is not closed: "3 open edges and 1 edge of more than two faces".
    std::string why_not_closed() const;
};

/// The topology of a mesh. Triangles with a repeated vertex or a coordinate that is not finite are left out; of several
/// with the same corners the first one stays, and of two pairs that are the halves of one flat quad, along either
/// diagonal, the first pair. Zero-area ones stay only in a mesh that would not be closed without them. Where triangles
/// were left out for others with their corners, those that stay are turned to face alike, if that closes the mesh.
/// Never throws for broken meshes. `vertices` of triangles must be in range.
MeshTopology find_topology(const MeshSource& mesh);

/// A mesh as it is rendered: in the frame, rounded to the scene's precision, wound counter-clockwise seen from outside.
class NormalizedMesh {
  public:
    NormalizedMesh(const MeshSource& source, const MeshTopology& topology, const SceneNormalization& normalization,
                   bool single_precision)
        : source_(source), topology_(topology), normalization_(normalization), single_(single_precision) {}

    uint32_t size() const { return topology_.count; }
    const MeshTopology& topology() const { return topology_; }

    /// Source indices of the vertices of a kept triangle.
    std::array<uint32_t, 3> corners(uint32_t triangle) const {
        std::array<uint32_t, 3> c = source_.triangles[topology_.source_triangle(triangle)];
        if (topology_.reverses(triangle)) std::swap(c[1], c[2]);
        return c;
    }
    Vec3<double> vertex(uint32_t number) const {
        const Vec3<double> p = normalization_.point(source_.vertices[number]);
        return single_ ? Vec3<double>(Vec3<float>(p)) : p;
    }
    std::array<Vec3<double>, 3> triangle(uint32_t number) const {
        const auto c = corners(number);
        return {vertex(c[0]), vertex(c[1]), vertex(c[2])};
    }

  private:
    const MeshSource& source_;
    const MeshTopology& topology_;
    const SceneNormalization& normalization_;
    bool single_;
};

}  // namespace cistula
