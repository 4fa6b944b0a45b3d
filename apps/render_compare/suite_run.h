// A run of a suite: its cases are rendered and compared, several at once, and told of in the order of the file.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "suite_judge.h"
#include "suite_options.h"

namespace cistula {

/// A backend on this machine, or why there is none.
struct SuiteBackend {
    Backend backend = Backend::embree;
    ChosenDevices devices;
    std::string obstacle;  // empty: it is there
};

/// What a run does with the frames of a case.
struct SuiteWork {
    /// Called for each frame that was rendered and judged, on any thread; `golden` is null where there is none. May
    /// change the result.
    std::function<void(const SuiteFrame& frame, const LayeredPicture* golden, SuiteResult& result)> judged;
    /// Called for the results of each case, in the order of the file, one at a time.
    std::function<void(const std::vector<SuiteResult>&)> finished;
};

/// The backends of these cases. Throws Error (device) if the one that is asked for is not there.
std::vector<SuiteBackend> find_backends(const std::vector<const SuiteCase*>& chosen, const SuiteOptions& options);

/// Renders the cases. What is wrong with a case is in its results; others go on. Returns the results in the order of
/// the file; with --fail-fast those of the cases that were begun. Throws Error (interrupted).
std::vector<SuiteResult> run_cases(const Suite& suite, const std::vector<const SuiteCase*>& chosen,
                                   const std::vector<SuiteBackend>& backends, const SuiteOptions& options,
                                   const SuiteWork& work);

/// Does what the words after `suite` say; returns the exit code. Throws Error.
int run_suite(int argc, const char* const* argv);

}  // namespace cistula
