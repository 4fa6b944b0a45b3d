// What cases found, as people and programs read it.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/render_verify/options.h"

namespace cistula::verify {

/// What the run was made on.
struct RunContext {
    std::vector<std::string> devices;  // GPUs
    std::string driver;                // the CUDA version that it supports
    double seconds = 0;
};

std::string table_head(const std::vector<const CaseEntry*>& cases);
std::string table_row(const Outcome& outcome, const std::vector<const CaseEntry*>& cases);
/// The last line, and before it what does not hold and where.
std::string summary(const std::vector<Outcome>& outcomes);
std::string list_text(const std::vector<CaseEntry>& cases);

/// "0 rays", "1.5 ulps"
std::string measured_text(const Outcome& outcome);
std::string bound_text(const Outcome& outcome);
/// What is wrong with an outcome that does not hold; empty for others.
std::string complaint(const Outcome& outcome);

nlohmann::ordered_json report_json(const std::vector<Outcome>& outcomes, const VerifyOptions& options,
                                   const RunContext& context);
/// One page, nothing loaded, no script, light and dark.
std::string report_html(const std::vector<Outcome>& outcomes, const VerifyOptions& options, const RunContext& context);

}  // namespace cistula::verify
