// What the targets of mesh files share.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "scene/base/error.h"
#include "scene/compile/mesh_topology.h"
#include "scene/readers/mesh_file.h"

namespace cistula::fuzz {

inline void require(bool holds) {
    if (!holds) std::abort();
}

/// Aborts unless an error is one line for the user, about a file.
inline void check_error(const Error& error) {
    require(error.code() == ExitCode::file);
    for (const char* c = error.what(); *c; ++c) require(static_cast<unsigned char>(*c) >= 0x20);
}

/// Aborts unless meshes are what polygon_mesh.h says; then makes triangles of them and looks at their topology.
inline void check_meshes(std::vector<PolygonMesh> meshes) {
    for (const PolygonMesh& mesh : meshes) {
        require(mesh.uvs.empty() || mesh.uvs.size() == mesh.vertices.size());
        require(mesh.corner_uvs.size() <= mesh.corners.size());
        for (const uint32_t corner : mesh.corners) require(corner < mesh.vertices.size());
        size_t end = 0;
        for (const size_t next : mesh.ends) {
            require(next >= end);
            end = next;
        }
        require(end == mesh.corners.size());
    }
    for (const MeshPart& part : parts_of(std::move(meshes), {})) {
        for (const auto& t : part.mesh.triangles)
            for (const uint32_t corner : t) require(corner < part.mesh.vertices.size());
        find_topology(part.mesh);
    }
}

}  // namespace cistula::fuzz
