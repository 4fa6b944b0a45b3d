// A sequence's loop over a renderer that costs nothing: what it is told, what is said, what is left when it ends early.
#include "sequence/sequence_loop.h"

#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <thread>

#include "apps/common/sequence_progress.h"
#include "image/exr/exr.h"
#include "scene/readers/read_scene.h"
#include "sequence/render_sequence.h"
#include "testing/support/render_program.h"

namespace cistula {
namespace {

/// Black frames. Writes down what it is asked for: "+1" is an announcement, "0" a frame.
class FakeRenderer : public Renderer {
  public:
    bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                RenderProgress& progress) override {
        asked += " " + std::to_string(camera.frame);
        sizes.push_back(film.pixels.size());
        film.rect = settings.crop;
        film.full_width = settings.full_width;
        film.full_height = settings.full_height;
        film.pixels.assign(static_cast<size_t>(film.rect.width) * static_cast<size_t>(film.rect.height));
        if (camera.frame == stop_at) progress.stop = true;
        return !progress.stop;
    }
    void expect(const CameraFrame& camera, const FrameSettings&) override {
        asked += " +" + std::to_string(camera.frame);
    }
    uint32_t effects() const override { return 0; }
    std::string intersector() const override { return "fake"; }
    RenderTimes times() const override { return {0.25, 0.5}; }
    std::vector<std::string> notes() const override { return {"memory is short"}; }
    size_t memory() const override { return 0; }

    size_t frames_ahead() const override { return ahead; }

    size_t ahead = 1;
    std::string asked;
    std::vector<size_t> sizes;  // of the films as they came
    int stop_at = -1;
};

/// Says what `render` says, and keeps what is told of written frames.
class Report : public SequenceProgress {
  public:
    Report(Talk talk, const RenderProgress& progress, std::vector<FrameStats>& frames)
        : SequenceProgress(ProgressStyle::none, talk, progress), frames_(frames) {}
    void written(const FrameStats& frame) override {
        frames_.push_back(frame);
        SequenceProgress::written(frame);
    }

  private:
    std::vector<FrameStats>& frames_;
};

class SequenceLoop : public RenderProgram {
  protected:
    SequenceLoop() : scene_(read_scene(file("s.json"))) {
        settings_.full_width = settings_.crop.width = 40;
        settings_.full_height = settings_.crop.height = 24;
    }

    /// What it prints.
    std::string film(const std::vector<int>& frames, Backend backend) {
        options_.backend = backend;
        const OutputName output(file("f.##.exr"), "-o"), none;
        RenderProgress progress;
        Report report(talk_, progress, written_);
        SequenceJob job{options_, scene_, FrameHashes("hash"), settings_, output, none, frames, report};
        job.look_ahead = [this](const std::vector<int>& stretch) {
            stretches_.push_back(stretch);
            return warning_;
        };
        stats_ = RunStats();
        written_.clear();
        testing::internal::CaptureStderr();
        try {
            render_frames(job, renderer_, progress, stats_);
        } catch (...) {
            testing::internal::GetCapturedStderr();
            throw;
        }
        return testing::internal::GetCapturedStderr();
    }

    void expect_failure(const std::vector<int>& frames, Backend backend, ExitCode code, const std::string& part) {
        try {
            film(frames, backend);
            ADD_FAILURE() << "no error";
        } catch (const Error& error) {
            EXPECT_EQ(exit_code(error.kind()), code);
            EXPECT_NE(with_options(error.what()).find(part), std::string::npos) << error.what();
        }
    }

    const SceneDescription scene_;
    RenderRequest options_;
    Talk talk_ = Talk::some;
    FrameSettings settings_;
    FakeRenderer renderer_;
    RunStats stats_;
    std::vector<FrameStats> written_;
    std::vector<std::vector<int>> stretches_;  // that were looked at ahead
    std::string warning_;                      // that comes of it
};

TEST_F(SequenceLoop, AnnouncesTheNextFramesBeforeItAsksForOne) {
    film({0, 5, 2}, Backend::cuda);
    EXPECT_EQ(renderer_.asked, " +5 0 +2 5 2");
    renderer_.asked.clear();
    renderer_.ahead = 3;
    film({0, 5, 2, 3, 4, 1}, Backend::cuda);
    EXPECT_EQ(renderer_.asked, " +5 +2 +3 0 +4 5 +1 2 3 4 1");
    renderer_.asked.clear();
    renderer_.ahead = 1;
    options_.resume = true;
    for (const char* removed : {"f.00.exr", "f.03.exr"}) std::filesystem::remove(file(removed));
    film({0, 5, 2, 3}, Backend::cuda);
    EXPECT_EQ(renderer_.asked, " +3 0 3");
    EXPECT_EQ(stats_.resumed, (std::vector<int>{5, 2}));
}

TEST_F(SequenceLoop, SaysEachNoteOnceAndNothingWhereQuiet) {
    EXPECT_EQ(film({0, 1, 2}, Backend::cuda), "render: memory is short\n");
    talk_ = Talk::errors;
    EXPECT_EQ(film({0, 1, 2}, Backend::cuda), "");
}

TEST_F(SequenceLoop, FramesArePassedOnInTheOrderOfTheFilmWithTheDevicesTimes) {
    std::vector<int> frames;
    for (int i = 0; i < 20; ++i) frames.push_back(i * 7 % 20);
    film(frames, Backend::cuda);
    ASSERT_EQ(written_.size(), frames.size());
    for (size_t i = 0; i < frames.size(); ++i) {
        EXPECT_EQ(written_[i].frame, frames[i]);
        EXPECT_EQ(written_[i].device.kernel, 0.25);
        EXPECT_EQ(written_[i].device.transfer, 0.5);
    }
    EXPECT_EQ(stats_.totals.frames, 20u);
    EXPECT_EQ(stats_.totals.pixels, 20u * 40 * 24);
    EXPECT_EQ(stats_.totals.first_file, file("f.00.exr"));
    const auto text = [&](bool has_device) {
        StatsFile stats(file("stats.json"), settings_, has_device);
        for (const FrameStats& frame : written_) stats.add(frame);
        stats.finish(stats_);
        return bytes_of(file("stats.json"));
    };
    EXPECT_EQ(nlohmann::json::parse(text(false)).at("benchmarks").size(), 20u);
    EXPECT_EQ(text(false).find("kernel_ms"), std::string::npos);
    EXPECT_EQ(text(false).find("transfer_ms"), std::string::npos);
    EXPECT_NE(text(true).find("\"kernel_ms\": 250.0"), std::string::npos);
    EXPECT_NE(text(true).find("\"transfer_ms\": 500.0"), std::string::npos);
}

TEST_F(SequenceLoop, AMillionFramesBeginAtOnceAndAreLookedAtInStretches) {
    renderer_.stop_at = 2003;
    expect_failure(parse_frames("0-999999"), Backend::embree, ExitCode::interrupted,
                   "interrupted; 2003 of 1000000 frames written; ");
    ASSERT_EQ(stretches_.size(), 2u);
    EXPECT_EQ(stretches_[0].size(), 1001u);
    EXPECT_EQ(stretches_[0].front(), 999);
    EXPECT_EQ(stretches_[1].front(), 1999);
    EXPECT_EQ(stretches_[1].back(), 2999);
    EXPECT_EQ(written_.size(), 2003u);
    options_.resume = true;
    renderer_.stop_at = 2005;
    expect_failure(parse_frames("0-999999"), Backend::embree, ExitCode::interrupted,
                   "interrupted; 2005 of 1000000 frames written; ");
    EXPECT_EQ(stats_.resumed, parse_frames("0-2002"));
}

TEST_F(SequenceLoop, WarningsOfWhatIsAheadAreSaidOnce) {
    warning_ = "the camera turns";
    EXPECT_EQ(film(parse_frames("0-99999x99"), Backend::embree),
              "render: memory is short\nrender: warning: the camera turns\n");
    talk_ = Talk::errors;
    EXPECT_EQ(film(parse_frames("0-99999x99"), Backend::embree), "");
}

TEST_F(SequenceLoop, OnTheCpuAFilmIsWrittenBeforeTheNextIsHandedOver) {
    film({0, 1, 2, 3, 4}, Backend::embree);
    EXPECT_EQ(renderer_.sizes.size(), 5u);
    for (size_t i = 2; i < renderer_.sizes.size(); ++i)
        EXPECT_EQ(renderer_.sizes[i], 40u * 24u) << "frame " << i << " is a third film";
}

TEST_F(SequenceLoop, TheThreadsOfTheArenaCompress) {
    Imf::setGlobalThreadCount(3);  // the process's, not ours
    for (const int threads : {1, 2, 9}) {
        tbb::task_arena(threads).execute([&] {
            film({0, 1, 2}, Backend::cuda);
            EXPECT_EQ(Imf::globalThreadCount(), 3);
            EXPECT_EQ(writer_limits(options_.backend, 3).frames, threads == 9 ? 4 : 2);
            EXPECT_EQ(writer_limits(options_.backend, 3).exr_threads_of_a_frame, std::min(threads, 4));
            EXPECT_EQ(writer_limits(options_.backend, 1).exr_threads_of_a_frame, threads) << "no other frame waits";
            film({0, 1, 2}, Backend::embree);
            EXPECT_EQ(Imf::globalThreadCount(), 3);
            EXPECT_EQ(writer_limits(options_.backend, 3).frames, 1);
            EXPECT_EQ(writer_limits(options_.backend, 3).exr_threads_of_a_frame, threads);
        });
    }
    Imf::setGlobalThreadCount(0);
}

TEST_F(SequenceLoop, WhatWasRenderedBeforeAnInterruptionIsWhole) {
    renderer_.stop_at = 7;
    std::vector<int> frames;
    for (int i = 0; i < 12; ++i) frames.push_back(i);
    for (const Backend backend : {Backend::embree, Backend::cuda}) {
        expect_failure(frames, backend, ExitCode::interrupted, "interrupted; 7 of 12 frames written; ");
        EXPECT_EQ(written_.size(), 7u);
        for (const int frame : frames) {
            const std::string name = file(fmt::format("f.{:02}.exr", frame));
            EXPECT_EQ(exr_is_complete(name), frame < 7) << name;
            std::filesystem::remove(name);
        }
        EXPECT_FALSE(has_part_files());
    }
}

TEST_F(SequenceLoop, AFailedWriteEndsTheFilm) {
    std::vector<int> frames;
    for (int i = 0; i < 1000; ++i) frames.push_back(i);
    std::filesystem::create_directory(file("f.03.exr"));
    for (const Backend backend : {Backend::embree, Backend::cuda}) {
        expect_failure(frames, backend, ExitCode::file, "f.03.exr");
        EXPECT_FALSE(exists("f.999.exr"));
        for (const FrameStats& stats : written_) EXPECT_TRUE(exr_is_complete(stats.file)) << stats.file;
        ASSERT_GE(written_.size(), 3u);
        EXPECT_EQ(written_[2].frame, 2);
    }
}

/// Counts what is told.
struct Heard : SequenceEvents {
    void planned(const FrameSettings&) override { told += "planned "; }
    void ready(const RunStats&) override { told += "ready "; }
    void begin(size_t frames) override { told += fmt::format("begin {} ", frames); }
    void written(const FrameStats&) override { told += "written "; }
    void end(const RunStats&, size_t done, size_t) override { told += fmt::format("end {}", done); }
    std::string told;
};

TEST_F(SequenceLoop, SeveralRequestsAtOnceAreAsEachAlone) {
    const auto render = [&](const std::string& name, Heard& heard) {
        RenderRequest request;
        request.scene = file("s.json");
        request.output = file(name + ".#.exr");
        request.preview = file(name + ".#.png");
        request.threads = 2;
        RenderProgress progress;
        return render_sequence(request, heard, progress);
    };
    Heard alone, first, second;
    EXPECT_EQ(render("alone", alone).totals.frames, 3u);
    EXPECT_EQ(alone.told, "planned ready begin 3 written written written end 3");
    std::thread other([&] { render("first", first); });
    render("second", second);
    other.join();
    for (const Heard* heard : {&first, &second}) EXPECT_EQ(heard->told, alone.told);
    for (const char* kind : {"0.exr", "2.exr", "1.png"})
        for (const char* name : {"first", "second"})
            EXPECT_EQ(bytes_of(file(std::string(name) + "." + kind)), bytes_of(file(std::string("alone.") + kind)));
}

}  // namespace
}  // namespace cistula
