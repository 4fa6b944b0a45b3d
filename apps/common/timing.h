// Times of repeated runs: the median is what counts, the range says how far to trust it.
#pragma once

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

}  // namespace cistula
