// The seed's text input: the format of the program that Cistula grew from (docs/scene.md, "The text input"). Private:
// scenes are read through read_scene.h.
#pragma once

#include <string>

#include "scene/description/description.h"

namespace cistula {

/// Parses the seed's text. Throws Error (usage): "label:line: expected ..., found ...". Does not set `source`.
SceneDescription read_seed_scene(const std::string& text, const std::string& label, const std::string& base_dir);

/// A valid, colorful input in the seed's text format; it describes the same scene as scenes/seed.json.
std::string seed_template();

}  // namespace cistula
