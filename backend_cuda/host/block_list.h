// The blocks of a part of a frame that are rendered: those where the scene may be visible (FrameCover).
#pragma once

#include <vector>

#include "backend_cuda/kernels/block_pixels.h"
#include "render/frame/frame_hints.h"

namespace cistula {

/// The number of rows in a strip; strips are dealt out to several devices in turn.
inline constexpr int strip_rows = 16;
static_assert(strip_rows % BlockPlan{PixelMapping::own_tiles, most_warps}.shape().height == 0 &&
              tile_height % FrameCover::band_rows == 0);

/// A device's strips of a frame's rectangle: first, first + step, ..., `count` of them.
struct Strips {
    int first = 0;
    int step = 1;
    int count = 0;
};

class BlockList {
  public:
    BlockList() = default;
    /// primitives[h]: mask of primitives that hull h of the cover shows, as in BlockPlace::in_view; all primitives
    /// where there is no entry.
    BlockList(const FrameCover& cover, const std::vector<uint32_t>& primitives, const Strips& strips,
              const BlockPlan& plan);

    /// The blocks in the order in which they are rendered.
    const std::vector<BlockPlace>& places() const { return places_; }
    const BlockPlan& plan() const { return plan_; }
    BlockShape shape() const { return plan_.shape(); }

    /// The number of rows of blocks in this part.
    int rows() const { return int(listed_.size()) / std::max(columns_, 1); }
    /// Calls visit(row, begin, end) for the pixels in row i of blocks that no block renders, one row of pixels after
    /// the other.
    template <class Visit>
    void for_each_gap(int i, const Visit& visit) const {
        const BlockShape shape = this->shape();
        const int top = row_of(i) * shape.height;
        const int bottom = std::min(top + shape.height, rect_.height);
        const uint8_t* listed = listed_.data() + size_t(i) * size_t(columns_);
        for (int begin = 0, end; begin < columns_; begin = end) {
            for (end = begin + 1; end < columns_ && listed[end] == listed[begin];) ++end;
            if (listed[begin]) continue;
            for (int row = top; row < bottom; ++row)
                visit(row, begin * shape.width, std::min(end * shape.width, rect_.width));
        }
    }

  private:
    /// Calls visit(block, hull) for each block in row i of blocks and each hull whose outline meets it, perhaps several
    /// times.
    template <class Visit>
    void for_each_met(const FrameCover& cover, int i, const Visit& visit) const;

    /// The number, in the whole rectangle, of this part's row i of blocks.
    int row_of(int i) const {
        const int in_strip = strip_rows / shape().height;
        return (strips_.first + i / in_strip * strips_.step) * in_strip + i % in_strip;
    }

    PixelRect rect_;
    Strips strips_;
    BlockPlan plan_;
    int columns_ = 0;
    std::vector<uint8_t> listed_;  // by rows of blocks
    std::vector<BlockPlace> places_;
};

}  // namespace cistula
