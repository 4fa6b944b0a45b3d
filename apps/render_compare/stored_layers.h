// Pictures in memory as their file would have them.
#pragma once

#include "scene/image/picture/picture.h"
#include "scene/image/picture/stored_picture.h"

namespace cistula {

/// The file of one part that a picture would be, its channels and attributes as floats and texts.
StoredFile stored_layers(const LayeredPicture& picture);

}  // namespace cistula
