// Which pixels a block's threads render, and where it leaves their records, on the device and on the host.
#pragma once

#include "cistula/pixel.h"

namespace cistula {

inline constexpr int warp_threads = 32, block_warps = 4, block_threads = warp_threads * block_warps;
/// A warp renders 8 x 4 pixels, next to each other or every other two: neighbors see the same things.
inline constexpr int tile_width = 8, tile_height = 4;

/// How the pixels of a block are dealt out: by twos at the least, as two threads' records side by side are whole words of 16
/// bytes and cause few conflicts between the banks of shared memory.
enum class Deal {
    shared,       // one tile, for every warp: where pixels have several samples, so that no thread is long at work
    tiles,        // a tile a warp
    interleaved,  // to a warp every other two of a row, and every other row
};

/// Pixels of a block.
struct BlockShape {
    int width, height;

    CISTULA_INLINE static constexpr BlockShape of(Deal deal) {
        return deal == Deal::shared ? BlockShape{tile_width, tile_height} : BlockShape{2 * tile_width, 2 * tile_height};
    }
    CISTULA_INLINE constexpr int pixels() const { return width * height; }
    /// Parts of tile_width x tile_height pixels, row by row.
    CISTULA_INLINE constexpr int tiles() const { return pixels() / (tile_width * tile_height); }
    CISTULA_INLINE constexpr int tile_of(int column, int row) const {
        return row / tile_height * (width / tile_width) + column / tile_width;
    }
};

/// Where a block lies in the frame's rectangle, in blocks. Its records come one after the other, in the order of threads.
struct BlockPlace {
    uint16_t column, row;
    uint32_t in_view;  // the primitives that may show there (BruteIntersector::in_view)
};

struct PixelPlace {
    int column, row;
};

/// The pixel, in its block, of record i.
CISTULA_INLINE PixelPlace place_in_block(Deal deal, int i) {
    const int warp = i / warp_threads, lane = i % warp_threads, x = lane % tile_width, y = lane / tile_width;
    if (deal == Deal::interleaved) return {x / 2 * 4 + warp % 2 * 2 + x % 2, 2 * y + warp / 2};
    return {x + warp % 2 * tile_width, y + warp / 2 * tile_height};
}

}  // namespace cistula
