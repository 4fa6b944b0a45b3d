// Where leaving rays start toward (docs/rules.md, 2): an apex over every side of every triangle, so low that nothing of
// the mesh stands between it and the triangle.
#pragma once

#include <vector>

#include "scene/compile/mesh_topology.h"
#include "scene/trees/tree_build.h"

namespace cistula {

/// Heights per kept triangle: [0] inside (the side that normals point away from), [1] outside. Lengths in the frame.
struct ApexHeights {
    std::vector<float> side[2];
};

/// inradius / 8 * min(1, tan(a / 2)), a the least dihedral angle on that side; edges without a neighbor do not count.
ApexHeights apex_heights(const FramedMesh& mesh);

/// An apex is halved at most this often, so 2^-24 of its first height is the floor.
inline constexpr int most_halvings = 24;

/// Halves heights until no other triangle of the mesh reaches between a triangle and its apexes: not across the
/// segments to the corners, not through the sides between them. What blocks even the lowest apex goes through the
/// triangle itself and is passed over. Returns how many sides of triangles have that.
uint32_t check_apexes(const FramedMesh& mesh, const Groups& groups, const Tree& tree, ApexHeights& heights);

}  // namespace cistula
