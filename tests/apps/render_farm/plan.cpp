// How a film is cut into tasks, and the words of its scripts.
#include "apps/render_farm/plan.h"

#include <gtest/gtest.h>

#include <numeric>

#include "apps/render_farm/job_files.h"
#include "apps/render_farm/measure.h"
#include "apps/render_farm/options.h"
#include "base/error.h"

namespace cistula {
namespace {

/// Every frame of every tile is in one task.
void expect_whole(const std::vector<FarmTask>& tasks, const std::vector<int>& frames, size_t tiles) {
    std::vector<std::vector<int>> found(tiles);
    for (const FarmTask& task : tasks)
        for (const int frame : task.frames) found[static_cast<size_t>(task.tile)].push_back(frame);
    for (const std::vector<int>& of : found) EXPECT_EQ(of, frames);
}

TEST(FarmPlan, TasksTakeAboutEquallyLong) {
    const std::vector<int> frames = parse_frames("0-99,200-299x9,7000");
    const MeasuredFrames measured{{0, frames.size() - 1}, {{1, 10, 100}, {1, 30, 100}}};
    const std::vector<FarmTask> tasks = plan_tasks(frames, 3, measured, 50, 1000);
    expect_whole(tasks, frames, 3);
    for (const FarmTask& task : tasks) {
        EXPECT_TRUE(task.seconds <= 50 || task.frames.size() == 1);
        EXPECT_TRUE(task.tile != 2 || task.frames.size() == 1);
    }
    const std::vector<FarmTask> fewer = plan_tasks(frames, 3, measured, 50, 20);
    EXPECT_LE(fewer.size(), 20u);
    expect_whole(fewer, frames, 3);
    expect_whole(plan_tasks(frames, 3, measured, 1e9, 3), frames, 3);
    EXPECT_EQ(plan_tasks(frames, 3, measured, 1e9, 3).size(), 3u);
    EXPECT_THROW(plan_tasks(frames, 3, measured, 50, 2), Error);
    expect_whole(plan_tasks({5}, 1, {{0}, {{0}}}, 50, 2), {5}, 1);
}

TEST(FarmPlan, CostsBetweenMeasuredFramesAreLinear) {
    const MeasuredFrames measured{{0, 4, 8}, {{0}, {8}, {0}}};
    for (size_t i = 0; i <= 8; ++i) EXPECT_EQ(measured.of(i, 0), i <= 4 ? 2.0 * double(i) : 16 - 2.0 * double(i)) << i;
    EXPECT_EQ(frames_to_measure(5, 64), (std::vector<size_t>{0, 1, 2, 3, 4}));
    EXPECT_EQ(frames_to_measure(101, 3), (std::vector<size_t>{0, 50, 100}));
    EXPECT_EQ(frames_to_measure(1, 64), std::vector<size_t>{0});
}

TEST(FarmPlan, RaysCountForTheTileTheyAreIn) {
    FrameSettings settings;
    settings.set_size(80, 40);
    settings.crop = {8, 8, 64, 32};
    const FrameSettings small = small_settings(settings);
    EXPECT_EQ(small.crop, (PixelRect{2, 2, 16, 8}));
    Film film;
    film.rect = small.crop;
    film.pixels.assign(16 * 8, PixelRecord());
    for (size_t i = 0; i < film.pixels.size(); ++i)
        film.pixels.change(i, [i](PixelRecord& pixel) { pixel.rays = i % 16 < 4 ? 10 : 1; });
    EXPECT_EQ(rays_of_tiles(film, settings, {4, 2}), (std::vector<double>{160, 16, 16, 16, 160, 16, 16, 16}));
    settings.set_size(1, 1);
    EXPECT_EQ(small_settings(settings).crop, (PixelRect{0, 0, 1, 1}));
}

TEST(FarmOptions, WhatRenderTakesIsPassedOn) {
    const char* const line[] = {"render-farm", "s.json",     "-o",       "f.#.exr", "-f",  "0-9",
                                "--bits",      "half",       "--strict", "--tiles", "4x3", "--preview",
                                "p.#.png",     "--exposure", "-1",       "--to",    "farm"};
    const FarmOptions options = parse_farm_options(static_cast<int>(std::size(line)), line);
    EXPECT_EQ(options.passed, (std::vector<std::string>{"--bits=half", "--strict"}));
    EXPECT_EQ(options.merged, (std::vector<std::string>{"--preview=p.#.png", "--exposure=-1"}));
    EXPECT_EQ(options.render.tiles, (TileGrid{4, 3}));
    EXPECT_EQ(options.folder, "farm");
    const auto refuse = [](std::vector<const char*> more) {
        more.insert(more.begin(), {"render-farm", "s.json"});
        EXPECT_THROW(parse_farm_options(static_cast<int>(more.size()), more.data()), Error) << more[2];
    };
    for (const char* option : {"--resume", "--list-devices", "--explain", "--print-template"}) refuse({option});
    refuse({"--tile", "1"});
    refuse({"--pixel", "1,1"});
    refuse({"--stats", "s"});
    refuse({"--progress", "json"});
    refuse({"--dept", "3"});
    refuse({"--tiles", "2x2", "--compression", "dwaa"});
    refuse({"--task-seconds", "0"});
    refuse({"--most-tasks", "x"});
    refuse({"--bloom", "1"});
}

TEST(FarmFiles, WordsOfTheShellAreWhole) {
    EXPECT_EQ(shell_word("a b"), "'a b'");
    EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
}

}  // namespace
}  // namespace cistula
