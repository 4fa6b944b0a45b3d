// Whether a rendered frame is the golden one, in words.
#pragma once

#include <string>
#include <vector>

#include "compare/suite/suite_render.h"

namespace cistula {

/// What became of a frame of a case. `missing`: there is nothing to compare it with. `broken`: it was not rendered, or
/// its golden file cannot be read.
enum class Outcome { holds, differs, missing, broken, skipped };

/// The name of an outcome, as --json has it.
const char* outcome_name(Outcome outcome);

struct SuiteResult {
    const SuiteCase* of = nullptr;
    int frame = 0;
    Backend backend = Backend::embree;
    std::optional<Precision> precision;  // none: not known, as it was not rendered
    Outcome outcome = Outcome::skipped;
    std::string verdict;             // one line
    std::vector<std::string> notes;  // what else is to be said, one line each
    // of the rendered data window
    int width = 0;
    int height = 0;
    double seconds = 0;
    std::string golden;  // file, or empty
    std::string hash, expected_hash, film_hash, expected_film_hash;
    std::optional<Comparison> comparison;  // with a golden image
    std::string page;                      // its part of the HTML page (suite_report.h)

    bool failed() const { return outcome != Outcome::holds && outcome != Outcome::skipped; }
};

/// Compares a frame with what its case expects: the golden image (already read, or null where it is not there), or
/// hashes. The header's attributes are compared, and noted, but do not decide.
void judge(const SuiteFrame& frame, size_t index, const LayeredPicture* golden, StopSignal stop, SuiteResult& result);

/// Whether two pictures have the same windows, channels, types and bits.
bool same_bits(const LayeredPicture& a, const LayeredPicture& b);

}  // namespace cistula
