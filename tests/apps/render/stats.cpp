// What --stats writes of a run, and what is said of what the depth took.
#include "sequence/stats.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/common/command_line.h"
#include "render/record/film_difference.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

TEST(Stats, NameTheGpusWhereOnesRan) {
    RunStats stats;
    const ScratchDirectory scratch;
    const auto context = [&] {
        StatsFile(scratch.file("s.json"), {}, !stats.devices.empty()).finish(stats);
        return nlohmann::json::parse(bytes_of(scratch.file("s.json"))).at("context");
    };
    EXPECT_EQ(context().at("backend"), "embree");
    EXPECT_FALSE(context().contains("devices") || context().contains("driver"));
    stats.backend = Backend::cuda;
    stats.devices = {"New", "Newer"};
    stats.driver = "13.0";
    EXPECT_EQ(context().at("backend"), "cuda");
    EXPECT_EQ(context().at("devices"), nlohmann::json({"New", "Newer"}));
    EXPECT_EQ(context().at("driver"), "13.0");
}

TEST(Stats, LedgerTotalsAreInTheScenesUnits) {
    Film film;
    film.samples = 4;
    film.fixed_shift = 60;
    film.radiance_exponent = 1;
    film.pixels.assign(2);
    film.pixels.change(0, [](PixelRecord& pixel) { pixel.pruned[1] = int64_t{1} << 60; });
    film.pixels.change(1, [](PixelRecord& pixel) {
        pixel.pruned[1] = int64_t{1} << 62;
        pixel.cut[2] = int64_t{1} << 59;
        pixel.samples = 4;
        pixel.rays = 1 << 30;
    });
    film.totals = totals_of(film);
    const LedgerTotals pruned = ledger_totals(film, film.totals.pruned), cut = ledger_totals(film, film.totals.cut);
    EXPECT_EQ(pruned.mean, (std::array<double, 3>{0, 1.25, 0}));
    EXPECT_EQ(pruned.worst, (std::array<double, 3>{0, 2, 0}));
    EXPECT_EQ(cut.mean, (std::array<double, 3>{0, 0, 0.125}));
    EXPECT_EQ(cut.worst, (std::array<double, 3>{0, 0, 0.25}));
    EXPECT_EQ(unit_totals(film).worst, (std::array<double, 3>{0x1p-31, 0x1p-31, 0x1p-31}));
    EXPECT_EQ(unit_totals(film).mean, (std::array<double, 3>{0x1p-32, 0x1p-32, 0x1p-32}));
}

TEST(Stats, OfWhatTheDepthTookTheWorstFrameIsSaidOnce) {
    SequenceTotals totals;
    FrameStats frame;
    frame.file = "a.exr";
    frame.depth_loss = {0.0078125, 0.5, 0.5};  // just under what is seen
    totals.add(frame);
    EXPECT_EQ(describe_depth_loss(totals, "a.#.exr", 4), "");
    frame.frame = 7;
    frame.depth_loss = {0.15, 1.0, 0.5};
    totals.add(frame);
    frame.frame = 8;
    frame.depth_loss = {0.01, 0.1, 0.5};
    totals.add(frame);
    EXPECT_EQ(with_options(describe_depth_loss(totals, "a.#.exr", 4)),
              "a.#.exr: in 2 of 3 frames, most in frame 7: depth 4 may have taken up to 1 from a pixel and 0.15 in the "
              "mean, where the picture's mean is 0.5: see --depth and --layers error");
    SequenceTotals black;
    frame.depth_loss = {0.01, 0.1, 0};
    black.add(frame);
    EXPECT_NE(describe_depth_loss(black, "a.exr", 4), "");
}

}  // namespace
}  // namespace cistula
