// Which blocks a device renders: each pixel of a frame is one block's or background, whoever the strips are dealt to.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <set>

#include "backend_cuda/host/block_list.h"
#include "cistula/model/constant_scene.h"
#include "testing/support/camera.h"
#include "testing/support/scene.h"

using namespace cistula;

namespace {

constexpr BlockPlan plans[] = {{PixelMapping::shared_tile},
                               {PixelMapping::shared_tile, most_warps},
                               {PixelMapping::own_tiles},
                               {PixelMapping::own_tiles, most_warps}};

FrameView frame_of(const PixelRect& rect) {
    return test::frame_from({0, 0, 0}, 1, rect.x + rect.width, rect.y + rect.height);
}

/// A triangle and something in a corner.
FrameCover cover_of(const PixelRect& rect) {
    FrameCover cover(rect);
    cover.add(0, {{{-0.6, -0.3, -1}, {0.5, -0.2, -1}, {0.1, 0.4, -1}}, 0}, 1, frame_of(rect));
    cover.add(1, {{{0.98, -0.55, -1}}, 0.05}, 1, frame_of(rect));
    return cover;
}

TEST(BlockList, EveryRecordOfABlockIsAnotherPixels) {
    for (const BlockPlan& plan : plans) {
        const BlockShape shape = plan.shape();
        std::set<std::pair<int, int>> places;
        for (int i = 0; i < shape.pixels(); ++i) {
            const PixelPlace place = plan.place_of(i);
            EXPECT_TRUE(place.column >= 0 && place.column < shape.width && place.row >= 0 && place.row < shape.height)
                << i;
            places.insert({place.row, place.column});
        }
        EXPECT_EQ(places.size(), size_t(shape.pixels()));
    }
}

TEST(BlockList, EveryPixelIsABlocksOrInAGap) {
    for (const PixelRect& rect : {PixelRect{0, 0, 640, 368}, PixelRect{7, 5, 333, 171}, PixelRect{0, 0, 1, 1}}) {
        const FrameCover cover = cover_of(rect);
        for (const BlockPlan& plan : plans)
            for (const int step : {1, 3}) {
                std::vector<int> met(size_t(rect.width) * size_t(rect.height)), covered = met;
                const int strips = (rect.height + strip_rows - 1) / strip_rows;
                size_t blocks = 0;
                for (int first = 0; first < step; ++first) {
                    // Every list gets the same number of strips, though the last strip may lie outside the rectangle.
                    const BlockList list(cover, {1u, 8u}, {first, step, (strips + step - 1) / step}, plan);
                    const BlockShape shape = list.shape();
                    blocks += list.places().size();
                    for (const BlockPlace& block : list.places()) {
                        EXPECT_TRUE(rect.width == 1 || block.in_view == 1 || block.in_view == 8)
                            << block.in_view;  // they are far apart
                        for (int i = 0; i < shape.pixels(); ++i) {
                            const PixelPlace place = plan.place_of(i);
                            const int x = block.column * shape.width + place.column,
                                      y = block.row * shape.height + place.row;
                            if (x >= rect.width || y >= rect.height) continue;
                            ++met[size_t(y) * size_t(rect.width) + size_t(x)];
                            covered[size_t(y) * size_t(rect.width) + size_t(x)] = 1;
                        }
                    }
                    for (int i = 0; i < list.rows(); ++i)
                        list.for_each_gap(i, [&](int row, int begin, int end) {
                            for (int x = begin; x < end; ++x) ++met[size_t(row) * size_t(rect.width) + size_t(x)];
                        });
                }
                EXPECT_EQ(std::count(met.begin(), met.end(), 1), std::ptrdiff_t(met.size()));
                for (int y = 0; y < rect.height; ++y)
                    cover.for_each_part(y, 0, rect.width, [&](int begin, int end, bool is_covered) {
                        for (int x = begin; x < end && is_covered; ++x)
                            EXPECT_TRUE(covered[size_t(y) * size_t(rect.width) + size_t(x)]) << x << ", " << y;
                    });
                EXPECT_TRUE(rect.width == 1 || blocks * size_t(plan.shape().pixels()) < met.size() / 2);
            }
    }
}

TEST(BlockList, BlocksThatAreRenderedTogetherLieCloseTogether) {
    const PixelRect rect{0, 0, 3840, 2160};
    FrameCover cover(rect);
    cover.add_all(FrameCover::Outline::all);
    const BlockList list(cover, {1u, 2u}, {0, 1, rect.height / strip_rows}, BlockPlan());
    ASSERT_EQ(list.places().size(), size_t(3840 / 16 * (2160 / 8)));
    EXPECT_EQ(list.places()[15].column, 15);
    EXPECT_EQ(list.places()[16].column, 0);
    EXPECT_EQ(list.places()[16].row, 1);
    for (const BlockPlace& block : list.places()) EXPECT_EQ(block.in_view, ~0u);
}

/// Solids before sheets, several things before one.
TEST(BlockList, BlocksThatTakeLongestComeFirst) {
    const PixelRect rect{0, 0, 640, 368};
    const FrameView frame = frame_of(rect);
    FrameCover cover(rect);
    for (size_t hull = 0; hull < 3; ++hull) {
        const double x = 0.2 * double(hull);
        cover.add(hull, {{{x - 0.5, -0.3, -1}, {x, -0.3, -1}, {x - 0.2, 0.2, -1}}, 0}, 1, frame);
    }
    constexpr uint32_t sheet = 1u << ShadowPlan::first_cluster;
    const BlockList list(cover, {1u, 2u, sheet}, {0, 1, rect.height / strip_rows}, BlockPlan());
    std::vector<uint32_t> seen;
    for (const BlockPlace& block : list.places())
        if (seen.empty() || seen.back() != block.in_view) seen.push_back(block.in_view);
    ASSERT_GT(seen.size(), 3u);
    EXPECT_EQ(seen.front(), 1u | 2u | sheet);
    EXPECT_EQ(seen.back(), sheet);
    const auto first_of_one = std::ranges::find_if(seen, [](uint32_t in_view) { return std::popcount(in_view) == 1; });
    EXPECT_TRUE(std::all_of(first_of_one, seen.end(), [](uint32_t in_view) { return std::popcount(in_view) == 1; }));
}

TEST(BlockList, BlocksKnowWhatMayShow) {
    const PixelRect rect{0, 0, 640, 368};
    const FrameCover cover = cover_of(rect);
    for (const BlockPlan& plan : plans) {
        const BlockList list(cover, {4u}, {0, 1, rect.height / strip_rows}, plan);
        size_t known = 0;
        for (const BlockPlace& block : list.places()) {
            EXPECT_TRUE(block.in_view == 4u || block.in_view == ~0u) << block.in_view;  // hull 1 has no number
            known += block.in_view == 4u;
        }
        EXPECT_GT(known, list.places().size() / 2);
        EXPECT_LT(known, list.places().size());
    }
}

}  // namespace
