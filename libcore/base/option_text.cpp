#include "base/option_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/suggest.h"

namespace cistula {

void fail_usage(std::string_view problem, std::string_view remedy) {
    throw Error(ErrorKind::usage, problem, remedy);
}

int integer_in(const std::string& text, int low, int high) {
    const std::optional<int> value = whole_number<int>(text);
    if (!value || *value < low || *value > high)
        fail_usage("", fmt::format("must be a whole number from {} to {}", low, high));
    return *value;
}

double number_in(const std::string& text, double low, double high, const char* what) {
    const std::optional<double> value = whole_number<double>(text);
    if (!value || !std::isfinite(*value) || *value < low || *value > high)
        fail_usage("", fmt::format("must be {}", what));
    return *value;
}

std::vector<std::string_view> parts_at_commas(std::string_view text) {
    std::vector<std::string_view> parts;
    for (size_t begin = 0; begin <= text.size();) {
        const size_t comma = std::min(text.find(',', begin), text.size());
        parts.push_back(text.substr(begin, comma - begin));
        begin = comma + 1;
    }
    return parts;
}

void fail_choice(const std::string& text, const std::vector<std::string_view>& names) {
    fail_usage("", fmt::format("must be {}; {}", fmt::join(names, " or "), suggestion(text, names, "names")));
}

}  // namespace cistula
