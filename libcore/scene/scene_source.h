// The solids of a description with all that they come from at hand: meshes read, materials numbered. Inside
// libcore/scene.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "scene/description.h"
#include "scene/error.h"

namespace cistula {

/// Triangles in scene units, owned (read from a file) or lent by the description. Moves keep the spans valid.
struct MeshSource {
    std::span<const glm::dvec3> vertices;
    std::span<const std::array<uint32_t, 3>> triangles;
    std::span<const glm::dvec2> uvs;  // one a vertex, or none

    std::vector<glm::dvec3> owned_vertices;
    std::vector<std::array<uint32_t, 3>> owned_triangles;
    std::vector<glm::dvec2> owned_uvs;

    MeshSource() = default;
    MeshSource(MeshSource&&) = default;
    MeshSource& operator=(MeshSource&&) = default;

    void view_owned() {
        vertices = owned_vertices;
        triangles = owned_triangles;
        uvs = owned_uvs;
    }
};

/// What one Solid is made from.
struct SourceSolid {
    std::string name, place;
    uint32_t material = 0;                  // into SceneSource::materials
    const SolidObject* platonic = nullptr;  // else mesh
    MeshSource mesh;
};

struct SceneSource {
    const SceneDescription* description = nullptr;
    std::vector<MaterialDescription> materials;  // the description's, then those that meshes brought
    std::vector<SourceSolid> solids;             // in file order
};

/// Checks every number that the compiled scene depends on, and reads the meshes. Throws Error with the place.
SceneSource gather_scene(const SceneDescription& description);

/// "scene.json: /objects/2: TEXT".
Error scene_error(const SceneDescription& description, const std::string& place, const std::string& text);

}  // namespace cistula
