// PLY and OBJ files, read with Assimp; docs/meshes.md says which of their contents are used.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/description/description.h"
#include "scene/description/mesh_source.h"

namespace cistula {

/// The triangles of a file that share one material; with uvs where the file has them.
struct MeshPart {
    std::string name;
    MeshSource mesh;
    std::optional<MaterialDescription> material;  // OBJ with a material library
};

/// Reads a mesh file; its parts in file order, rotated, scaled and translated. `place` opens the messages. Throws
/// Error(ExitCode::file).
std::vector<MeshPart> read_mesh(const MeshObject& object, const std::string& place);

}  // namespace cistula
