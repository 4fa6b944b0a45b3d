// "Did you mean": the nearest of the names that would have been right.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace cistula {

/// Insertions, deletions, substitutions and swaps of neighbors that lead from a to b (optimal string alignment, bytes).
size_t edit_distance(std::string_view a, std::string_view b);

/// "did you mean 'width'?" where one of `known` is near, else "known keys: a, b, c"; `plural` says what they are.
std::string suggestion(std::string_view name, const std::vector<std::string_view>& known, std::string_view plural);

/// The text on one line: control characters become escapes. Names from files go through this on their way to a message.
std::string one_line(std::string_view text);

}  // namespace cistula
