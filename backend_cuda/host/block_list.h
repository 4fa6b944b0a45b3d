// The blocks of a part of a frame that are rendered: those that its cover meets.
#pragma once

#include <vector>

#include "backend_cuda/kernels/block_pixels.h"
#include "scene/frame/frame_hints.h"

namespace cistula {

/// Rows of a frame come in strips of this many, so that several devices can take turns.
inline constexpr int strip_rows = 16;
static_assert(strip_rows % BlockPlan{PixelMapping::own_tiles, most_warps}.shape().height == 0 &&
              tile_height % FrameCover::band_rows == 0);

/// Strips first, first + step, ... of a frame's rectangle: `count` of them.
struct Strips {
    int first = 0, step = 1, count = 0;
};

class BlockList {
  public:
    BlockList() = default;
    /// primitives[h]: what the cover's hull h shows, as in BlockPlace::in_view; all primitives where it has no such
    /// number.
    BlockList(const FrameCover& cover, const std::vector<uint32_t>& primitives, const Strips& strips,
              const BlockPlan& plan);

    /// In the order in which they are rendered.
    const std::vector<BlockPlace>& places() const { return places_; }
    const BlockPlan& plan() const { return plan_; }
    BlockShape shape() const { return plan_.shape(); }

    /// Rows of blocks; visit(row, begin, end) for the pixels in the i-th that no block renders, row by row of the
    /// rectangle.
    int rows() const { return int(listed_.size()) / std::max(columns_, 1); }
    template <class Visit>
    void for_each_gap(int i, const Visit& visit) const {
        const BlockShape shape = this->shape();
        const int top = row_of(i) * shape.height, bottom = std::min(top + shape.height, rect_.height);
        const uint8_t* listed = listed_.data() + size_t(i) * size_t(columns_);
        for (int begin = 0, end; begin < columns_; begin = end) {
            for (end = begin + 1; end < columns_ && listed[end] == listed[begin];) ++end;
            if (listed[begin]) continue;
            for (int row = top; row < bottom; ++row)
                visit(row, begin * shape.width, std::min(end * shape.width, rect_.width));
        }
    }

  private:
    /// visit(block, hull) for each block of the i-th row of blocks and each hull whose outline meets it, perhaps
    /// several times.
    template <class Visit>
    void for_each_met(const FrameCover& cover, int i, const Visit& visit) const;

    /// In the rectangle, of the i-th row of blocks of the part.
    int row_of(int i) const {
        const int in_strip = strip_rows / shape().height;
        return (strips_.first + i / in_strip * strips_.step) * in_strip + i % in_strip;
    }

    /// ... and the other way round; -1: another device's.
    int index_of(int row) const {
        const int in_strip = strip_rows / shape().height, strip = row / in_strip - strips_.first;
        return strip < 0 || strip % strips_.step != 0 ? -1 : strip / strips_.step * in_strip + row % in_strip;
    }

    PixelRect rect_;
    Strips strips_;
    BlockPlan plan_;
    int columns_ = 0;
    std::vector<uint8_t> listed_;  // by rows of blocks
    std::vector<BlockPlace> places_;
};

}  // namespace cistula
