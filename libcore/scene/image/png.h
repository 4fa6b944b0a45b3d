// PNG files through libpng, encoded in memory: whoever has one writes it whole or not at all (atomic_file.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/image/picture.h"

namespace cistula {

/// A PNG of 8-bit sRGB from linear RGB, clamped to [0, 1]. Throws std::runtime_error with libpng's reason, among others
/// for pictures of 4 GiB and more.
std::string encode_png(const ColorPicture& linear);

/// A PNG of `pixels`, row-major from the top left: each is an index into `colors`, 1 to 256 of them, three bytes of
/// sRGB each. Throws std::runtime_error with libpng's reason.
std::string encode_indexed_png(uint32_t width, uint32_t height, const std::vector<uint8_t>& pixels,
                               const std::vector<uint8_t>& colors);

}  // namespace cistula
