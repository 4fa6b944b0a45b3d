// The triangles of a mesh in clusters of up to eight neighbors, with apex points that keep rays leaving a triangle off
// its mesh (docs/rules.md, 2): an apex over each side of every triangle, so low that no part of the mesh lies between
// it and the triangle. Private to libcore/scene.
#pragma once

#include <vector>

#include "cistula/model/scene_view.h"
#include "scene/compile/meshes/mesh_edges.h"
#include "scene/compile/meshes/normalized_mesh.h"
#include "scene/trees/tree_build.h"

namespace cistula {

/// Apex heights of a mesh's triangles: [0] inside (the side that normals point away from), [1] outside. Lengths in the
/// frame.
struct ApexHeights {
    std::vector<float> side[2];
};

/// Initial heights: inradius / 8 * min(1, tan(a / 2)), a the smallest dihedral angle on that side; edges without a
/// neighbor are ignored.
ApexHeights apex_heights(const NormalizedMesh& mesh, const MeshEdges& edges);

/// Greatest number of times an apex is halved; its lowest height is 2^-24 of the first.
inline constexpr int most_halvings = 24;

/// Numbers of triangle sides.
struct ApexFaults {
    uint32_t crossed = 0;  // another triangle passes through the triangle itself
    uint32_t unchecked =
        0;  // not crossed as far as was seen, but with too many triangles around to look at all of them
};

/// Halves heights until no other triangle of the mesh intersects the tetrahedra over a triangle: neither the edges to
/// the apex nor the sides between them. A triangle that still intersects at the lowest height passes through the base
/// itself and is ignored. The work is bounded, however tangled the mesh is (decision 0034). Throws Error (interrupted).
ApexFaults check_apexes(const NormalizedMesh& mesh, const Groups& groups, const Tree& tree, ApexHeights& heights,
                        StopSignal stop = {});

Groups group_triangles(const NormalizedMesh& mesh, StopSignal stop = {});

/// A tree over the groups' boxes, for queries during compilation; its items are group numbers.
Tree group_tree(const NormalizedMesh& mesh, const Groups& groups);

/// Appends one cluster per group. Unused lanes hold a corner of lane 0 three times.
template <class Real>
void append_clusters(const NormalizedMesh& mesh, const Groups& groups, const ApexHeights& heights, uint32_t solid,
                     uint32_t first_triangle, std::vector<Cluster<Real>>& clusters);

}  // namespace cistula
