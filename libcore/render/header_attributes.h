// Whether an EXR file is of a frame.
#pragma once

#include "image/picture/stored_picture.h"
#include "render/record/frame_header.h"
#include "render/target.h"

namespace cistula {

/// Whether `picture` is the image that the attributes, windows, channels and compression of `expected` describe. The
/// values of `expected` are ignored, and so is what add_target_attributes() added to the picture.
bool is_same_image(const LayeredPicture& picture, const LayeredPicture& expected);

}  // namespace cistula
