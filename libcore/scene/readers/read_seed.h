// The text input of the program that Cistula grew from (docs/scene.md, "The text input"). Scenes are read through
// read_scene.h.
#pragma once

#include <string>

#include "scene/description/description.h"

namespace cistula {

/// Throws Error (usage): "label:line: expected ..., found ...". Does not set `source`.
SceneDescription read_seed_scene(const std::string& text, const std::string& label, const std::string& base_dir);

/// A valid input in the seed's text format, its most colorful one; reading it gives scenes/seed.json.
std::string seed_template();

}  // namespace cistula
