// The results of a suite as an HTML page that stands alone.
#pragma once

#include <string>
#include <vector>

#include "suite_report.h"

namespace cistula {

/// The part of the page on a picture that failed: golden image, render and difference, and the worst pixels with why.
/// `golden` is null where there is none.
std::string failure_html(const SuiteResult& result, const std::string& folder, const LayeredPicture* golden,
                         const LayeredPicture& fresh);

/// The page: all results, then the parts of those that failed, as each has it.
std::string suite_page(const Suite& suite, const std::vector<SuiteResult>& results, const SuiteCounts& counts);

}  // namespace cistula
