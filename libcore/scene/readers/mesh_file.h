// Mesh files as triangles; docs/meshes.md says which of their contents are used.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/description/description.h"
#include "scene/description/mesh_source.h"
#include "scene/readers/polygon_mesh.h"

namespace cistula {

/// The triangles of a file that share one material; with uvs where the file has them.
struct MeshPart {
    std::string name;
    MeshSource mesh;
    std::optional<MaterialDescription> material;  // OBJ with a material library
};

/// The triangles of what a file says, in file order, rotated, scaled and translated; v counts from the top. Polygons
/// that are there twice and parts without triangles are left out.
std::vector<MeshPart> parts_of(std::vector<PolygonMesh> meshes, const MeshObject& object);

/// Reads a mesh file; its parts in file order, at least one. `place` opens the messages; adds warnings, and to `files`
/// the mesh and the files that it names, material libraries and their maps. Throws Error(ExitCode::file).
std::vector<MeshPart> read_mesh(const MeshObject& object, const std::string& place, std::vector<std::string>& warnings,
                                std::vector<std::string>* files = nullptr);

}  // namespace cistula
