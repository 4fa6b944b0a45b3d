// "Did you mean": the known name nearest to a misspelled one.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/shown_text.h"

namespace cistula {

/// The text with A to Z in lower case.
inline std::string lower_case(std::string text) {
    for (char& letter : text)
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    return text;
}

/// Optimal string alignment distance: the least number of insertions, deletions, substitutions and swaps of neighboring
/// bytes that turn a into b.
size_t edit_distance(std::string_view a, std::string_view b);

/// "did you mean 'width'?" if one of `known` is what other programs call `name`, is near it, differs in case alone or
/// begins with it, else "known keys: a, b, c"; `plural` is their collective name ("keys").
std::string suggestion(std::string_view name, const std::vector<std::string_view>& known, std::string_view plural);

/// All that are known, what other programs call `name` first, then those most like it, whatever the case of letters:
/// "the views are: filmic, srgb"; of more than 64 the first, and their number.
std::string nearest_first(std::string_view name, const std::vector<std::string_view>& known, std::string_view plural);

/// The key, here, of what other programs call by the name of an option, as "--fps"; "" where none is known.
std::string_view scene_key_of_option(std::string_view name);

}  // namespace cistula
