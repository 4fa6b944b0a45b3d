// The command line of `render-merge`.
#pragma once

#include <string>
#include <vector>

#include "apps/common/render_options.h"
#include "image/view/picture_view.h"
#include "render/picture_size.h"
#include "sequence/frame_list.h"
#include "sequence/output_name.h"

namespace cistula {

enum class MergeAction { merge, print_help, print_version };

struct MergeOptions {
    MergeAction action = MergeAction::merge;
    std::vector<std::string> files;  // the tiles; empty: those of the grid, by the names that render gives them
    /// Tiles, frames (one without a number of its own where the output has no pattern), crop and preview.
    RenderRequest request;
    OutputName output, preview;  // the preview's empty text: none
};

/// Parses the command line. Throws Error (usage).
MergeOptions parse_merge_options(int argc, const char* const* argv);

/// The output of --help.
std::string merge_help_text();

}  // namespace cistula
