// The differences of two files as pictures.
#pragma once

#include <vector>

#include "scene/image/picture/picture.h"
#include "scene/image/picture/stored_picture.h"
#include "selection.h"

namespace cistula {

/// The absolute differences of the chosen channels that both files have, in the parts of the first at their whole
/// resolution, over the pixels that are compared; 0 where the mask counts none. Empty where no pixel has a partner.
std::vector<PicturePart> difference_parts(const StoredFile& a, const StoredFile& b, const Selection& selection = {});

/// The differences by channel as a picture. The data windows must be equal.
LayeredPicture difference_picture(const LayeredPicture& a, const LayeredPicture& b);

}  // namespace cistula
