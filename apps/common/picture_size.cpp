#include "apps/common/picture_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "apps/common/command_line.h"

namespace cistula {
namespace {

/// Removes "WxH" from the front of `text` and returns it; nothing if it is not there.
std::optional<PictureSize> take_size(std::string_view& text) {
    const size_t x = text.find('x');
    if (x == text.npos) return std::nullopt;
    const size_t end = std::min(text.find('+', x), text.size());
    const auto width = whole_number<int>(text.substr(0, x)),
               height = whole_number<int>(text.substr(x + 1, end - x - 1));
    if (!width || !height || *width < 1 || *height < 1 || *width > largest_side || *height > largest_side)
        return std::nullopt;
    text.remove_prefix(end);
    return PictureSize{*width, *height};
}

}  // namespace

PictureSize parse_size(std::string_view text) {
    std::string_view rest = text;
    const std::optional<PictureSize> size = take_size(rest);
    if (!size || !rest.empty())
        fail_usage(
            fmt::format("--res {}: must be WIDTHxHEIGHT, each from 1 to {}, as in 1280x720", text, largest_side));
    return *size;
}

PixelRect parse_crop(std::string_view text) {
    std::string_view rest = text;
    const std::optional<PictureSize> size = take_size(rest);
    if (size && !rest.empty()) {
        rest.remove_prefix(1);
        const size_t plus = rest.find('+');
        if (plus != rest.npos) {
            const auto x = whole_number<int>(rest.substr(0, plus)), y = whole_number<int>(rest.substr(plus + 1));
            if (x && y && *x >= 0 && *y >= 0) return {*x, *y, size->width, size->height};
        }
    }
    fail_usage(
        fmt::format("--crop {}: must be WIDTHxHEIGHT+X+Y in pixels from the top left, as in 64x64+128+96", text));
}

}  // namespace cistula
