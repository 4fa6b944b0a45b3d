// Groups triangles into clusters of up to eight neighbors. Private to libcore/scene.
#pragma once

#include "cistula/model/scene_view.h"
#include "scene/compile/meshes/mesh_apex.h"
#include "scene/compile/meshes/normalized_mesh.h"
#include "scene/trees/tree_build.h"

namespace cistula {

Groups group_triangles(const NormalizedMesh& mesh, StopSignal stop = {});

/// A tree over the groups' boxes, for queries during compilation; its items are group numbers.
Tree group_tree(const NormalizedMesh& mesh, const Groups& groups);

/// Appends one cluster per group. Unused lanes hold a corner of lane 0 three times.
template <class Real>
void append_clusters(const NormalizedMesh& mesh, const Groups& groups, const ApexHeights& heights, uint32_t solid,
                     uint32_t first_triangle, std::vector<Cluster<Real>>& clusters);

}  // namespace cistula
