// Parsing and printing of frame lists such as 0-299x5,7.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cistula {

inline constexpr int largest_frame = 9'999'999;
inline constexpr size_t most_frames = 1'000'000;

/// The frames of a comma-separated list of N, A-B and A-BxSTEP, in the order written, without duplicates. Throws Error
/// (usage) that quotes the wrong part and says what would be right.
std::vector<int> parse_frames(std::string_view text);

/// The shortest list for these frames, runs as ranges: {1, 2, 3, 7} -> "1-3,7". The inverse of parse_frames.
std::string format_frames(const std::vector<int>& frames);

}  // namespace cistula
