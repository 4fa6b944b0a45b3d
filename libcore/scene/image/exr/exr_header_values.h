// All attributes in the header of an OpenEXR file, whatever their types. Private to image/.
#pragma once

#include <OpenEXR/ImfForward.h>

#include <map>
#include <string>

#include "scene/image/picture/stored_picture.h"

namespace cistula {

/// Every attribute but the windows, the channels, the part's name and what exr_packing says; those of types that nobody
/// knows too. Its value is the bytes that the file has.
std::map<std::string, StoredAttribute> exr_header_values(const Imf::Header& header);

/// How the pixels are packed, which says nothing of them: compression, order of lines, tiles.
std::map<std::string, std::string> exr_packing(const Imf::Header& header);

}  // namespace cistula
