#include "apps/common/tiles.h"

#include <fmt/format.h>

#include <cstdint>
#include <optional>

#include "apps/common/command_line.h"

namespace cistula {

TileGrid parse_tiles(std::string_view text) {
    const size_t x = text.find('x');
    if (x != text.npos) {
        const auto columns = whole_number<int>(text.substr(0, x)), rows = whole_number<int>(text.substr(x + 1));
        if (columns && rows && *columns > 0 && *rows > 0 && int64_t{*columns} * *rows <= most_tiles)
            return {*columns, *rows};
    }
    fail_usage(fmt::format("--tiles {}: must be CxR, columns and rows of a grid of at most {} tiles, as in 4x3", text,
                           most_tiles));
}

PixelRect tile_rect(const PixelRect& whole, const TileGrid& grid, int number) {
    if (grid.columns > whole.width || grid.rows > whole.height)
        fail_usage(fmt::format("--tiles {}x{}: more than there are pixels, {}x{}; give fewer", grid.columns, grid.rows,
                               whole.width, whole.height));
    const auto edge = [](int length, int parts, int i) { return static_cast<int>(int64_t{length} * i / parts); };
    const int column = number % grid.columns, row = number / grid.columns;
    const int left = edge(whole.width, grid.columns, column), top = edge(whole.height, grid.rows, row);
    return {whole.x + left, whole.y + top, edge(whole.width, grid.columns, column + 1) - left,
            edge(whole.height, grid.rows, row + 1) - top};
}

std::string tile_name(const TileGrid& grid, int number) {
    return fmt::format("tile{:0{}}", number, fmt::formatted_size("{}", grid.count() - 1));
}

}  // namespace cistula
