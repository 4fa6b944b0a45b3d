// What the headers of pictures and ICC profiles say of colors.
#pragma once

#include <istream>
#include <optional>
#include <string>
#include <string_view>

#include "image/color/file_colors.h"

namespace cistula {

/// The encoding that a picture's header states; none: it states nothing that comes before an ICC profile or a default.
/// PNG (third edition, 11.3.2): cICP; without it and a profile, sRGB; without that, gAMA and cHRM. Radiance: PRIMARIES,
/// and a FORMAT of XYZ; the products of all EXPOSURE and COLORCORR, NaN where one is no number. Others: header_colors.
/// What is no encoding known here is a `profile`, by which it is refused.
std::optional<FileColors> stated_colors(const std::string& path);

/// What a gamma says, where light is number ^ gamma: as `id` linear, 1.8 or 2.4; nothing for 2.2, by which programs
/// mean sRGB; others as `profile`.
FileColors colors_of_gamma(double gamma);

/// What a profile (ICC.1:2022; versions 2 and 4) says: as `id` the first of color_encodings with its curve and its
/// primaries, or as `profile` its name if it is none of them, damaged, or more than a matrix and curves. Curves match
/// where they differ by at most 0.002 in light, primaries where their XYZ does. Profiles of gray pictures have curves
/// alone. Never throws for what the bytes are.
FileColors colors_of_profile(std::string_view bytes);

// Private to image/color.

FileColors unknown_colors(std::string name);  // that are refused by this name
FileColors known_colors(std::string_view id);

/// TIFF (6.0, sections 20 and 23; BigTIFF): PrimaryChromaticities and WhitePoint, unless there is an ICC profile. WebP:
/// the profile of its chunk ICCP. DPX (SMPTE 268M): the transfer characteristic. Cineon: printing density, always. TGA
/// (2.0): the gamma of its extension area. None: the file is of another format, or says nothing.
std::optional<FileColors> header_colors(std::istream& file);

}  // namespace cistula
