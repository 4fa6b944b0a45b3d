// Characters between words.
#pragma once

#include <string_view>

namespace cistula {

/// Characters that ASCII counts as white space.
inline constexpr std::string_view blanks = " \t\r\n\v\f";

}  // namespace cistula
