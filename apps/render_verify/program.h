// The program render-verify for any table of cases, which tests make, and how it shows what was found.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "verify/verify.h"

namespace cistula::verify {

/// Runs the program over the cases of a table; null: all_cases(). Returns the exit code; throws Error.
int verify_program(int argc, const char* const* argv, const std::vector<Case>* table = nullptr);

// ---- rows as text, JSON and HTML

struct RunContext {
    bool quick;
    std::vector<std::string> devices;  // GPUs
    std::string driver;                // the latest CUDA version that it supports
    double seconds = 0;
};

/// The head and a row of the table, whose first column is so wide.
std::string table_head(size_t width);
std::string table_row(const Row& row, size_t width);
/// The text printed at the end: what does not hold with its place, then one line of totals.
std::string summary(const std::vector<Row>& rows);

nlohmann::ordered_json report_json(const std::vector<Row>& rows, const RunContext& context);
/// The results as one self-contained HTML page, without scripts, for light and dark color schemes.
std::string report_html(const std::vector<Row>& rows, const RunContext& context);

}  // namespace cistula::verify
