// What the headers of TIFF, WebP, DPX, Cineon and TGA files say of colors. Private to image/.
#pragma once

#include <istream>
#include <optional>
#include <string>
#include <string_view>

#include "scene/image/color/file_colors.h"

namespace cistula {

FileColors unknown_colors(std::string name);  // that are refused by this name
FileColors known_colors(std::string_view id);

/// TIFF (6.0, sections 20 and 23; BigTIFF): PrimaryChromaticities and WhitePoint, unless there is an ICC profile. WebP:
/// the profile of its chunk ICCP. DPX (SMPTE 268M): the transfer characteristic. Cineon: printing density, always. TGA
/// (2.0): the gamma of its extension area. None: the file is of another format, or says nothing.
std::optional<FileColors> header_colors(std::istream& file);

}  // namespace cistula
