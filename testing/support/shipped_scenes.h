// Scenes of scenes/, by their names.
#pragma once

#include <string>

#include "scene/description/description.h"
#include "scene/readers/read_scene.h"

namespace cistula::test {

inline const std::string scene_folder = CISTULA_SOURCE_DIR "/scenes";

/// What scenes/NAME.json describes; names of a subfolder as in "hard/furnace".
inline SceneDescription shipped_scene(const std::string& name) {
    return read_scene(scene_folder + "/" + name + ".json");
}

}  // namespace cistula::test
