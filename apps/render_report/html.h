// Pieces of the page.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "record.h"

namespace cistula::report {

std::string escaped(const std::string& text);

/// "0.77 ms", "12.3 ms", "1.24 s"
std::string time_text(double milliseconds);
/// The median, and the range in small print.
std::string time_html(const Timing& timing);
/// "0.0012", "3.4·10⁻⁷"
std::string number_text(double value);
/// "1,234,567"
std::string count_text(uint64_t value);
/// "12 %", "0.3 %"
std::string percent_text(double share);
/// "1×1", "double, 4×4 samples, depth 8, cutoff 0.002"
std::string setting_text(const Setting& setting);

/// A table in a box of its own, which scrolls if it must. Cells are HTML; columns whose head begins with '>' are
/// numbers.
class Table {
  public:
    explicit Table(std::vector<std::string> heads, std::string caption = "");
    void row(const std::vector<std::string>& cells, const std::string& css = "");
    bool empty() const { return body_.empty(); }
    std::string html() const;

  private:
    std::vector<std::string> heads_;
    std::string caption_, body_;
};

/// A figure with its caption (HTML).
std::string figure(const std::string& content, const std::string& caption, const std::string& css = "");
std::string image_tag(const Image& image, const std::string& description);
/// A command line that can be selected as a whole.
std::string command_html(const std::string& command);

/// One scene of one record, with what the sections say about it.
struct Shown {
    const Record* record = nullptr;
    const SceneRecord* scene = nullptr;
    std::string id, title;  // for anchors and headings
    std::vector<const Entry*> entries;
    double smallest_error = 0;  // RMSE against the reference, of all entries
    bool tight = false;         // the reference's remainder is under a sixteenth of it

    /// The error as stated: what was measured, and the reference's remainder where that could matter.
    double rmse(const Entry& entry) const;
    double max(const Entry& entry) const;
    double p999(const Entry& entry) const;
};
std::vector<Shown> all_shown(const std::vector<Record>& records);

/// What targets cost and whether they are met; for the section of the knobs.
std::string target_html(const Shown& shown);

// The sections, each empty if there is nothing to show.
std::string pareto_section(const std::vector<Shown>& scenes);
std::string knobs_section(const std::vector<Shown>& scenes);
std::string where_section(const std::vector<Shown>& scenes);
std::string seed_section(const std::vector<Record>& records);
std::string parity_section(const std::vector<Shown>& scenes);
std::string verify_section(const std::vector<Record>& records);
std::string scaling_section(const std::vector<Record>& records);
std::string machine_section(const std::vector<Record>& records);
/// What it all comes to, for the top of the page.
std::string summary_html(const std::vector<Shown>& scenes);

}  // namespace cistula::report
