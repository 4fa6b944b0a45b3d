// The text input: the format of the program that Cistula grew from (docs/scene.md, "The text input"). Private:
// scenes are read through read_scene.h.
#pragma once

#include <string>

#include "scene/description/description.h"

namespace cistula {

/// Parses the text input, in either order of its parts. Throws Error (usage): "label:line: expected ..., found ...".
/// Does not set `source`.
SceneDescription read_text_input(const std::string& text, const std::string& label, const std::string& base_dir);

/// A valid, colorful input in the text input's format; it describes the same scene as scenes/seed.json.
std::string text_input_template();

}  // namespace cistula
