// The solids of a description with all that they come from at hand: meshes read, materials numbered. Inside
// libcore/scene.
#pragma once

#include <string>
#include <vector>

#include "scene/base/error.h"
#include "scene/description/description.h"
#include "scene/description/mesh_source.h"

namespace cistula {

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
