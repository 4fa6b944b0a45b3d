// The command line of `render-farm`: render's options, and its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/common/render_options.h"

namespace cistula {

enum class FarmAction { write, print_help, print_version };

struct FarmOptions {
    FarmAction action = FarmAction::write;
    RenderOptions render;             // of the whole film
    std::vector<std::string> passed;  // arguments that every task passes to render
    std::vector<std::string> merged;  // arguments for render-merge
    std::optional<TileGrid> tiles;    // more than one
    std::string folder;               // where the job's files go
    double task_seconds = 300;        // that a task takes here, about
    int most_tasks = 1000;
    bool quiet = false;
};

/// Parses the command line. Throws Error (usage).
FarmOptions parse_farm_options(int argc, const char* const* argv);

/// The output of --help.
std::string farm_help_text();

}  // namespace cistula
