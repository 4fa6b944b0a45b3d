// ICC profiles in pictures: which color encoding they mean.
#pragma once

#include <string_view>

#include "scene/image/color/file_colors.h"

namespace cistula {

/// What a profile (ICC.1:2022; versions 2 and 4) says: as `id` the first of color_encodings with its curve and its
/// primaries, or as `profile` its name if it is none of them, damaged, or more than a matrix and curves. Curves match
/// where they differ by at most 0.002 in light, primaries where their XYZ does. Profiles of gray pictures have curves
/// alone. Never throws for what the bytes are.
FileColors colors_of_profile(std::string_view bytes);

}  // namespace cistula
