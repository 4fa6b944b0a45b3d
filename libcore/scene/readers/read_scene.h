// From a scene file, JSON or the text input of the seed, to its description. Meshes and textures are not opened here.
#pragma once

#include <string>

#include "scene/description/description.h"

namespace cistula {

/// Reads a scene file; "-" is standard input. Files named in it are relative to the file's folder, or to the working
/// directory for standard input. Throws Error: file where it cannot be read, usage where it is wrong.
SceneDescription read_scene(const std::string& path);

/// Reads a scene from a text in memory. `source_name` is for messages; `base_dir` is what file names are relative to
/// (empty: the working directory). JSON if the first character that is not white is '{', else the text input.
SceneDescription read_scene_text(const std::string& text, const std::string& source_name, const std::string& base_dir);

}  // namespace cistula
