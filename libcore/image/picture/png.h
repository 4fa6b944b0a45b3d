// PNG files through libpng, encoded in memory; write them with atomic_file.h.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "image/picture/picture.h"

namespace cistula {

/// An 8-bit sRGB PNG of a linear RGB picture, clamped to [0, 1], with its alpha, if it has one. Throws
/// std::runtime_error with libpng's reason, for instance for pictures of 4 GiB and more.
std::string encode_png(const ColorPicture& linear);

/// An indexed PNG. `pixels`: row-major from the top left, indices into `colors`, which are 1 to 256 sRGB triples of
/// bytes. Throws std::runtime_error with libpng's reason.
std::string encode_indexed_png(uint32_t width, uint32_t height, const std::vector<uint8_t>& pixels,
                               const std::vector<uint8_t>& colors);

}  // namespace cistula
