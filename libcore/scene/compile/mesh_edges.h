// The edges of a mesh, along which triangles meet. Private to libcore/scene.
#pragma once

#include <vector>

#include "scene/description/mesh_source.h"

namespace cistula {

/// The half-edges of triangles, by edges. Half-edge 3 triangle + corner starts at that corner.
struct MeshEdges {
    /// For each half-edge the next one along the same edge, in a ring that ascends; itself where it is alone.
    std::vector<uint32_t> next;
    uint32_t open = 0, crowded = 0;  // edges of one triangle, of more than two
};

/// The edges of triangles whose corners are numbers under `vertices`: equal numbers are one corner.
MeshEdges link_edges(std::span<const TriangleCorners> triangles, size_t vertices);

/// The edges of a mesh, all of whose vertices at one position count as one.
MeshEdges link_edges(const MeshSource& mesh);

/// Grows with the angle of (x, y), from 0 to 4.
double pseudo_angle(double x, double y);

}  // namespace cistula
