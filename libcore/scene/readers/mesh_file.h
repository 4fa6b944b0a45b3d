// PLY and OBJ files, read with Assimp. docs/meshes.md says what is taken from them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/description/description.h"
#include "scene/description/mesh_source.h"

namespace cistula {

/// The triangles of one material of a file; uvs where the file has them.
struct MeshPart {
    std::string name;
    MeshSource mesh;
    std::optional<MaterialDescription> material;  // OBJ with a material library
};

/// Parts in file order, transformed: rotated, scaled, moved. `place` opens the messages. Throws Error(ExitCode::file).
std::vector<MeshPart> read_mesh(const MeshObject& object, const std::string& place);

}  // namespace cistula
