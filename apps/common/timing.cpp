#include "apps/common/timing.h"

#include <algorithm>

namespace cistula {

double Timing::median() const {
    if (runs.empty()) return 0;
    std::vector<double> sorted = runs;
    std::sort(sorted.begin(), sorted.end());
    const size_t half = sorted.size() / 2;
    return sorted.size() % 2 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
}

double Timing::least() const {
    return runs.empty() ? 0 : *std::min_element(runs.begin(), runs.end());
}

double Timing::most() const {
    return runs.empty() ? 0 : *std::max_element(runs.begin(), runs.end());
}

}  // namespace cistula
