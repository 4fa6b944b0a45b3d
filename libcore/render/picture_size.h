// Parsing of picture sizes and crops: 640x480, 64x64+128+96. Tiles of a frame: the parts that jobs of their own render,
// on whatever machines, and that render-merge puts together.
#pragma once

#include <string>
#include <string_view>

#include "render/record/film.h"

namespace cistula {

struct PictureSize {
    int width = 0;
    int height = 0;
};

inline constexpr int largest_side = 65536;  // pixels

/// Parses a size such as "640x480". Throws Error (usage), as those below: what would be right.
PictureSize parse_size(std::string_view text);

/// Parses a rectangle, "WxH+X+Y"; X and Y from the top left of the full frame.
PixelRect parse_crop(std::string_view text);

/// A grid of tiles over the pixels of a frame. They are numbered from 0, row by row from the top left.
struct TileGrid {
    int columns = 1;
    int rows = 1;

    int count() const { return columns * rows; }
    bool operator==(const TileGrid&) const = default;
};

inline constexpr int most_tiles = 10'000;

/// Parses a grid, "CxR".
TileGrid parse_tiles(std::string_view text);

/// The pixels of a tile, of a grid over these. Sizes differ by one pixel at most; every pixel is in one tile. Throws
/// Error (usage) if there are fewer columns or rows of pixels than of tiles.
PixelRect tile_rect(const PixelRect& whole, const TileGrid& grid, int number);

/// What stands in the name of a tile's file, as a layer's name does: beauty.tile07.0001.exr.
std::string tile_name(const TileGrid& grid, int number);

}  // namespace cistula
