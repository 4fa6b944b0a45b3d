// Headers of EXR files, beyond what they say of every frame: results of a target error, and whether a file is of a
// frame.
#pragma once

#include "render/record/frame_header.h"
#include "render/target.h"

namespace cistula {

/// The value of an attribute for people: the shortest text that reads back as the same number, so that equal texts are
/// equal values, NaN and -0 included.
std::string attribute_text(const Attributes::mapped_type& value);

/// Adds what is proven and estimated of the image: provenTruncation, checkedPixels and offPixels.
void add_target_attributes(const TargetReport& report, Attributes& attributes);

/// The attributes without what add_target_attributes() adds.
Attributes without_target_attributes(Attributes attributes);

/// Adds what is proven and estimated of more pixels of a frame, where a header says that.
void join_target_attributes(const Attributes& more, Attributes& attributes);

/// Whether `picture` is the image that the attributes, windows, channels and compression of `expected` describe. The
/// values of `expected` are ignored, and so is what add_target_attributes() added to the picture.
bool is_same_image(const LayeredPicture& picture, const LayeredPicture& expected);

}  // namespace cistula
