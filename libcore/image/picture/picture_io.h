// Reads textures and writes previews in any supported format; PNG files in memory, through libpng.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "image/picture/picture.h"

namespace cistula {

/// Reads one texture as linear Rec. 709 by a TextureReader (picture_reader.h) of its own, within the default limits;
/// every texel must be finite and not negative. `encoding` says what its numbers mean, as a texture's key "colorspace"
/// does (docs/scene.md). Other pictures than .data and .out need the program cistula-read-picture, and those that are
/// not OpenEXR the module libcistula_oiio.so beside it. Starting it takes a while, so one TextureReader for several is
/// better. Throws Error (file).
ColorPicture read_texture(const std::string& path, std::string_view encoding = {});

/// Writes an 8-bit sRGB PNG atomically, clamped to [0, 1]. Throws Error (file).
void write_preview(const std::string& path, const ColorPicture& linear);

/// An 8-bit sRGB PNG of a linear RGB picture, clamped to [0, 1], with its alpha, if it has one. Throws
/// std::runtime_error with libpng's reason, for instance for pictures of 4 GiB and more.
std::string encode_png(const ColorPicture& linear);

}  // namespace cistula
