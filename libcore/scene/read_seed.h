// The text input of the program that Cistula grew from (docs/scene.md, "The seed's text"). Use read_scene.h.
#pragma once

#include <string>

#include "scene/description.h"

namespace cistula {

/// Throws Error (usage): "label:line: expected ..., found ...". Does not set `source`.
SceneDescription read_seed_scene(const std::string& text, const std::string& label, const std::string& base_dir);

}  // namespace cistula
