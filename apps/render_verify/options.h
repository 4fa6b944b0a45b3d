// The command line of `render-verify`.
#pragma once

#include <string>
#include <vector>

#include "apps/render_verify/runner.h"

namespace cistula::verify {

enum class VerifyAction { run, list, print_help, print_version };

struct VerifyOptions {
    VerifyAction action = VerifyAction::run;
    RunSettings settings;
    std::vector<const CaseEntry*> cases;
    std::string json, html;  // files; empty: none
    bool cuda = false;       // devices are used as well
};

/// Parses the command line. Throws Error (usage). `cases`: those that --case chooses from.
VerifyOptions parse_verify_options(int argc, const char* const* argv, const std::vector<CaseEntry>& cases);

/// The output of --help.
std::string verify_help_text();

}  // namespace cistula::verify
