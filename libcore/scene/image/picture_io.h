// Reads textures and writes previews in any supported format.
#pragma once

#include <string>

#include "scene/image/picture.h"

namespace cistula {

/// Reads a texture as linear RGB. OpenEXR (by extension or by content) and raw pictures, .data and .out, are read by
/// every build, other formats through OpenImageIO. Integer samples are decoded from sRGB, floating-point ones are
/// linear. Every texel is finite and not negative. Throws Error(ExitCode::file).
ColorPicture read_texture(const std::string& path);

/// Writes an 8-bit sRGB PNG atomically, clamped to [0, 1]. Throws Error(ExitCode::file).
void write_preview(const std::string& path, const ColorPicture& linear);

}  // namespace cistula
