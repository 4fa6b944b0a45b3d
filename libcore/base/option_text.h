// Reading values from texts: numbers, choices, lists. What is wrong is an Error (usage) that says what would be
// right; who reads adds the place and the text.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"

namespace cistula {

/// Throws Error (usage).
[[noreturn]] void fail_usage(std::string_view problem, std::string_view remedy = {});

/// The whole of `text` as a number of type T; nothing if it is not one.
template <class T>
std::optional<T> whole_number(std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

/// The text as an integer. Throws Error (usage): "must be a whole number from LOW to HIGH".
int integer_in(const std::string& text, int low, int high);

/// The text as a finite number. Throws Error (usage): "must be WHAT", of which `what` tells the limits.
double number_in(const std::string& text, double low, double high, const char* what);

/// The parts of a list with commas between; a text without commas is one.
std::vector<std::string_view> parts_at_commas(std::string_view text);

/// Throws Error (usage) for an unknown choice: "must be a or b; did you mean 'a'?".
[[noreturn]] void fail_choice(const std::string& text, const std::vector<std::string_view>& names);

/// The choice named `text`. Throws Error (usage).
template <class T>
T chosen(const std::string& text, const std::vector<std::pair<std::string_view, T>>& choices) {
    std::vector<std::string_view> names;
    for (const auto& [name, value] : choices) {
        if (name == text) return value;
        names.push_back(name);
    }
    fail_choice(text, names);
}

}  // namespace cistula
