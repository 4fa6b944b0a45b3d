#include "compare/suite/suite_run.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>
#include <thread>

#include "base/error.h"
#include "base/option_text.h"
#include "base/suggest.h"
#include "image/exr/exr.h"

namespace cistula {
namespace {

bool matches(const std::string& pattern, const std::string& text) {
    return fnmatch(pattern.c_str(), text.c_str(), FNM_NOESCAPE) == 0;
}

bool chooses(const std::string& pattern, const SuiteCase& one) {
    return matches(pattern, one.name) ||
           std::any_of(one.tags.begin(), one.tags.end(), [&](const auto& tag) { return matches(pattern, tag); });
}

/// Throws unless some case has the name or, for a pattern, fits.
void require_known(const Suite& suite, const std::string& text, const char* what, bool is_pattern) {
    std::vector<std::string_view> known;
    for (const SuiteCase& one : suite.cases) {
        if (is_pattern ? chooses(text, one) : text == one.name) return;
        known.push_back(one.name);
    }
    if (is_pattern)
        for (const SuiteCase& one : suite.cases)
            for (const std::string& tag : one.tags)
                if (std::find(known.begin(), known.end(), tag) == known.end()) known.push_back(tag);
    fail_usage(fmt::format("{}{}: {} has no such case", what, text, suite.path),
               nearest_first(text, known, is_pattern ? "names and tags" : "cases"));
}

/// The cases of a run, taken one after the other by several threads.
class CaseQueue {
  public:
    CaseQueue(const Suite& suite, const std::vector<const SuiteCase*>& chosen,
              const std::vector<SuiteBackend>& backends, const SuiteRunSettings& options, const SuiteWork& work,
              RenderProgress& progress)
        : suite_(suite),
          chosen_(chosen),
          backends_(backends),
          options_(options),
          work_(work),
          progress_(progress),
          done_(chosen.size()) {}

    /// Takes cases until there are no more. One thread's failure ends all of them.
    void take_cases() {
        try {
            for (size_t i = next_++; i < chosen_.size() && !progress_.stop && !failed_; i = next_++)
                finish(i, results_of(*chosen_[i]));
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::interrupted) fail();
        } catch (...) {
            fail();
        }
    }

    /// All results, in the order of the file.
    std::vector<SuiteResult> results() {
        if (failure_) std::rethrow_exception(failure_);
        std::vector<SuiteResult> all;
        for (size_t i = 0; i < done_.size(); ++i) {
            if (!done_[i]) continue;
            if (i >= told_) work_.finished(*done_[i]);  // one before it was interrupted
            for (SuiteResult& result : *done_[i]) all.push_back(std::move(result));
        }
        return all;
    }

  private:
    /// Ends all threads' work for the exception that is handled.
    void fail() {
        {
            const std::lock_guard lock(mutex_);
            if (!failure_) failure_ = std::current_exception();
            progress_.stop = true;
        }
    }

    const SuiteBackend& machine(Backend backend) const {
        return *std::find_if(backends_.begin(), backends_.end(),
                             [&](const SuiteBackend& one) { return one.backend == backend; });
    }

    /// One backend that is there records a new golden image; all compare.
    std::vector<Backend> backends_for(const SuiteCase& one) const {
        std::vector<Backend> all = backends_of(one, options_);
        if (!options_.update || one.is_foreign()) return all;
        const auto first = std::find_if(all.begin(), all.end(), [&](Backend b) { return machine(b).obstacle.empty(); });
        return first == all.end() ? all : std::vector{*first};
    }

    std::vector<SuiteResult> results_of(const SuiteCase& one) {
        std::vector<SuiteResult> results;
        for (const Backend backend : backends_for(one))
            for (SuiteResult& result : results_on(one, backend)) results.push_back(std::move(result));
        return results;
    }

    std::vector<SuiteResult> results_on(const SuiteCase& one, Backend backend) {
        std::vector<SuiteResult> results;
        for (const int frame : one.frames) {
            SuiteResult result;
            result.of = &one;
            result.frame = frame;
            result.backend = backend;
            result.golden = one.golden_path(suite_.folder, frame);
            results.push_back(std::move(result));
        }
        const SuiteBackend* const on = one.is_foreign() ? nullptr : &machine(backend);
        if (on && !on->obstacle.empty()) {
            for (SuiteResult& result : results) result.verdict = on->obstacle;
            return results;
        }
        std::unique_lock<std::mutex> device(device_, std::defer_lock);
        if (backend == Backend::cuda) device.lock();  // its memory is for one scene at a time
        try {
            const SuiteScene scene = on ? prepare_case(one, suite_.folder, backend, on->devices.options, progress_.stop)
                                        : prepare_foreign(one, suite_.folder, options_.run_commands);
            for (size_t i = 0; i < results.size(); ++i) {
                results[i].precision = scene.precision;
                results[i].notes = scene.notes;
                check_frame(scene, i, results[i]);
            }
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::interrupted) throw;
            for (SuiteResult& result : results) set_broken(result, error.what());
        } catch (const std::bad_alloc&) {
            for (SuiteResult& result : results) set_broken(result, no_memory);
        }
        return results;
    }

    void check_frame(const SuiteScene& scene, size_t index, SuiteResult& result) {
        try {
            const SuiteFrame frame = scene.render(result.frame, progress_);
            std::optional<LayeredPicture> golden;
            std::error_code ignored;
            std::string unreadable;
            if (!result.golden.empty() && std::filesystem::exists(result.golden, ignored)) {
                try {
                    golden = read_exr(result.golden);
                } catch (const Error& error) {
                    unreadable = error.what();
                }
            }
            judge(frame, index, golden ? &*golden : nullptr, progress_.stop, result);
            if (!unreadable.empty()) {
                result.outcome = Outcome::broken;
                result.verdict = unreadable;
            }
            if (work_.judged) work_.judged(frame, golden ? &*golden : nullptr, result);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::interrupted) throw;
            set_broken(result, error.what());
        } catch (const std::bad_alloc&) {
            set_broken(result, no_memory);
        }
    }

    static constexpr const char* no_memory = "out of memory; a smaller picture, or fewer `jobs`, need less";

    static void set_broken(SuiteResult& result, const char* why) {
        result.outcome = Outcome::broken;
        result.verdict = why;
    }

    /// Passes on the results of all cases whose predecessors are done.
    void finish(size_t index, std::vector<SuiteResult> results) {
        const std::lock_guard lock(mutex_);
        if (options_.fail_fast &&
            std::any_of(results.begin(), results.end(), [](const SuiteResult& result) { return result.failed(); }))
            failed_ = true;
        done_[index] = std::move(results);
        for (; told_ < done_.size() && done_[told_]; ++told_) work_.finished(*done_[told_]);
    }

    const Suite& suite_;
    const std::vector<const SuiteCase*>& chosen_;
    const std::vector<SuiteBackend>& backends_;
    const SuiteRunSettings& options_;
    const SuiteWork& work_;
    RenderProgress& progress_;
    std::atomic<size_t> next_{0};
    std::atomic<bool> failed_{false};
    std::mutex mutex_, device_;
    std::exception_ptr failure_;
    std::vector<std::optional<std::vector<SuiteResult>>> done_;
    size_t told_ = 0;
};

}  // namespace

std::vector<Backend> backends_of(const SuiteCase& one, const SuiteRunSettings& options) {
    if (!options.backend) return one.backends;
    const bool has = std::find(one.backends.begin(), one.backends.end(), *options.backend) != one.backends.end();
    return has ? std::vector{*options.backend} : std::vector<Backend>{};
}

std::vector<const SuiteCase*> chosen_cases(const Suite& suite, const SuiteRunSettings& options) {
    for (const std::string& name : options.cases) require_known(suite, name, "", false);
    for (const std::string& pattern : options.filters) require_known(suite, pattern, "`filter` ", true);
    std::vector<const SuiteCase*> chosen;
    for (const SuiteCase& one : suite.cases) {
        const auto& names = options.cases;
        const auto& filters = options.filters;
        if (!names.empty() && std::find(names.begin(), names.end(), one.name) == names.end()) continue;
        if (!filters.empty() &&
            std::none_of(filters.begin(), filters.end(), [&](const auto& pattern) { return chooses(pattern, one); }))
            continue;
        if (!backends_of(one, options).empty()) chosen.push_back(&one);
    }
    if (chosen.empty())
        fail_usage(options.backend
                       ? fmt::format("`backend` {}: no case that is asked for names it among its \"backends\"",
                                     backend_name(*options.backend))
                       : std::string("no case has both a name that is given and one that `filter` fits"));
    return chosen;
}

std::vector<SuiteBackend> find_backends(const std::vector<const SuiteCase*>& chosen, const SuiteRunSettings& options) {
    std::vector<SuiteBackend> found;
    for (const Backend backend : {Backend::embree, Backend::cuda}) {
        const bool needed = std::any_of(chosen.begin(), chosen.end(), [&](const SuiteCase* one) {
            if (one->is_foreign()) return false;
            const std::vector<Backend> backends = backends_of(*one, options);
            return std::find(backends.begin(), backends.end(), backend) != backends.end();
        });
        if (!needed) continue;
        SuiteBackend one;
        one.backend = backend;
        try {
            one.devices = choose_devices(backend, options.devices);
        } catch (const Error& error) {
            if (options.backend) throw;
            one.obstacle = error.what();
        }
        found.push_back(std::move(one));
    }
    return found;
}

std::vector<SuiteResult> run_cases(const Suite& suite, const std::vector<const SuiteCase*>& chosen,
                                   const std::vector<SuiteBackend>& backends, const SuiteRunSettings& options,
                                   const SuiteWork& work, RenderProgress& progress) {
    CaseQueue queue(suite, chosen, backends, options, work, progress);
    std::vector<std::jthread> threads;
    const size_t jobs = std::min(static_cast<size_t>(options.jobs), chosen.size());
    try {
        while (threads.size() + 1 < jobs) threads.emplace_back([&] { queue.take_cases(); });
    } catch (const std::system_error&) {  // as many as the system gives
    }
    queue.take_cases();
    threads.clear();
    return queue.results();
}

}  // namespace cistula
