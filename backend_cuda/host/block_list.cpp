#include "backend_cuda/host/block_list.h"

#include <algorithm>
#include <array>
#include <bit>

#include "cistula/model/constant_scene.h"

namespace cistula {
namespace {

/// The maximum number of blocks side by side. Wider pictures are rendered in columns of at most so many, among blocks
/// of equal weight: blocks that run at the same time then lie close together and share fetched instructions. 16 took 1
/// to 4 % less time than whole rows on an H200; 8 and 32 took up to 1 % more than 16.
constexpr int most_side_by_side = 16;

/// The maximum weight of a block, its estimated cost. Heavier blocks start first, so that no single block runs long at
/// the end. Trees fork where solids may be visible, and rays take longer the more primitives may be. With one sample at
/// 1280x720 benchmark.json took 14 % less time in float; with 4x4 samples, 4 % less.
constexpr int heaviest = 32;
int weight_of(uint32_t in_view) {
    constexpr uint32_t solids = (1u << ShadowPlan::first_cluster) - 1;
    return (in_view & solids) != 0 ? std::popcount(in_view) : 0;
}

}  // namespace

BlockList::BlockList(const FrameCover& cover, const std::vector<uint32_t>& primitives, const Strips& strips,
                     const BlockPlan& plan)
    : rect_(cover.rect()), strips_(strips), plan_(plan) {
    const BlockShape shape = this->shape();
    columns_ = (rect_.width + shape.width - 1) / shape.width;
    const int all = strips.count * (strip_rows / shape.height);
    listed_.assign(size_t(all) * size_t(columns_), 0);
    std::vector<uint32_t> in_view(listed_.size());
    int rows = 0;  // rows of blocks that lie in the rectangle
    for (int i = 0; i < all && row_of(i) * shape.height < rect_.height; rows = ++i) {
        for_each_met(cover, i, [&](size_t block, size_t hull) {
            listed_[block] = 1;
            in_view[block] |= hull < primitives.size() ? primitives[hull] : ~0u;
        });
    }
    listed_.resize(size_t(rows) * size_t(columns_));
    const size_t count = size_t(std::count(listed_.begin(), listed_.end(), 1));
    places_.reserve(count);
    const int groups = (columns_ + most_side_by_side - 1) / most_side_by_side;
    const int width = (columns_ + groups - 1) / groups;
    std::array<std::vector<size_t>, heaviest + 1> by_weight;
    for (int left = 0; left < columns_; left += width)
        for (int i = 0; i < rows; ++i)
            for (int column = left; column < std::min(left + width, columns_); ++column) {
                const size_t block = size_t(i) * size_t(columns_) + size_t(column);
                if (listed_[block]) by_weight[size_t(weight_of(in_view[block]))].push_back(block);
            }
    for (int weight = heaviest; weight >= 0; --weight)
        for (const size_t block : by_weight[size_t(weight)]) {
            places_.push_back(
                {uint16_t(block % size_t(columns_)), uint16_t(row_of(int(block / size_t(columns_)))), in_view[block]});
        }
}

template <class Visit>
void BlockList::for_each_met(const FrameCover& cover, int i, const Visit& visit) const {
    const BlockShape shape = this->shape();
    const int top = row_of(i) * shape.height;
    const int bottom = std::min(top + shape.height, rect_.height);
    for (int row = top; row < bottom; row += FrameCover::band_rows)
        for (const FrameCover::Outline& outline : cover.outlines()) {
            const PixelRun run = outline.run(row);
            for (int x = run.begin; x < run.end; x += shape.width - x % shape.width)
                visit(size_t(i) * size_t(columns_) + size_t(x / shape.width), outline.hull);
        }
}

}  // namespace cistula
