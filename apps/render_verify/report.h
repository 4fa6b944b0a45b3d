// The results of cases as text, JSON and HTML.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/render_verify/runner.h"

namespace cistula::verify {

struct RunContext {
    bool quick;
    std::vector<std::string> devices;  // GPUs
    std::string driver;                // the latest CUDA version that it supports
    double seconds = 0;
};

std::string table_head(const std::vector<const Case*>& cases);
std::string table_row(const Outcome& outcome, const std::vector<const Case*>& cases);
/// The text printed at the end: the failed cases with their places, then one line of totals.
std::string summary(const std::vector<Outcome>& outcomes);
std::string list_text(const std::vector<Case>& cases);

nlohmann::ordered_json report_json(const std::vector<Outcome>& outcomes, const RunContext& context);
/// The results as one self-contained HTML page, without scripts, for light and dark color schemes.
std::string report_html(const std::vector<Outcome>& outcomes, const RunContext& context);

}  // namespace cistula::verify
