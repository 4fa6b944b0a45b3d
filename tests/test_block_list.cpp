// Which blocks a device renders: each pixel of a frame is one block's or background, whoever the strips are dealt to.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <set>

#include "backend_cuda/block_list.h"
#include "cistula/small_scene.h"
#include "support_camera.h"
#include "support_scene.h"

using namespace cistula;

namespace {

constexpr BlockPlan plans[] = {{Deal::shared},
                               {Deal::shared, large_block_warps},
                               {Deal::tiles},
                               {Deal::tiles, large_block_warps},
                               {Deal::interleaved, large_block_warps}};

FrameView frame_of(const PixelRect& rect) {
    return test::frame_from({0, 0, 0}, 1, rect.x + rect.width, rect.y + rect.height);
}

LitCells by_tiles(const LightImages& lights) {
    return LitCells(lights, tile_width, tile_height);
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
                    // As many for each, though the last may lie beyond the rectangle.
                    const BlockList list(cover, FrameCover(rect), by_tiles(LightImages(rect)), {1u, 8u},
                                         {first, step, (strips + step - 1) / step}, plan);
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
    const BlockList list(cover, FrameCover(rect), by_tiles(LightImages(rect)), {1u, 2u},
                         {0, 1, rect.height / strip_rows}, BlockPlan());
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
    const BlockList list(cover, FrameCover(rect), by_tiles(LightImages(rect)), {1u, 2u, sheet},
                         {0, 1, rect.height / strip_rows}, BlockPlan());
    std::vector<uint32_t> seen;
    for (const BlockPlace& block : list.places())
        if (seen.empty() || seen.back() != block.in_view) seen.push_back(block.in_view);
    ASSERT_GT(seen.size(), 3u);
    EXPECT_EQ(seen.front(), 1u | 2u | sheet);
    EXPECT_EQ(seen.back(), sheet);
    const auto first_of_one = std::ranges::find_if(seen, [](uint32_t in_view) { return std::popcount(in_view) == 1; });
    EXPECT_TRUE(std::all_of(first_of_one, seen.end(), [](uint32_t in_view) { return std::popcount(in_view) == 1; }));
}

/// After solids, before what mirrors none.
TEST(BlockList, BlocksThatMirrorSolidsComeBeforeOthers) {
    const PixelRect rect{0, 0, 640, 368};
    FrameCover cover = cover_of(rect), mirrored(rect);
    mirrored.add(0, {{{0.3, -0.5, -1}, {0.9, -0.5, -1}, {0.6, 0.4, -1}}, 0}, 1, frame_of(rect));
    cover.add_all(2);
    constexpr uint32_t sheet = 1u << ShadowPlan::first_cluster;
    for (const BlockPlan& plan : plans) {
        const BlockShape shape = plan.shape();
        const BlockList list(cover, mirrored, by_tiles(LightImages(rect)), {1u, 2u, sheet},
                             {0, 1, rect.height / strip_rows}, plan);
        const auto is_mirror = [&](const BlockPlace& block) {
            for (int y = block.row * shape.height; y < (block.row + 1) * shape.height && y < rect.height; ++y)
                for (const PixelRun& run : mirrored.runs(y))
                    if (run.begin < (block.column + 1) * shape.width && run.end > block.column * shape.width)
                        return true;
            return false;
        };
        size_t last = 0, count[3] = {};
        for (const BlockPlace& block : list.places()) {
            const size_t place = block.in_view != sheet ? 0 : is_mirror(block) ? 1 : 2;
            EXPECT_GE(place, last);
            last = place;
            ++count[place];
        }
        for (const size_t some : count) EXPECT_GT(some, list.places().size() / 20);
    }
}

TEST(BlockList, BlocksKnowWhatMayShow) {
    const PixelRect rect{0, 0, 640, 368};
    const FrameCover cover = cover_of(rect);
    for (const BlockPlan& plan : plans) {
        const BlockList list(cover, FrameCover(rect), by_tiles(LightImages(rect)), {4u},
                             {0, 1, rect.height / strip_rows}, plan);
        size_t known = 0;
        for (const BlockPlace& block : list.places()) {
            EXPECT_TRUE(block.in_view == 4u || block.in_view == ~0u) << block.in_view;  // hull 1 has no number
            known += block.in_view == 4u;
        }
        EXPECT_GT(known, list.places().size() / 2);
        EXPECT_LT(known, list.places().size());
    }
}

/// Images of lights, three of them in mirrors, one of which shows any.
LightImages lights_in(const PixelRect& rect) {
    LightImages lights(rect);
    lights.know_mirrors();
    lights.add({{160, 80, 9, 7}, MirrorNumbers::straight, 5});
    lights.add({{100, 100, 40, 30}, MirrorNumbers::straight, 700});
    lights.add({{130, 90, 60, 9}, 3, 5});
    lights.add({{170, 70, 3, 40}, MirrorNumbers::most - 1, 0});
    lights.add({{150, 60, 30, 30}, 2});
    return lights;
}

/// What is known of part `tile` of a block.
ShownLights shown_in(const BlockList& list, size_t block, int tile) {
    const uint32_t cell = list.tiles().at(block * size_t(list.shape().tiles()) + size_t(tile));
    return {&list.cells().at(cell), list.shown().data()};
}

TEST(BlockList, BlocksKnowWhereLightsMayShow) {
    const PixelRect rect{7, 5, 333, 171};
    const FrameCover cover = cover_of(rect);
    const LightImages lights = lights_in(rect);
    const int strips = (rect.height + strip_rows - 1) / strip_rows;
    for (const BlockPlan& plan : plans)
        for (const int step : {1, 3}) {
            size_t lit = 0, dark = 0, listed = 0;
            for (int first = 0; first < step; ++first) {
                const BlockList list(cover, FrameCover(rect), by_tiles(lights), {1u, 8u},
                                     {first, step, (strips + step - 1) / step}, plan);
                const BlockShape shape = list.shape();
                ASSERT_EQ(list.tiles().size(), list.places().size() * size_t(shape.tiles()));
                EXPECT_LE(list.cells().size(), list.tiles().size() + 1);
                for (size_t b = 0; b < list.places().size(); ++b) {
                    const BlockPlace& block = list.places()[b];
                    for (int i = 0; i < shape.pixels(); ++i) {
                        const PixelPlace place = plan.place_of(i);
                        const int tile = shape.tile_of(place.column, place.row);
                        ASSERT_LT(tile, shape.tiles());
                        const int left = block.column * shape.width + place.column / tile_width * tile_width;
                        const int top = block.row * shape.height + place.row / tile_height * tile_height;
                        const auto meets = [&](const LightImage& image) {
                            return left < image.rect.x + image.rect.width && left + tile_width > image.rect.x &&
                                   top < image.rect.y + image.rect.height && top + tile_height > image.rect.y;
                        };
                        const ShownLights shown = shown_in(list, b, tile);
                        for (uint32_t mirror = 0; mirror <= MirrorNumbers::straight; ++mirror) {
                            std::vector<uint32_t> expected;
                            bool is_lit = false;
                            for (const LightImage& image : lights.images())
                                if (image.mirror == mirror && meets(image)) {
                                    is_lit = true;
                                    if (image.light != LightImage::any) expected.push_back(image.light);
                                }
                            EXPECT_EQ(shown.cell->is_dark(mirror), !is_lit);
                            EXPECT_EQ(test::listed_in(shown, mirror), expected);
                            listed += expected.size();
                            ++(is_lit ? lit : dark);
                        }
                    }
                }
            }
            EXPECT_GT(lit, 200u);
            EXPECT_GT(dark, lit);
            EXPECT_GT(listed, lit / 2);
        }
}

TEST(BlockList, TilesHaveRoomForSoManyLights) {
    const PixelRect rect{0, 0, 640, 368};
    LightImages lights(rect);
    for (uint32_t light = 0; light < 3 * BlockList::listed_per_tile; ++light)
        lights.add({rect, MirrorNumbers::straight, light});
    const BlockList list(cover_of(rect), FrameCover(rect), by_tiles(lights), {1u, 8u}, {0, 1, rect.height / strip_rows},
                         BlockPlan());
    EXPECT_LE(list.shown().size(), BlockList::listed_per_tile * list.tiles().size());
    size_t listed = 0, others = 0;
    for (size_t b = 0; b < list.places().size(); ++b) {
        const ShownLights shown = shown_in(list, b, 0);
        EXPECT_FALSE(shown.cell->is_dark(MirrorNumbers::straight));
        ++(shown.cell->count != 0 ? listed : others);  // lights are looked for everywhere
    }
    EXPECT_GT(listed, others / 3);
    EXPECT_GT(others, listed);
}

TEST(BlockList, NothingIsKnownOfMirrorsThatNobodyAsks) {
    const PixelRect rect{0, 0, 64, 32};
    const BlockList list(cover_of(rect), FrameCover(rect), by_tiles(LightImages(rect)), {1u, 8u}, {0, 1, 4},
                         BlockPlan());
    EXPECT_TRUE(list.tiles().empty());
    ASSERT_EQ(list.cells().size(), 1u);
    const ShownLights shown{list.cells().data(), nullptr};
    EXPECT_TRUE(shown.cell->is_dark(MirrorNumbers::straight));
    for (uint32_t mirror = 0; mirror < MirrorNumbers::most; ++mirror) EXPECT_FALSE(shown.cell->is_dark(mirror));
    EXPECT_FALSE(shown.cell->is_dark(MirrorNumbers::none));
}

}  // namespace
