// The image formats that OpenImageIO reads; the one place that a build without it (CISTULA_WITH_OIIO=OFF) replaces.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/picture.h"

namespace cistula {

/// 8- and 16-bit samples are decoded from sRGB, half, float and double are taken as linear; one or two channels are
/// gray, alpha is left out. Throws Error(ExitCode::file).
ColorPicture oiio_read(const std::string& path);

/// Writes an 8-bit sRGB PNG, whole or not at all, from `bytes`: width * height RGB triples, row-major from the top
/// left. Throws Error(ExitCode::file).
void oiio_write(const std::string& path, uint32_t width, uint32_t height, const std::vector<uint8_t>& bytes);

}  // namespace cistula
