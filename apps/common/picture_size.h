// Parsing of picture sizes and crops: 640x480, 64x64+128+96.
#pragma once

#include <string_view>

#include "scene/film/film.h"

namespace cistula {

struct PictureSize {
    int width = 0, height = 0;
};

inline constexpr int largest_side = 65536;  // pixels

/// Parses the size given to --res, such as "640x480". Throws Error (usage).
PictureSize parse_size(std::string_view text);

/// Parses the rectangle given to --crop, "WxH+X+Y"; X and Y from the top left of the full frame. Throws Error (usage).
PixelRect parse_crop(std::string_view text);

}  // namespace cistula
