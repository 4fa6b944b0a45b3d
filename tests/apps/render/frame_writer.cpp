// Several frames on their way to files at once: bounded, in order where it shows, ended by the first failure.
#include "sequence/frame_writer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <random>
#include <thread>

#include "base/error.h"
#include "cistula/numerics/fixed_sum.h"
#include "image/exr/exr.h"
#include "testing/support/scene_samples.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

constexpr int small = 8, big = 800;  // pixels of a side: written in no time, in long enough to look meanwhile

Film noise(int side, uint64_t seed) {
    Film film;
    film.full_width = film.full_height = side;
    film.rect = {0, 0, side, side};
    film.samples = 9;
    film.fixed_shift = fixed_shift(9);
    film.pixels.begin(static_cast<size_t>(side) * static_cast<size_t>(side), {false, false});
    std::mt19937_64 random(seed);
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        PixelRecord pixel = {};
        for (int64_t& sum : pixel.radiance) sum = static_cast<int64_t>(random() >> 2);
        pixel.hits = 9;
        film.pixels.set(i, pixel);
    }
    return film;
}

class Writers : public testing::Test {
  protected:
    FinishedFrame frame(int number, int side, const std::string& name = "") const {
        FinishedFrame finished;
        finished.film = noise(side, static_cast<uint64_t>(number));
        finished.image = OutputName(path(name.empty() ? std::to_string(number) + ".exr" : name), "-o");
        finished.stats.frame = number;
        finished.stats.file = finished.image.for_frame(number);
        return finished;
    }
    std::string path(const std::string& name) const { return folder_.file(name); }
    bool exists(int number) const { return std::filesystem::exists(path(std::to_string(number) + ".exr")); }

    void expect_whole(int number, int side) const {
        write_exr(path("expected.exr"), to_layers(noise(side, static_cast<uint64_t>(number)), {}));
        EXPECT_EQ(bytes_of(path(std::to_string(number) + ".exr")), bytes_of(path("expected.exr"))) << number;
    }
    std::vector<int> numbers() const {
        std::vector<int> all;
        for (const FrameStats& stats : written_) all.push_back(stats.frame);
        return all;
    }

    const ScratchDirectory folder_;
    std::atomic<bool> stop_{false};
    std::vector<FrameStats> written_;
    const FrameSink sink_ = [this](const FrameStats& frame) { written_.push_back(frame); };
};

TEST_F(Writers, FilesAreWholeAndStatsInOrderWhateverIsDoneFirst) {
    const auto side = [](int number) { return number % 3 == 0 ? 400 : small; };
    {
        FrameWriter writer({}, true, {4}, stop_, sink_);
        for (int number = 0; number < 10; ++number) writer.put(frame(number, side(number)));
        writer.finish();
        EXPECT_EQ(numbers(), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
        for (int number = 10; number < 12; ++number) writer.put(frame(number, small));
    }  // the destructor waits as well
    EXPECT_EQ(numbers(), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
    for (int number = 0; number < 12; ++number) expect_whole(number, number < 10 ? side(number) : small);
    for (const FrameStats& stats : written_)
        EXPECT_EQ(stats.hash,
                  film_hash(noise(stats.frame < 10 ? side(stats.frame) : small, static_cast<uint64_t>(stats.frame))));
    EXPECT_FALSE(stop_);
}

TEST_F(Writers, WhatTheReceiverOfFramesThrowsIsAFailedWrite) {
    const FrameSink full = [this](const FrameStats& frame) {
        if (frame.frame == 2) throw Error(ErrorKind::file, "the disk is full");
        written_.push_back(frame);
    };
    FrameWriter writer({}, false, {2}, stop_, full);
    for (int number = 0; number < 3; ++number) writer.put(frame(number, small));
    samples::expect_error([&] { writer.finish(); }, ExitCode::file, "the disk is full");
    EXPECT_TRUE(stop_);
    EXPECT_EQ(numbers(), (std::vector<int>{0, 1}));
}

TEST_F(Writers, AFrameOvertakesALongerOne) {
    FrameWriter writer({}, false, {2}, stop_, sink_);
    writer.put(frame(0, big));
    writer.put(frame(1, small));
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!exists(1) && std::chrono::steady_clock::now() < deadline)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_FALSE(exists(0));
    writer.finish();
    EXPECT_EQ(numbers(), (std::vector<int>{0, 1}));
    EXPECT_EQ(written_[0].hash, "");  // nobody asked
}

TEST_F(Writers, FramesInWorkAreBoundedByTheirNumber) {
    FrameWriter writer({}, false, {2}, stop_, sink_);
    for (int number = 0; number < 3; ++number) writer.put(frame(number, big));
    EXPECT_TRUE(exists(0) || exists(1));
}

TEST_F(Writers, FramesInWorkAreBoundedByTheirBytes) {
    FrameWriter writer({}, false, {8, 1000}, stop_, sink_);
    writer.put(frame(0, big));
    EXPECT_FALSE(exists(0)) << "one at least, however large";
    writer.put(frame(1, big));
    EXPECT_TRUE(exists(0));
}

TEST_F(Writers, TheFirstFailureEndsAllAndIsTheOneReported) {
    std::filesystem::create_directory(path("a.exr"));
    std::filesystem::create_directory(path("b.exr"));
    const auto failure_of = [](const auto& work) -> std::string {
        try {
            work();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::file);
            return with_options(error.what());
        }
        return "nothing";
    };
    {
        FrameWriter writer({}, false, {4}, stop_, sink_);
        writer.put(frame(0, big));
        FinishedFrame slow = frame(1, big, "a.exr");
        slow.preview = path("a.png");  // is written first, and takes its time
        writer.put(std::move(slow));
        writer.put(frame(2, small, "b.exr"));  // fails long before the one before it
        const std::string first = failure_of([&] { writer.finish(); });
        EXPECT_NE(first.find("b.exr"), std::string::npos) << first;
        EXPECT_TRUE(stop_);
        EXPECT_EQ(failure_of([&] { writer.put(frame(3, small)); }), first);
        EXPECT_EQ(failure_of([&] { writer.finish(); }), first);
    }
    EXPECT_EQ(numbers(), (std::vector<int>{0}));
    expect_whole(0, big);
    EXPECT_FALSE(exists(3));
    for (const std::string& name : folder_.names()) EXPECT_EQ(name.find(".part"), name.npos) << name;
}

TEST_F(Writers, WhatHalfDoesNotHoldIsCountedOrFails) {
    OutputChannels half;
    half.half = true;
    const auto bright = [&](int number) {
        FinishedFrame one = frame(number, small);
        one.film.radiance_exponent = 40;
        one.film.pixels.change(0, [](PixelRecord& pixel) { pixel.radiance[1] = 0; });
        return one;
    };
    FrameWriter writer(half, false, {1}, stop_, sink_);
    writer.put(frame(0, small));
    writer.put(bright(1));
    writer.finish();
    EXPECT_EQ(written_[0].clamped, 0u);
    EXPECT_EQ(written_[1].clamped, 3u * small * small - 1);
    FinishedFrame strict = frame(2, small);
    strict.strict = true;
    writer.put(std::move(strict));
    writer.finish();
    EXPECT_TRUE(exists(2));
    strict = bright(3);
    strict.strict = true;
    writer.put(std::move(strict));
    samples::expect_error([&] { writer.finish(); }, ExitCode::failed,
                          "3.exr: not written: 191 values are over 65504, the largest half; --bits float holds them");
    EXPECT_FALSE(exists(3));
}

TEST_F(Writers, FilmsComeBackForTheirMemory) {
    FrameWriter writer({}, false, {2}, stop_, sink_);
    EXPECT_EQ(writer.take_spare().pixels.capacity(), 0u);
    FinishedFrame one = frame(0, 100);
    const PixelRadiance* place = one.film.pixels.planes().radiance;
    writer.put(std::move(one));
    writer.finish();
    EXPECT_EQ(writer.take_spare().pixels.planes().radiance, place);
    EXPECT_EQ(writer.take_spare().pixels.capacity(), 0u);

    FrameWriter narrow({}, false, {2, 1000}, stop_, sink_);
    narrow.put(frame(1, 100));
    narrow.finish();
    EXPECT_EQ(narrow.take_spare().pixels.capacity(), 0u) << "more than may be kept";
}

}  // namespace
}  // namespace cistula
