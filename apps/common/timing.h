// Times of repeated runs: median and range.
#pragma once

#include <chrono>
#include <vector>

namespace cistula {

/// Run times in milliseconds, one per run.
struct Timing {
    std::vector<double> runs;

    bool empty() const { return runs.empty(); }
    double median() const;  // 0 if there are no runs
    double least() const;
    double most() const;
};

/// Wall time of `work` in seconds.
template <class Work>
double seconds_of(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace cistula
