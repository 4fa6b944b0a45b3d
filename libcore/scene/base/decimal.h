// Decimal numbers in text, rounded correctly.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace cistula {

/// The number that a whole word stands for, rounded to nearest: ".5", "5.", "+1e3", also "nan" and "inf"; no
/// hexadecimal. None: the word is no number, or beyond what the type holds.
template <class Number>
std::optional<Number> decimal(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return value;
}

}  // namespace cistula
