// Raw pictures, .data and .out: two little-endian int32, width and height, then RGBA bytes, top row first.
#pragma once

#include <string>

#include "image/color/file_colors.h"
#include "image/picture/picture.h"
#include "image/reader/texture_limits.h"

namespace cistula {

/// Reads a .data (or .out) file whose texels take at most `left` bytes, of the `limit` for all textures; its bytes are
/// decoded, its alpha is ignored. Throws Error (file).
ColorPicture read_raw_picture(const std::string& path, uint64_t left = no_texture_limit,
                              uint64_t limit = no_texture_limit,
                              const FileEncoding& encoding = file_encoding("srgb", {}, false));

/// Writes a frame atomically: clamped to [0, 1], sRGB bytes, alpha 255. Throws Error (file).
void write_raw_picture(const std::string& path, const ColorPicture& linear);

}  // namespace cistula
