// Parts of the HTML page.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compare/page/page_parts.h"
#include "record.h"

namespace cistula::report {

/// A time with its unit: "0.77 ms", "12.3 ms", "1.24 s".
std::string time_text(double milliseconds);
/// The median time, with the range in small print.
std::string time_html(const Timing& timing);
/// A number with two significant digits: "0.0012", "3.4·10⁻⁷".
std::string number_text(double value);
/// An integer with separators: "1,234,567".
std::string count_text(uint64_t value);
/// A count of rays that was added up in floating point, cut to a whole number; one beyond 64 bits as number_text.
std::string float_count_text(double value);
/// A percentage: "12 %", "0.3 %".
std::string percent_text(double share);
/// A setting in words: "1×1", "double, 4×4 samples, depth 8, cutoff 0.002".
std::string setting_text(const Setting& setting);

std::string image_tag(const Image& image, const std::string& description);
/// A scene of a record, with values that several sections use.
struct Shown {
    const Record* record = nullptr;
    const SceneRecord* scene = nullptr;
    std::string id, title;  // for anchors and headings
    std::vector<const Entry*> entries;
    double smallest_error = 0;  // smallest RMSE against the reference of all entries
    bool tight = false;         // the reference's truncation is under a sixteenth of smallest_error

    /// The errors to display: as measured, plus the reference's truncation where it could matter.
    double rmse(const Entry& entry) const;
    double max(const Entry& entry) const;
    double p999(const Entry& entry) const;
};
std::vector<Shown> all_shown(const std::vector<Record>& records);

/// Costs of target errors and whether they are met; part of the section on knobs.
std::string target_html(const Shown& shown);

// The page's sections; each is empty if there is nothing to show.
std::string pareto_section(const std::vector<Shown>& scenes);
std::string knobs_section(const std::vector<Shown>& scenes);
std::string where_section(const std::vector<Shown>& scenes);
std::string seed_section(const std::vector<Record>& records);
std::string parity_section(const std::vector<Shown>& scenes);
std::string verify_section(const std::vector<Record>& records);
std::string scaling_section(const std::vector<Record>& records);
std::string machine_section(const std::vector<Record>& records);
/// The main results, for the top of the page.
std::string summary_html(const std::vector<Shown>& scenes);

}  // namespace cistula::report
