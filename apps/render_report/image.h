// Small pictures for the page: PNG in memory, as base64.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "record.h"
#include "scene/image/picture.h"

namespace cistula::report {

/// 8-bit sRGB of a linear picture, clamped to [0, 1].
Image to_image(const ColorPicture& linear);

/// Each value's color on a scale from dark to bright, logarithmic from the least to the largest; row-major.
Image to_heat_image(int width, int height, const std::vector<double>& values);

/// The scale's color at a place from 0 to 1: red, green, blue.
std::array<uint8_t, 3> heat_color(double place);

std::string base64(const std::string& bytes);

}  // namespace cistula::report
