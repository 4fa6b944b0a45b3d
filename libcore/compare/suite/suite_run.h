// A run of a suite: its cases are rendered and compared, several at once, and told of in the order of the file.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/suite/suite_judge.h"

namespace cistula {

/// Which cases of a suite are run, and how.
struct SuiteRunSettings {
    std::vector<std::string> cases;    // names; empty: all
    std::vector<std::string> filters;  // patterns of names and tags; empty: all
    std::optional<Backend> backend;    // none: those of the cases
    DeviceChoice devices;
    int jobs = 1;  // cases at once
    bool update = false;
    bool fail_fast = false;
    bool run_commands = false;  // those of cases; else such a case fails
};

/// The cases that the names, the filters and the backend choose, in the order of the file. Throws Error (usage) for a
/// name or a pattern that is of none, with the nearest.
std::vector<const SuiteCase*> chosen_cases(const Suite& suite, const SuiteRunSettings& options);

/// The backends that a case runs on: its own, or the one asked for.
std::vector<Backend> backends_of(const SuiteCase& one, const SuiteRunSettings& options);

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
    /// Called for the results of each case, in the order of the file, one at a time. May change them.
    std::function<void(std::vector<SuiteResult>&)> finished;
};

/// The backends of these cases. Throws Error (device) if the one that is asked for is not there.
std::vector<SuiteBackend> find_backends(const std::vector<const SuiteCase*>& chosen, const SuiteRunSettings& options);

/// Renders the cases. What is wrong with a case is in its results; others go on. Returns the results in the order of
/// the file: with fail_fast those of the cases that were begun, and once progress.stop is set of those that are done.
std::vector<SuiteResult> run_cases(const Suite& suite, const std::vector<const SuiteCase*>& chosen,
                                   const std::vector<SuiteBackend>& backends, const SuiteRunSettings& options,
                                   const SuiteWork& work, RenderProgress& progress);

}  // namespace cistula
