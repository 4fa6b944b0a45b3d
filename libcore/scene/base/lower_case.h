// Letters without case.
#pragma once

#include <string>

namespace cistula {

/// The text with A to Z in lower case.
inline std::string lower_case(std::string text) {
    for (char& letter : text)
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    return text;
}

}  // namespace cistula
