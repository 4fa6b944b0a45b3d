// Image formats read by OpenImageIO, in the program that reads pictures. A build without it (CISTULA_WITH_OIIO=OFF)
// replaces only this.
#pragma once

#include <string>

#include "scene/image/picture_oiio_module.h"

namespace cistula {

/// Loads what reading with OpenImageIO needs, which stays loaded; empty if that succeeds, or the reason.
std::string load_oiio();

/// Reads a picture after load_oiio: samples of 8 and 16 bits as they are, half and double as float. True on success.
bool oiio_read(const std::string& path, const OiioHost& host);

}  // namespace cistula
