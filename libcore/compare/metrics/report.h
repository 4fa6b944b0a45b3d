// Report of a comparison as text and as JSON.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "compare/metrics/compare.h"

namespace cistula {

/// One line: whether the comparison passes, and the reason.
std::string verdict(const Comparison& comparison, const Thresholds& thresholds);

/// The differences other than values, what is not compared, a table of the channels, FLIP where it was asked for, and
/// the verdict.
std::string report_text(const Comparison& comparison, const Thresholds& thresholds);

/// The report as JSON, with the names of what was compared; infinities and NaN, which JSON lacks, are strings.
nlohmann::ordered_json report_json(const Comparison& comparison, const Thresholds& thresholds, const std::string& first,
                                   const std::string& second);

/// The pixel with the largest difference: "R at (12, 34): 0.5 / 0.25", with the bits if the values are equal.
std::string worst_text(const ChannelStatistics& channel);

}  // namespace cistula
