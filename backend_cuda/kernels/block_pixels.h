// The pixels that a block's threads render and the order of their records, for device and host.
#pragma once

#include "backend_cuda/kernels/kernel_shape.h"
#include "cistula/numerics/portable.h"

namespace cistula {

/// Size of a tile: a warp renders 8 x 4 pixels, since neighbors see the same things.
inline constexpr int tile_width = 8;
inline constexpr int tile_height = 4;

/// How the pixels of a block are mapped to its warps.
enum class PixelMapping {
    shared_tile,  // all warps share one tile and divide each pixel's samples among themselves
    own_tiles,    // a tile for each warp
};

/// The size of a block in pixels.
struct BlockShape {
    int width, height;

    CISTULA_INLINE constexpr int pixels() const { return width * height; }
};

struct PixelPlace {
    int column, row;
};

/// The number of a block's warps and the mapping of its pixels to them.
struct BlockPlan {
    PixelMapping mapping = PixelMapping::own_tiles;
    int warps = 4;  // of KernelShape

    static constexpr int width = 2 * tile_width;  // of blocks whose warps have tiles of their own
    static constexpr BlockShape shared_shape = {tile_width, tile_height};

    /// The block's size: one shared tile, or a tile for each warp.
    CISTULA_INLINE constexpr BlockShape shape() const {
        return mapping == PixelMapping::shared_tile ? shared_shape : BlockShape{width, warps / 2 * tile_height};
    }
    /// The pixel, within its block, of record i.
    CISTULA_INLINE PixelPlace place_of(int i) const {
        const int warp = i / warp_threads;
        const int lane = i % warp_threads;
        return {lane % tile_width + warp % 2 * tile_width, lane / tile_width + warp / 2 * tile_height};
    }
};

/// The position of a block in the frame's rectangle, in blocks. Its records are contiguous, in the order of threads.
struct BlockPlace {
    uint16_t column, row;
    uint32_t in_view;  // mask of primitives that may be visible there (BruteIntersector::in_view)
};

}  // namespace cistula
