// The command line of `render`, parsed and checked as far as possible without the scene. Other programs have some
// of its options.
#pragma once

#include <string>
#include <string_view>

#include "apps/common/status_line.h"
#include "render/picture_size.h"
#include "render/record/film_picture.h"
#include "render/renderer.h"
#include "sequence/frame_list.h"
#include "sequence/render_request.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace cistula {

struct ChosenPixel {
    // from the top left of the full frame
    int x = 0;
    int y = 0;
};

enum class Action { render, explain, measure, pixel, explore, print_help, print_version, print_template, list_devices };

/// A request and what is to be done with it.
struct RenderCommand : RenderRequest {
    Action action = Action::render;
    ChosenPixel pixel;  // for Action::pixel
    std::string json;   // for Action::pixel: a file, "-" or empty
    std::string page;   // for Action::explore: a file or "-"
    double page_mb = 5;
};

/// Adds the option of a key, with another description if one is given; `request` must outlive it.
CLI::Option* add_key(CLI::App& app, RenderRequest& request, std::string_view key, const char* description = nullptr);

/// Parses the command line. Throws Error (usage); the message names the option, what is wrong and what would be right.
RenderCommand parse_options(int argc, const char* const* argv);

/// The output of --help: options, examples, exit codes.
std::string help_text();

}  // namespace cistula
