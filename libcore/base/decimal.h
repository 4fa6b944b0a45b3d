// Decimal numbers in text, rounded correctly.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

namespace cistula {

/// Whether a decimal number without a "+" before it, which is not 0, lies between -1 and 1.
inline bool is_below_one(std::string_view word) {
    const size_t e = std::min(word.find_first_of("eE"), word.size());
    const std::string_view digits = word.substr(0, e);
    std::string_view power = word.substr(std::min(e + 1, word.size()));
    if (power.starts_with('+')) power.remove_prefix(1);
    int64_t exponent = 0;
    if (std::from_chars(power.data(), power.data() + power.size(), exponent).ec == std::errc::result_out_of_range)
        return power.starts_with('-');
    const auto first = static_cast<int64_t>(std::min(digits.find_first_of("123456789"), digits.size()));
    const auto point = static_cast<int64_t>(std::min(digits.find('.'), digits.size()));
    // That of the first digit: 0 for units.
    const int64_t place = first < point ? point - first - 1 : point - first;
    return exponent < -place;
}

/// The number that a whole word stands for, rounded to nearest: ".5", "5.", "+1e3", also "nan" and "inf"; no
/// hexadecimal. None: the word is no number, or beyond what the type holds.
template <class Number>
std::optional<Number> decimal(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size()) return std::nullopt;
    if constexpr (std::is_floating_point_v<Number>)
        if (error == std::errc::result_out_of_range && is_below_one(word))
            return Number(word.starts_with('-') ? -0.0 : 0);
    if (error != std::errc()) return std::nullopt;
    return value;
}

}  // namespace cistula
