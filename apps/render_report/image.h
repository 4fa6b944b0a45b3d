// Small pictures for the page: PNGs in memory, base64-encoded.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "image/picture/picture.h"
#include "record.h"

namespace cistula::report {

/// An 8-bit sRGB image of a linear picture, clamped to [0, 1].
Image to_image(const ColorPicture& linear);

/// A heat map of row-major values on a color scale from dark to bright, logarithmic from the least to the largest
/// value.
Image to_heat_image(int width, int height, const std::vector<double>& values);

/// The color at position `place` of the scale, from 0 to 1: red, green, blue.
std::array<uint8_t, 3> heat_color(double place);

}  // namespace cistula::report
