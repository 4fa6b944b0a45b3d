// The options that say how colors are shown: --exposure, --view, --bloom, and --preview where they are of one.
#pragma once

#include <string>

#include "scene/image/view/picture_view.h"

namespace CLI {
class App;
}

namespace cistula {

/// The options' texts; empty for those not given.
struct ViewTexts {
    std::string exposure, view, bloom;
};

/// Adds --preview and, as options of it, those above.
void add_preview_options(CLI::App& app, std::string& preview, ViewTexts& texts);

/// The parsed options; a view that is not one of our own is not looked for yet. Throws Error (usage).
PictureView parse_view(const ViewTexts& texts);

/// Opens the view of a config that `view` names, if it does. Returns a warning, or nothing. Throws Error: usage for an
/// unknown view, with those that exist; file where the config cannot be used.
std::string open_config_view(PictureView& view);

}  // namespace cistula
