// The command line of `render-compare suite`.
#pragma once

#include <string>
#include <vector>

#include "apps/common/backends.h"
#include "suite.h"

namespace cistula {

struct SuiteOptions {
    bool help = false;
    std::string folder;
    std::vector<std::string> cases;    // names; empty: all
    std::vector<std::string> filters;  // patterns of names and tags; empty: all
    RenderRequest request;             // backend and devices
    std::optional<Backend> backend;    // none: those of the cases
    int jobs = 1;
    bool update = false, list = false, fail_fast = false, quiet = false;
    std::string junit, json, html;  // files; empty: none
};

/// Parses the words after `suite`. Throws Error (usage).
SuiteOptions parse_suite_options(int argc, const char* const* argv);

/// The output of --help.
std::string suite_help_text();

/// The cases that the names, the filters and the backend choose, in the order of the file. Throws Error (usage) for a
/// name or a pattern that is of none, with the nearest.
std::vector<const SuiteCase*> chosen_cases(const Suite& suite, const SuiteOptions& options);

/// The backends that a case runs on: its own, or the one asked for.
std::vector<Backend> backends_of(const SuiteCase& one, const SuiteOptions& options);

/// Throws Error (usage) if a file to be written is one that is read, or another one.
void require_other_files(const Suite& suite, const SuiteOptions& options, const std::vector<const SuiteCase*>& chosen);

}  // namespace cistula
