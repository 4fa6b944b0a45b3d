// Size of the pictures on the page.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

namespace cistula::report {

inline constexpr int largest_small_side = 480;  // pixels

/// The frame's size scaled down, never up, to at most largest_small_side.
inline std::pair<int, int> small_size(int width, int height) {
    const double scale = std::min(1.0, static_cast<double>(largest_small_side) / std::max(width, height));
    return {std::max(1, static_cast<int>(std::lround(width * scale))),
            std::max(1, static_cast<int>(std::lround(height * scale)))};
}

}  // namespace cistula::report
