// A comparison as people read it, and as JSON.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "compare.h"
#include "options.h"

namespace cistula {

/// One line: whether the comparison holds, and why or why not.
std::string verdict(const Comparison& comparison, const Thresholds& thresholds);

/// What differs beside the floats, a table of the channels, the verdict.
std::string report_text(const Comparison& comparison, const Thresholds& thresholds);

/// The report as JSON; infinities and NaN, which JSON does not have, are strings.
nlohmann::ordered_json report_json(const Comparison& comparison, const CompareOptions& options);

/// "R at (12, 34): 0.5 / 0.25", with the bits where the values are equal.
std::string worst_text(const ChannelStatistics& channel);

}  // namespace cistula
