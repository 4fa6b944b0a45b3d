// Mesh files as triangles; docs/meshes.md says which of their contents are used.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/description/description.h"
#include "scene/description/mesh_source.h"
#include "scene/readers/meshes/polygon_mesh.h"

namespace cistula {

/// The triangles of a mesh that share one material; with uvs and normals where the mesh has them.
struct MeshPart {
    std::string name;
    MeshSource mesh;
    std::optional<MaterialDescription> material;  // OBJ with a material library
};

/// What was read of a mesh file, whose v counts from the bottom of the picture, as a mesh.
MeshData mesh_data(std::vector<PolygonMesh> groups);

/// Reads a mesh file: groups in file order, with a polygon at least. Throws Error: (file) that names it, (interrupted).
MeshData read_mesh(const std::string& file, StopSignal stop = {});

/// The triangles of a mesh, in file order, rotated, scaled and translated. Polygons that are there twice and groups
/// without triangles are left out.
std::vector<MeshPart> placed_parts(const MeshData& data, const MeshObject& object);

}  // namespace cistula
