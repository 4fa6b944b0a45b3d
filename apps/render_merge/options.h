// The command line of `render-merge`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "image/view/picture_view.h"
#include "render/picture_size.h"
#include "sequence/frame_list.h"
#include "sequence/output_name.h"

namespace cistula {

enum class MergeAction { merge, print_help, print_version };

struct MergeOptions {
    MergeAction action = MergeAction::merge;
    std::vector<std::string> files;  // the tiles; empty: those of the grid, by the names that render gives them
    std::optional<TileGrid> grid;
    OutputName output;
    std::vector<int> frames;  // one without a number of its own where the output has no pattern
    std::optional<PixelRect> window;
    OutputName preview;  // empty text: none
    PictureView view;    // of the preview
    bool quiet = false;
};

/// Parses the command line. Throws Error (usage).
MergeOptions parse_merge_options(int argc, const char* const* argv);

/// The output of --help.
std::string merge_help_text();

}  // namespace cistula
