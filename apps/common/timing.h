// Times of runs, repeated ones too: the median is what counts, the range says how far to trust it.
#pragma once

#include <chrono>
#include <vector>

namespace cistula {

/// Milliseconds of one run each.
struct Timing {
    std::vector<double> runs;

    bool empty() const { return runs.empty(); }
    double median() const;  // 0 where there are no runs
    double least() const;
    double most() const;
};

/// Seconds that `work` takes.
template <class Work>
double seconds_of(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace cistula
