// OpenEXR files as they stand: all parts, levels, channels and attributes.
#pragma once

#include <string>

#include "scene/image/stored_picture.h"

namespace cistula {

/// Reads all of a file of one or several parts, in scan lines or tiles. Throws Error(ExitCode::file); deep data is
/// refused.
StoredFile read_stored_exr(const std::string& path);

}  // namespace cistula
