// ICC profiles in pictures, and the gammas of PNG: which color encoding they mean.
#pragma once

#include <string_view>

#include "scene/image/file_colors.h"

namespace cistula {

/// What a profile (ICC.1:2022; versions 2 and 4) says: as `id` the first of color_encodings with its curve and its
/// primaries, or as `profile` its name if it is none of them, damaged, or more than a matrix and curves. Curves match
/// where they differ by at most 0.002 in light, primaries where their XYZ does. Profiles of gray pictures have curves
/// alone. Never throws for what the bytes are.
FileColors colors_of_profile(std::string_view bytes);

/// What the gamma of a PNG without a profile says, where light is number ^ gamma: as `id` linear, 1.8 or 2.4; nothing
/// for 2.2, by which programs mean sRGB; others as `profile`.
FileColors colors_of_gamma(double gamma);

}  // namespace cistula
