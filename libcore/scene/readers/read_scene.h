// Reads a scene file (JSON or the text input) into a description. Meshes and textures are not opened here.
#pragma once

#include <cstddef>
#include <string>

#include "scene/description/description.h"

namespace cistula {

/// The largest scene file. Reading one takes less than 2 GiB of memory (json_text.cpp).
inline constexpr size_t largest_scene_bytes = size_t{64} << 20;

/// Reads a scene file; "-" is standard input. Files named in it are relative to the file's folder, or to the working
/// directory for standard input. Throws Error: `file` if it cannot be read, `usage` if its contents
/// are wrong or there are too many of them.
SceneDescription read_scene(const std::string& path);

/// Parses a scene file's text. `source_name` is for messages; `base_dir` is the folder that file names are relative to
/// (empty: the working directory). JSON if the first non-white character is '{', else the text input.
SceneDescription read_scene_text(const std::string& text, const std::string& source_name, const std::string& base_dir);

}  // namespace cistula
