// Names in the scene file for the indices of a compiled scene, for reports.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "scene/compile/scene_source.h"

namespace cistula {

struct SceneNames {
    struct Named {
        std::string name;
        std::string place;  // JSON pointer in the file, "/objects/2"; empty: it has no entry of its own
    };
    std::vector<Named> solids;          // as CompiledScene::solids
    std::vector<Named> materials;       // as CompiledScene::materials
    std::vector<Named> lights;          // as CompiledScene::lights
    std::vector<Named> visible_lights;  // as CompiledScene::visible_lights
};

/// What tells scenes apart: for each frame a hash of everything that affects its image, except camera and settings.
class FrameHashes {
  public:
    /// Hashes of a scene in which nothing moves: one for all frames.
    FrameHashes(std::string still = "") : still_(std::move(still)) {}
    /// Hashes of one that changes, each found when it is asked for.
    explicit FrameHashes(std::function<std::string(int)> moving) : moving_(std::move(moving)) {}

    std::string of(int frame) const { return moving_ ? moving_(frame) : still_; }

  private:
    std::string still_;
    std::function<std::string(int)> moving_;
};

/// The names of what layers tell apart, by the numbers of the compiled scene.
struct LayerNames {
    std::vector<std::string> objects, materials;  // of solids and of materials
    std::vector<uint32_t> object_materials;       // the material of each solid
    std::vector<std::string> visible_lights;      // the group of each
    std::vector<std::string> light_groups;        // each once
};

/// The names of a scene's parts.
SceneNames name_scene(const SceneSource& source);

}  // namespace cistula
