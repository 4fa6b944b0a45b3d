#include "sequence/frame_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>

#include "base/error.h"
#include "base/option_text.h"

namespace cistula {
namespace {

/// Removes a number from the front of `rest` and returns it; nothing if there are no digits or too many.
std::optional<int> take_number(std::string_view& rest) {
    if (rest.empty() || rest[0] < '0' || rest[0] > '9') return std::nullopt;
    int value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error != std::errc() || value > largest_frame) return std::nullopt;
    rest.remove_prefix(static_cast<size_t>(end - rest.data()));
    return value;
}

struct FrameRange {
    int first, last, step;
};

FrameRange parse_range(std::string_view item) {
    const auto malformed = [&]() {
        fail_usage(fmt::format("\"{}\" is no frame (0 to {}), no range A-B and no range with a step A-BxS",
                               first_characters(item, 40), largest_frame),
                   "a list looks like 0-299x5,7");
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
    if (*last < *first) fail_usage(fmt::format("{} runs backward", item), fmt::format("write {}-{}", *last, *first));
    if (step == 0) fail_usage(fmt::format("the step of {} must be 1 or more", item));
    return {*first, *last, step};
}

}  // namespace

std::vector<int> parse_frames(std::string_view text) {
    std::vector<int> frames;
    std::vector<bool> seen(largest_frame + 1);
    size_t written = 0;
    for (const std::string_view part : parts_at_commas(text)) {
        const FrameRange range = parse_range(part);
        for (int64_t frame = range.first; frame <= range.last; frame += range.step) {
            if (++written > most_frames)
                fail_usage(fmt::format("more than {} frames", most_frames), "render them in several runs");
            const auto index = static_cast<size_t>(frame);
            if (!seen[index]) frames.push_back(static_cast<int>(frame));
            seen[index] = true;
        }
    }
    return frames;
}

std::string format_frames(const std::vector<int>& frames, size_t begin) {
    std::string text;
    for (size_t i = begin; i < frames.size();) {
        const int first = frames[i];
        const int step = i + 1 < frames.size() ? frames[i + 1] - first : 0;
        size_t end = i + 1;
        while (step > 0 && end < frames.size() && frames[end] == frames[end - 1] + step) ++end;
        if (end - i == 2 && step > 1) --end;  // two frames apart, not a range
        if (!text.empty()) text += ',';
        text += fmt::format("{}", first);
        if (end - i > 1) text += fmt::format("-{}", frames[end - 1]);
        if (end - i > 1 && step > 1) text += fmt::format("x{}", step);
        i = end;
    }
    return text;
}

std::vector<int> frames_from(const std::vector<int>& frames, size_t begin, size_t count) {
    const auto first = frames.begin() + static_cast<std::ptrdiff_t>(std::min(begin, frames.size()));
    return {first, first + std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(count), frames.end() - first)};
}

}  // namespace cistula
