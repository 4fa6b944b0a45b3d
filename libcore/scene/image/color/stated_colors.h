// What the headers of pictures say of colors, other than by an ICC profile that OpenImageIO reads.
#pragma once

#include <optional>
#include <string>

#include "scene/image/color/file_colors.h"

namespace cistula {

/// The encoding that a picture's header states; none: it states nothing that comes before an ICC profile or a default.
/// PNG (third edition, 11.3.2): cICP; without it and a profile, sRGB; without that, gAMA and cHRM. Radiance: PRIMARIES,
/// and a FORMAT of XYZ. Others: header_colors. What is no encoding known here is a `profile`, by which it is refused.
std::optional<FileColors> stated_colors(const std::string& path);

/// What a gamma says, where light is number ^ gamma: as `id` linear, 1.8 or 2.4; nothing for 2.2, by which programs
/// mean sRGB; others as `profile`.
FileColors colors_of_gamma(double gamma);

}  // namespace cistula
