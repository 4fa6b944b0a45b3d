// The command line of `render-farm`: render's options, and its own.
#pragma once

#include <string>
#include <vector>

#include "apps/common/render_options.h"

namespace cistula {

enum class FarmAction { write, print_help, print_version };

struct FarmOptions {
    FarmAction action = FarmAction::write;
    RenderCommand render;             // of the whole film; its tiles, if given, are more than one
    std::vector<std::string> passed;  // arguments that every task passes to render
    std::vector<std::string> merged;  // arguments for render-merge
    std::string folder;               // where the job's files go
    double task_seconds = 300;        // that a task takes here, about
    int most_tasks = 1000;
};

/// Parses the command line. Throws Error (usage).
FarmOptions parse_farm_options(int argc, const char* const* argv);

/// The output of --help.
std::string farm_help_text();

}  // namespace cistula
