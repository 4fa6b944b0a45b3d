#include "base/option_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>

#include "base/suggest.h"

namespace cistula {

void fail_usage(const std::string& message) {
    throw Error(ExitCode::usage, message);
}

int integer_in(const std::string& text, int low, int high) {
    const std::optional<int> value = whole_number<int>(text);
    if (!value || *value < low || *value > high)
        fail_usage(fmt::format("must be a whole number from {} to {}", low, high));
    return *value;
}

double number_in(const std::string& text, double low, double high, const char* what) {
    const std::optional<double> value = whole_number<double>(text);
    if (!value || !std::isfinite(*value) || *value < low || *value > high) fail_usage(fmt::format("must be {}", what));
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
    fail_usage(fmt::format("must be {}; {}", fmt::join(names, " or "), suggestion(text, names, "names")));
}

Failure failure_of(const std::exception& error, const std::string& memory_advice) {
    const std::string_view text = error.what();
    const auto says = [&](const char* words) { return text.find(words) != std::string_view::npos; };
    if (says("Resource temporarily unavailable"))  // of the system, by the standard library or TBB
        return {"cannot start a thread, for want of memory or of processes (ulimit -u); " + memory_advice,
                ExitCode::failed};
    if (dynamic_cast<const std::bad_alloc*>(&error) || dynamic_cast<const std::length_error*>(&error) ||
        says("Cannot allocate memory") ||
        text.ends_with("failed to map segment from shared object"))  // the loader's; another reason would follow
        return {"out of memory; " + memory_advice, ExitCode::failed};
    const auto* ours = dynamic_cast<const Error*>(&error);
    return {error.what(), ours ? ours->code() : ExitCode::failed};
}

}  // namespace cistula
