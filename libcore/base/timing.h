// Times of repeated runs: median and range.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace cistula {

/// Run times in milliseconds, one per run.
struct Timing {
    std::vector<double> runs;

    bool empty() const { return runs.empty(); }
    /// 0 if there are no runs.
    double median() const {
        if (runs.empty()) return 0;
        std::vector<double> sorted = runs;
        std::sort(sorted.begin(), sorted.end());
        const size_t half = sorted.size() / 2;
        return sorted.size() % 2 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
    }
    double least() const { return runs.empty() ? 0 : *std::min_element(runs.begin(), runs.end()); }
    double most() const { return runs.empty() ? 0 : *std::max_element(runs.begin(), runs.end()); }
};

/// Wall time of `work` in seconds.
template <class Work>
double seconds_of(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace cistula
