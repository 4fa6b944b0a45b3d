// The attributes in the header of an OpenEXR file. Private to image/.
#pragma once

#include <OpenEXR/ImfForward.h>

#include "scene/image/picture/picture.h"

namespace cistula {

using ExrAttributes = decltype(LayeredPicture::attributes);

/// The attributes of the types that write_exr writes, but for those that make a part of a file; float attributes become
/// doubles.
ExrAttributes read_attributes(const Imf::Header& header);

}  // namespace cistula
