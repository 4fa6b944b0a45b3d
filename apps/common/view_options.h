// The options that say how colors are shown: --exposure, --view, --bloom.
#pragma once

#include <string>

#include "scene/image/picture_view.h"

namespace cistula {

/// The options' texts; empty for those not given.
struct ViewTexts {
    std::string exposure, view, bloom;
};

/// The parsed options; a view that is not one of our own is not looked for yet. Throws Error (usage).
PictureView parse_view(const ViewTexts& texts);

/// Opens the view of a config that `view` names, if it does. Returns a warning, or nothing. Throws Error: usage for an
/// unknown view, with those that exist; file where the config cannot be used.
std::string open_config_view(PictureView& view);

}  // namespace cistula
