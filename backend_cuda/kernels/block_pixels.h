// Which pixels a block's threads render, and where it leaves their records, on the device and on the host.
#pragma once

#include "backend_cuda/kernels/kernel_shape.h"
#include "cistula/numerics/portable.h"

namespace cistula {

/// A warp renders 8 x 4 pixels: neighbors see the same things.
inline constexpr int tile_width = 8, tile_height = 4;

/// Which pixels the warps of a block render.
enum class PixelMapping {
    shared_tile,  // one tile, for every warp: where pixels have several samples, so that no thread is long at work
    own_tiles,    // a tile for each warp
};

/// Pixels of a block.
struct BlockShape {
    int width, height;

    CISTULA_INLINE constexpr int pixels() const { return width * height; }
};

struct PixelPlace {
    int column, row;
};

/// The warps of a block, and which of its pixels are whose.
struct BlockPlan {
    PixelMapping mapping = PixelMapping::own_tiles;
    int warps = 4;  // of KernelShape

    static constexpr int width = 2 * tile_width;  // of blocks that do not share a tile
    static constexpr BlockShape shared_shape = {tile_width, tile_height};

    /// The block's pixels: a shared tile, or a tile for each warp.
    CISTULA_INLINE constexpr BlockShape shape() const {
        return mapping == PixelMapping::shared_tile ? shared_shape : BlockShape{width, warps / 2 * tile_height};
    }
    /// The pixel, in its block, of record i.
    CISTULA_INLINE PixelPlace place_of(int i) const {
        const int warp = i / warp_threads, lane = i % warp_threads;
        return {lane % tile_width + warp % 2 * tile_width, lane / tile_width + warp / 2 * tile_height};
    }
};

/// Where a block lies in the frame's rectangle, in blocks. Its records come one after the other, in the order of
/// threads.
struct BlockPlace {
    uint16_t column, row;
    uint32_t in_view;  // the primitives that may show there (BruteIntersector::in_view)
};

}  // namespace cistula
