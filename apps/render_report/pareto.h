// Pareto front of (time, error) points.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace cistula::report {

/// A point with positive time and error.
struct CostPoint {
    double time = 0, error = 0;
};

/// Least relative gain in error by which a slower point joins the front.
inline constexpr double least_gain = 0.01;

/// Indices of the points that no other point beats in both, by ascending time; the first of equal ones.
std::vector<size_t> pareto_front(const std::vector<CostPoint>& points, double gain = least_gain);

/// Index in `front` of its knee: the point farthest below the line between the front's ends, in logarithmic axes scaled
/// to the front; of two points the faster. Nothing for an empty front.
std::optional<size_t> knee_of(const std::vector<CostPoint>& points, const std::vector<size_t>& front);

/// Factor on time for a tenth of the error, from a least-squares line through the front's logarithms. Nothing for fewer
/// than three points or a front that does not fall.
std::optional<double> time_per_digit(const std::vector<CostPoint>& points, const std::vector<size_t>& front);

}  // namespace cistula::report
