// The options that say how colors are shown: --exposure, --view, --bloom.
#pragma once

#include <string>

#include "scene/image/picture_view.h"

namespace cistula {

/// The options' texts; empty for those not given.
struct ViewTexts {
    std::string exposure, view, bloom;
};

/// The parsed options. Throws Error (usage); for an unknown view with those that exist.
PictureView parse_view(const ViewTexts& texts);

}  // namespace cistula
