#include "pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace cistula::report {

std::vector<size_t> pareto_front(const std::vector<CostPoint>& points, double gain) {
    std::vector<size_t> order(points.size()), front;
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
        return points[a].time != points[b].time ? points[a].time < points[b].time : points[a].error < points[b].error;
    });
    double least = std::numeric_limits<double>::infinity();
    for (const size_t i : order)
        if (points[i].error < least && points[i].error <= (1 - gain) * least) {
            least = points[i].error;
            front.push_back(i);
        }
    return front;
}

std::optional<size_t> knee_of(const std::vector<CostPoint>& points, const std::vector<size_t>& front) {
    if (front.empty()) return std::nullopt;
    const CostPoint &first = points[front.front()], &last = points[front.back()];
    const double width = std::log(last.time / first.time), height = std::log(first.error / last.error);
    size_t knee = front.front();
    double farthest = 0;
    for (const size_t i : front) {
        if (!(width > 0 && height > 0)) break;
        const double below =
            1 - std::log(points[i].time / first.time) / width - std::log(points[i].error / last.error) / height;
        if (below > farthest) farthest = below, knee = i;
    }
    return knee;
}

std::optional<double> time_per_digit(const std::vector<CostPoint>& points, const std::vector<size_t>& front) {
    if (front.size() < 3) return std::nullopt;
    double mean_time = 0, mean_error = 0, both = 0, errors = 0;
    const double count = static_cast<double>(front.size());
    for (const size_t i : front) {
        mean_time += std::log10(points[i].time) / count;
        mean_error += std::log10(points[i].error) / count;
    }
    for (const size_t i : front) {
        const double error = std::log10(points[i].error) - mean_error;
        both += error * (std::log10(points[i].time) - mean_time);
        errors += error * error;
    }
    if (!(errors > 0 && both < 0)) return std::nullopt;
    return std::pow(10.0, -both / errors);
}

}  // namespace cistula::report
