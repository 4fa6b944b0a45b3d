// The command line of `render-report`.
#pragma once

#include <string>
#include <vector>

#include "sequence/backends.h"

namespace cistula::report {

enum class Action { report, print_help, print_version };
enum class ScalingChoice { none, also, only };

struct ReportOptions {
    Action action = Action::report;
    std::vector<std::string> scenes;
    std::vector<std::string> from;                           // records to show instead of measuring
    std::string output, json, verify, seed_baseline, cache;  // files; empty: none
    Backend backend = Backend::embree;
    DeviceChoice devices;
    int threads = 0;            // 0: one per core
    int width = 0, height = 0;  // 0: those of each scene's film
    int repetitions = 10;
    double limit = 2;  // seconds per frame
    ScalingChoice scaling = ScalingChoice::none;
    bool quick = false, quiet = false;
};

/// Parses the command line. Throws Error (usage).
ReportOptions parse_report_options(int argc, const char* const* argv);

/// The output of --help.
std::string report_help_text();

}  // namespace cistula::report
