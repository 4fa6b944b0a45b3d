// The input of a compilation: a description with its meshes read and its materials numbered. Private to libcore/scene.
#pragma once

#include <string>
#include <vector>

#include "scene/base/error.h"
#include "scene/description/description.h"
#include "scene/description/mesh_source.h"

namespace cistula {

/// The source of one compiled Solid.
struct SourceSolid {
    std::string name, place;
    uint32_t material = 0;                  // index into SceneSource::materials
    const SolidObject* platonic = nullptr;  // null: the solid is `mesh`
    MeshSource mesh;
};

struct SceneSource {
    const SceneDescription* description = nullptr;
    std::vector<MaterialDescription> materials;  // those of the description, then those from mesh files
    std::vector<SourceSolid> solids;             // in file order
};

/// Checks every number that affects the compiled scene, and reads the meshes. Throws Error with the place.
SceneSource gather_scene(const SceneDescription& description);

/// An error with its place: "scene.json: /objects/2: TEXT".
Error scene_error(const SceneDescription& description, const std::string& place, const std::string& text);

}  // namespace cistula
