// The options that say how colors are shown: --exposure, --view, --bloom, and --preview where they are of one.
#pragma once

#include <string>

#include "apps/common/command_line.h"
#include "image/view/picture_view.h"

namespace cistula {

/// Adds --preview and, as options that require it, those above. A view that is not one of our own is not looked for
/// yet.
void add_preview_options(CLI::App& app, std::string& preview, PictureView& view);

/// Readers of --exposure, --view and --bloom.
OptionReader read_exposure(PictureView& view);
OptionReader read_view(PictureView& view);
OptionReader read_bloom(PictureView& view);

/// Opens the view of a config that `view` names, if it does. Returns a warning, or nothing. Throws Error: usage for an
/// unknown view, with those that exist; file where the config cannot be used.
std::string open_config_view(PictureView& view);

}  // namespace cistula
