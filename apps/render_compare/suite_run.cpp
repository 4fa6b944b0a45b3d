#include "suite_run.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>

#include "apps/common/interrupt.h"
#include "scene/base/error.h"
#include "scene/image/exr/exr.h"

namespace cistula {
namespace {

/// The cases of a run, taken one after the other by several threads.
class CaseQueue {
  public:
    CaseQueue(const Suite& suite, const std::vector<const SuiteCase*>& chosen,
              const std::vector<SuiteBackend>& backends, const SuiteOptions& options, const SuiteWork& work)
        : suite_(suite), chosen_(chosen), backends_(backends), options_(options), work_(work), done_(chosen.size()) {}

    std::atomic<bool>& stop() { return progress_.stop; }

    /// Takes cases until there are no more. One thread's failure ends all of them.
    void take_cases() {
        try {
            for (size_t i = next_++; i < chosen_.size() && !progress_.stop && !failed_; i = next_++)
                finish(i, results_of(*chosen_[i]));
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!failure_) failure_ = std::current_exception();
            progress_.stop = true;
        }
    }

    /// All results, in the order of the file.
    std::vector<SuiteResult> results() {
        if (failure_) std::rethrow_exception(failure_);
        std::vector<SuiteResult> all;
        for (std::optional<std::vector<SuiteResult>>& results : done_)
            if (results)
                for (SuiteResult& result : *results) all.push_back(std::move(result));
        return all;
    }

  private:
    const SuiteBackend& machine(Backend backend) const {
        return *std::find_if(backends_.begin(), backends_.end(),
                             [&](const SuiteBackend& one) { return one.backend == backend; });
    }

    /// One backend that is there records a new golden image; all compare.
    std::vector<Backend> backends_for(const SuiteCase& one) const {
        const std::vector<Backend> all = backends_of(one, options_);
        if (!options_.update) return all;
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
        const SuiteBackend& on = machine(backend);
        if (!on.obstacle.empty()) {
            for (SuiteResult& result : results) result.verdict = on.obstacle;
            return results;
        }
        std::unique_lock<std::mutex> device(device_, std::defer_lock);
        if (backend == Backend::cuda) device.lock();  // its memory is for one scene at a time
        try {
            const SuiteScene scene = prepare_case(one, suite_.folder, backend, on.devices.options, progress_.stop);
            for (size_t i = 0; i < results.size(); ++i) {
                results[i].precision = scene.precision;
                results[i].notes = scene.notes;
                check_frame(scene, i, results[i]);
            }
        } catch (const Error& error) {
            if (error.code() == ExitCode::interrupted) throw;
            for (SuiteResult& result : results) set_broken(result, error);
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
            judge(frame, index, golden ? &*golden : nullptr, result);
            if (!unreadable.empty()) {
                result.outcome = Outcome::broken;
                result.verdict = unreadable;
            }
            if (work_.judged) work_.judged(frame, golden ? &*golden : nullptr, result);
        } catch (const Error& error) {
            if (error.code() == ExitCode::interrupted) throw;
            set_broken(result, error);
        }
    }

    static void set_broken(SuiteResult& result, const Error& error) {
        result.outcome = Outcome::broken;
        result.verdict = error.what();
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
    const SuiteOptions& options_;
    const SuiteWork& work_;
    RenderProgress progress_;
    std::atomic<size_t> next_{0};
    std::atomic<bool> failed_{false};
    std::mutex mutex_, device_;
    std::exception_ptr failure_;
    std::vector<std::optional<std::vector<SuiteResult>>> done_;
    size_t told_ = 0;
};

}  // namespace

std::vector<SuiteBackend> find_backends(const std::vector<const SuiteCase*>& chosen, const SuiteOptions& options) {
    std::vector<SuiteBackend> found;
    for (const Backend backend : {Backend::embree, Backend::cuda}) {
        const bool needed = std::any_of(chosen.begin(), chosen.end(), [&](const SuiteCase* one) {
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
                                   const std::vector<SuiteBackend>& backends, const SuiteOptions& options,
                                   const SuiteWork& work) {
    CaseQueue queue(suite, chosen, backends, options, work);
    InterruptGuard guard;
    guard.watch(queue.stop());
    std::vector<std::jthread> threads;
    const size_t jobs = std::min(static_cast<size_t>(options.jobs), chosen.size());
    while (threads.size() + 1 < jobs) threads.emplace_back([&] { queue.take_cases(); });
    queue.take_cases();
    threads.clear();
    std::vector<SuiteResult> results = queue.results();
    if (queue.stop()) throw Error(ExitCode::interrupted, "interrupted; no results are written");
    return results;
}

}  // namespace cistula
