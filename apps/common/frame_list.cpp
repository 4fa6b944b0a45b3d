#include "apps/common/frame_list.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <unordered_set>

#include "scene/base/error.h"

namespace cistula {
namespace {

[[noreturn]] void fail(std::string_view text, const std::string& what) {
    throw Error(ExitCode::usage, fmt::format("--frames {}: {}", text, what));
}

/// Removes a number from the front of `rest` and returns it; nothing if there are no digits or too many.
std::optional<int> take_number(std::string_view& rest) {
    if (rest.empty() || rest[0] < '0' || rest[0] > '9') return std::nullopt;
    int value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error != std::errc() || value > largest_frame) return std::nullopt;
    rest.remove_prefix(static_cast<size_t>(end - rest.data()));
    return value;
}

struct Range {
    int first, last, step;
};

Range parse_range(std::string_view text, std::string_view item) {
    const auto malformed = [&]() {
        fail(text, fmt::format("\"{}\" is no frame (0 to {}), no range A-B and no range with a step A-BxS; "
                               "a list looks like 0-299x5,7",
                               item, largest_frame));
    };
    std::string_view rest = item;
    const std::optional<int> first = take_number(rest);
    if (!first) malformed();
    if (rest.empty()) return {*first, *first, 1};
    if (rest[0] != '-') malformed();
    rest.remove_prefix(1);
    const std::optional<int> last = take_number(rest);
    if (!last) malformed();
    int step = 1;
    if (!rest.empty()) {
        if (rest[0] != 'x') malformed();
        rest.remove_prefix(1);
        const std::optional<int> given = take_number(rest);
        if (!given || !rest.empty()) malformed();
        step = *given;
    }
    if (*last < *first) fail(text, fmt::format("{} runs backward; write {}-{}", item, *last, *first));
    if (step == 0) fail(text, fmt::format("the step of {} must be 1 or more", item));
    return {*first, *last, step};
}

}  // namespace

std::vector<int> parse_frames(std::string_view text) {
    std::vector<int> frames;
    std::unordered_set<int> seen;
    size_t begin = 0;
    while (true) {
        const size_t comma = text.find(',', begin);
        const Range range = parse_range(text, text.substr(begin, comma == text.npos ? text.npos : comma - begin));
        for (int64_t frame = range.first; frame <= range.last; frame += range.step) {
            if (!seen.insert(static_cast<int>(frame)).second) continue;
            frames.push_back(static_cast<int>(frame));
            if (frames.size() > most_frames) fail(text, fmt::format("more than {} frames", most_frames));
        }
        if (comma == text.npos) return frames;
        begin = comma + 1;
    }
}

std::string format_frames(const std::vector<int>& frames) {
    std::string text;
    for (size_t i = 0; i < frames.size();) {
        size_t end = i + 1;
        while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
        if (!text.empty()) text += ',';
        text += end - i > 1 ? fmt::format("{}-{}", frames[i], frames[end - 1]) : fmt::format("{}", frames[i]);
        i = end;
    }
    return text;
}

}  // namespace cistula
