// What the targets of mesh files share.
#pragma once

#include <vector>

#include "checks.h"
#include "scene/compile/meshes/mesh_pieces.h"
#include "scene/readers/meshes/mesh_file.h"

namespace cistula::fuzz {

/// Aborts unless meshes are what polygon_mesh.h says; then makes triangles of them and looks for their insides.
inline void check_meshes(std::vector<PolygonMesh> meshes) {
    for (const PolygonMesh& mesh : meshes) {
        require(mesh.uvs.empty() || mesh.uvs.size() == mesh.vertices.size());
        require(mesh.normals.empty() || mesh.normals.size() == mesh.vertices.size());
        require(mesh.corner_uvs.size() <= mesh.corners.size());
        for (const uint32_t corner : mesh.corners) require(corner < mesh.vertices.size());
        size_t end = 0;
        for (const size_t next : mesh.ends) {
            require(next >= end);
            end = next;
        }
        require(end == mesh.corners.size());
    }
    for (const MeshPart& part : placed_parts(mesh_data(std::move(meshes)), {})) {
        for (const auto& t : part.mesh.triangles)
            for (const uint32_t corner : t) require(corner < part.mesh.vertices.size());
        find_pieces(part.mesh);
    }
}

}  // namespace cistula::fuzz
