// Frame lists as people write them: 0-299x5,7.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cistula {

inline constexpr int largest_frame = 9'999'999;
inline constexpr size_t most_frames = 1'000'000;

/// The frames of a list of N, A-B and A-BxSTEP between commas, in the order written, each once.
/// Throws Error (usage) that quotes the part that is wrong and says what would be right.
std::vector<int> parse_frames(std::string_view text);

/// The shortest list that parse_frames reads as these frames, whole runs as ranges: {1, 2, 3, 7} -> "1-3,7".
std::string format_frames(const std::vector<int>& frames);

}  // namespace cistula
