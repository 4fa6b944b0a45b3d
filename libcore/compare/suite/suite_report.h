// Results of a suite: the table, JUnit XML, JSON.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "compare/suite/suite_run.h"

namespace cistula {

/// How many results have which outcome, and how many cases were not begun.
struct SuiteCounts {
    size_t held = 0;
    size_t failed = 0;
    size_t skipped = 0;
    size_t not_begun = 0;
};
SuiteCounts count_results(const std::vector<SuiteResult>& results, size_t chosen);

/// The head of the table, and the rows of a case. `name_width`: of the longest name.
std::string table_head(const Suite& suite, const std::vector<SuiteBackend>& backends, size_t name_width);
std::string table_rows(const std::vector<SuiteResult>& results, size_t name_width);
/// The last line: whether the suite holds.
std::string summary_text(const SuiteCounts& counts);

/// What tells a result apart from others of its case: " [cuda, frame 3]", or nothing.
std::string variant_text(const SuiteResult& result);

/// An outcome and its verdict in words.
std::string result_text(const SuiteResult& result);

std::string junit_xml(const Suite& suite, const std::vector<SuiteResult>& results);
nlohmann::ordered_json suite_json(const Suite& suite, const std::vector<SuiteResult>& results,
                                  const std::vector<SuiteBackend>& backends, const SuiteCounts& counts);

/// The part of the page on a picture that failed: golden image, render and difference, and the worst pixels with why.
/// `golden` is null where there is none.
std::string failure_html(const SuiteResult& result, const std::string& folder, const LayeredPicture* golden,
                         const LayeredPicture& fresh, StopSignal stop);

/// The page: all results, then the parts of those that failed, as each has it.
std::string suite_page(const Suite& suite, const std::vector<SuiteResult>& results, const SuiteCounts& counts);

}  // namespace cistula
