// The command line of `render-compare`.
#pragma once

#include <string>

#include "compare/metrics/compare.h"

namespace cistula {

enum class CompareAction { compare, sums, print_help, print_version };

struct CompareOptions {
    CompareAction action = CompareAction::compare;
    std::string a, b;  // images, or folders or numbered sequences of them; with --sums: a alone
    Thresholds thresholds;
    Selection selection;           // but for its mask
    std::string mask, diff, json;  // files; empty: none
    bool quiet = false;
};

/// Whether a text names several images: a folder, or a pattern of numbers that is no file's own name.
bool names_several(const std::string& text);

/// Parses the command line. Throws Error (usage).
CompareOptions parse_compare_options(int argc, const char* const* argv);

/// The output of --help.
std::string compare_help_text();

}  // namespace cistula
