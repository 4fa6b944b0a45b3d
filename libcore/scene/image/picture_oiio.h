// Image formats read by OpenImageIO. A build without it (CISTULA_WITH_OIIO=OFF) replaces only this.
#pragma once

#include <string>

#include "scene/image/picture.h"

namespace cistula {

/// Reads a picture as linear RGB: 8- and 16-bit samples are decoded from sRGB; half, float and double are taken as
/// linear; one or two channels are gray; alpha is ignored. Throws Error(ExitCode::file).
ColorPicture oiio_read(const std::string& path);

}  // namespace cistula
