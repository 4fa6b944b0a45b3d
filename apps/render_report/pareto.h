// Which of many (time, error) points are worth their time.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace cistula::report {

/// Both above 0.
struct CostPoint {
    double time = 0, error = 0;
};

/// A slower point joins the front only if its error is less by this share: what is closer by a hair is no choice.
inline constexpr double least_gain = 0.01;

/// The points that no other one beats in both, by rising time; of equal ones the first.
std::vector<size_t> pareto_front(const std::vector<CostPoint>& points, double gain = least_gain);

/// The place in `front` where going on begins to cost more than it gains: the point farthest below the straight line
/// between the front's ends, both axes logarithmic and scaled to the front. Of two points the quicker; nothing for
/// none.
std::optional<size_t> knee_of(const std::vector<CostPoint>& points, const std::vector<size_t>& front);

/// By how much the time must be multiplied for a tenth of the error, along the line through the front's logarithms by
/// least squares. Nothing for fewer than three points, or a front that does not fall.
std::optional<double> time_per_digit(const std::vector<CostPoint>& points, const std::vector<size_t>& front);

}  // namespace cistula::report
