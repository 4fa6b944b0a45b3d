// The image formats that OpenImageIO reads; the one place that a build without it (CISTULA_WITH_OIIO=OFF) replaces.
#pragma once

#include <string>

#include "scene/image/picture.h"

namespace cistula {

/// 8- and 16-bit samples are decoded from sRGB, half, float and double are taken as linear; one or two channels are
/// gray, alpha is left out. Throws Error(ExitCode::file).
ColorPicture oiio_read(const std::string& path);

}  // namespace cistula
