// Sizes and crops of pictures as people write them: 640x480, 64x64+128+96.
#pragma once

#include <string_view>

#include "scene/film/film.h"

namespace cistula {

struct PictureSize {
    int width = 0, height = 0;
};

inline constexpr int largest_side = 65536;  // pixels

/// "640x480", what --res says. Throws Error (usage).
PictureSize parse_size(std::string_view text);

/// "WxH+X+Y", what --crop says; X and Y from the top left of the full frame. Throws Error (usage).
PixelRect parse_crop(std::string_view text);

}  // namespace cistula
