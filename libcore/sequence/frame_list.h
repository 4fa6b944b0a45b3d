// Lists of frames such as 0-299x5,7, in the order in which they are rendered: their parsing and printing.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace cistula {

inline constexpr int largest_frame = 9'999'999;
inline constexpr size_t most_frames = 1'000'000;

/// The frames of a comma-separated list of N, A-B and A-BxSTEP, in the order written, without duplicates. Throws Error
/// (usage) that quotes the wrong part and says what would be right.
std::vector<int> parse_frames(std::string_view text);

/// A list as the command line takes it, of the frames from the index `begin` on: "1-3,7", "0-20x5".
std::string format_frames(const std::vector<int>& frames, size_t begin = 0);

/// The `count` frames of a list from the index `begin` on, fewer where it ends.
std::vector<int> frames_from(const std::vector<int>& frames, size_t begin, size_t count);

}  // namespace cistula
