// Previews of merged frames.
#pragma once

#include <string>

#include "scene/image/picture/picture.h"
#include "scene/image/view/picture_view.h"

namespace cistula {

/// Writes the R, G and B of a frame as the PNG that render's --preview is: the very one where they are floats. Throws
/// Error: usage where a preview cannot be made of them, since the background was left out or they are of another color
/// space; file where it cannot be written.
void write_merged_preview(const std::string& path, const LayeredPicture& frame, const PictureView& view);

}  // namespace cistula
