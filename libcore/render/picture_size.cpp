#include "render/picture_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>

#include "base/option_text.h"

namespace cistula {
namespace {

/// Removes "WxH" from the front of `text` and returns it; nothing if it is not there.
std::optional<PictureSize> take_size(std::string_view& text) {
    const size_t x = text.find('x');
    if (x == text.npos) return std::nullopt;
    const size_t end = std::min(text.find_first_of("+-", x), text.size());
    const auto width = whole_number<int>(text.substr(0, x));
    const auto height = whole_number<int>(text.substr(x + 1, end - x - 1));
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
        fail_usage("", fmt::format("must be WIDTHxHEIGHT, each from 1 to {}, as in 1280x720", largest_side));
    return *size;
}

PixelRect parse_crop(std::string_view text) {
    std::string_view rest = text;
    const std::optional<PictureSize> size = take_size(rest);
    if (size && !rest.empty()) {
        const size_t second = rest.find_first_of("+-", 1);
        const auto number = [](std::string_view part) { return whole_number<int>(part.substr(part.starts_with('+'))); };
        if (second != rest.npos) {
            const auto x = number(rest.substr(0, second));
            const auto y = number(rest.substr(second));
            if (x && y && rest.find("+-") == rest.npos) return {*x, *y, size->width, size->height};
        }
    }
    fail_usage("", "must be WIDTHxHEIGHT+X+Y in pixels from the top left, as in 64x64+128+96");
}

TileGrid parse_tiles(std::string_view text) {
    const size_t x = text.find('x');
    if (x != text.npos) {
        const auto columns = whole_number<int>(text.substr(0, x));
        const auto rows = whole_number<int>(text.substr(x + 1));
        if (columns && rows && *columns > 0 && *rows > 0 && int64_t{*columns} * *rows <= most_tiles)
            return {*columns, *rows};
    }
    fail_usage("", fmt::format("must be CxR, columns and rows of a grid of at most {} tiles, as in 4x3", most_tiles));
}

PixelRect tile_rect(const PixelRect& whole, const TileGrid& grid, int number) {
    if (grid.columns > whole.width || grid.rows > whole.height)
        fail_usage(fmt::format("`tiles` {}x{}: more than there are pixels, {}x{}", grid.columns, grid.rows, whole.width,
                               whole.height),
                   "give fewer");
    const auto edge = [](int length, int parts, int i) { return static_cast<int>(int64_t{length} * i / parts); };
    const int column = number % grid.columns;
    const int row = number / grid.columns;
    const int left = edge(whole.width, grid.columns, column);
    const int top = edge(whole.height, grid.rows, row);
    return {whole.x + left, whole.y + top, edge(whole.width, grid.columns, column + 1) - left,
            edge(whole.height, grid.rows, row + 1) - top};
}

std::string tile_name(const TileGrid& grid, int number) {
    return fmt::format("tile{:0{}}", number, fmt::formatted_size("{}", grid.count() - 1));
}

}  // namespace cistula
