// PLY files: text and binary, polygons and triangle strips. docs/meshes.md says which of their contents are used.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/readers/meshes/polygon_mesh.h"

namespace cistula {

/// Throws as read_ply() does if these are not the first bytes of a PLY file.
void check_ply_start(std::string_view start, const std::string& label);

/// The mesh in a PLY file's bytes, with all of its vertices in file order. Throws Error(file): `label`, which names the
/// file, then the line or the byte, what is wrong and what would be right. Adds a warning where vertices have normals.
PolygonMesh read_ply(std::string_view bytes, const std::string& label, std::vector<std::string>& warnings);

}  // namespace cistula
