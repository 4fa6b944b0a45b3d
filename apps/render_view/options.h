// The command line of `render-view`.
#pragma once

#include <string>
#include <vector>

#include "image/view/picture_view.h"

namespace cistula {

enum class ViewAction { show, list, print_help, print_version };

struct ViewOptions {
    ViewAction action = ViewAction::show;
    std::string file, output;
    std::vector<std::string> layers;  // as given to each --layer; empty: the default layer
    bool all = false;                 // every layer
    PictureView view;
    bool exposed = false;  // --exposure is given
    int columns = 4;       // most in a row of a contact sheet
    bool quiet = false;
};

/// Parses the command line. Throws Error (usage).
ViewOptions parse_view_options(int argc, const char* const* argv);

/// The output of --help.
std::string view_help_text();

}  // namespace cistula
