// The command line of `render-compare suite`.
#pragma once

#include <string>
#include <vector>

#include "compare/suite/suite_run.h"

namespace cistula {

struct SuiteOptions : SuiteRunSettings {
    bool help = false;
    bool list = false;
    bool quiet = false;
    std::string folder;
    RenderRequest request;          // backend and devices
    std::string junit, json, html;  // files; empty: none
};

/// Parses the words after `suite`. Throws Error (usage).
SuiteOptions parse_suite_options(int argc, const char* const* argv);

/// Does what the words after `suite` say; returns the exit code. Throws Error.
int run_suite(int argc, const char* const* argv);

/// The output of --help.
std::string suite_help_text();

/// Throws Error (usage) if a file to be written is one that is read, or another one.
void require_other_files(const Suite& suite, const SuiteOptions& options, const std::vector<const SuiteCase*>& chosen);

}  // namespace cistula
