#include "bench/gpu/film_times.h"

#include <fmt/format.h>

#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "apps/common/film_loop.h"
#include "apps/common/frame_writer.h"
#include "apps/common/timing.h"
#include "backend_cuda/host/cuda_renderer.h"
#include "scene/readers/read_scene.h"

namespace cistula::bench {
namespace {

constexpr int warm_up = 3, rounds = 3;

class TemporaryDirectory {
  public:
    TemporaryDirectory() : path_((std::filesystem::temp_directory_path() / "cistula_film_XXXXXX").string()) {
        if (!mkdtemp(path_.data())) throw std::runtime_error("cannot make " + path_);
    }
    ~TemporaryDirectory() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryDirectory(const TemporaryDirectory&) = delete;
    TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

    void clear() const {
        for (const auto& entry : std::filesystem::directory_iterator(path_)) std::filesystem::remove(entry.path());
    }
    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

class FilmTimer {
  public:
    FilmTimer(const std::string& scene, int frames)
        : scene_(read_scene(scene)), output_(directory_.path() + "/f.####.exr", "-o") {
        const std::shared_ptr<const CompiledScene<float>> compiled = compile_scene<float>(scene_);
        hash_ = compiled->hash;
        renderer_ = make_cuda_renderer<float>(compiled, {});
        for (int frame = 0; frame < frames; ++frame) frames_.push_back(frame);
        settings_.full_width = settings_.crop.width = 1280;
        settings_.full_height = settings_.crop.height = 720;
        settings_.supersample = 3;
        settings_.depth = 4;
        options_.backend = Backend::cuda;
        options_.quiet = true;
        Film film;
        for (int i = 0; i < warm_up; ++i) render(0, film);
    }

    /// The sum over the frames, in milliseconds; nothing is written.
    double kernels() {
        Film film;
        double sum = 0;
        for (const int frame : frames_) {
            render(frame, film);
            sum += renderer_->times().kernel * 1e3;
        }
        return sum;
    }

    /// The time of writing the frames, rendered beforehand, in milliseconds; frames in work and threads as for the
    /// whole film.
    double writers() {
        std::vector<FinishedFrame> finished(frames_.size());
        for (size_t i = 0; i < frames_.size(); ++i) {
            render(frames_[i], finished[i].film);
            finished[i].path = output_.for_frame(frames_[i]);
            finished[i].attributes =
                header_attributes(hash_, settings_, options_.precision, camera_at(scene_.camera, frames_[i]));
        }
        directory_.clear();
        std::atomic<bool> stop{false};
        std::vector<FrameStats> written;
        FrameWriter writer(options_.channels, false, writer_limits(options_), stop, written);
        std::vector<Film> kept;  // freeing them is no part of a film's work
        return 1e3 * seconds_of([&] {
                   for (FinishedFrame& frame : finished) {
                       writer.put(std::move(frame));
                       kept.push_back(writer.take_spare());
                   }
                   writer.finish();
               });
    }

    double whole_film(RunStats& stats) {
        directory_.clear();
        const OutputName no_preview;
        const FilmJob job{options_, scene_, hash_, settings_, output_, no_preview, frames_};
        RenderProgress progress;
        return 1e3 * seconds_of([&] { render_film(job, *renderer_, progress, stats); });
    }

    WriterLimits limits() const { return writer_limits(options_); }

  private:
    void render(int frame, Film& film) {
        RenderProgress progress;
        renderer_->render(camera_at(scene_.camera, frame), settings_, film, progress);
    }

    const SceneDescription scene_;
    const TemporaryDirectory directory_;
    const OutputName output_;
    std::string hash_;
    std::unique_ptr<Renderer> renderer_;
    std::vector<int> frames_;
    FrameSettings settings_;
    FilmOptions options_;
};

/// The median over a film's frames, in milliseconds.
template <class Of>
double median_frame(const RunStats& stats, Of of) {
    std::vector<double> values;
    for (const FrameStats& frame : stats.frames) values.push_back(of(frame) * 1e3);
    return median_of(values);
}

}  // namespace

void time_film(GpuRecord& record, const std::string& folder, int frames) {
    FilmTimer timer(folder + "/scenes/benchmark.json", frames);
    std::vector<double> kernels, writers, whole;
    RunStats stats;
    for (int round = 0; round < rounds; ++round) {
        kernels.push_back(timer.kernels());
        writers.push_back(timer.writers());
        stats = RunStats();
        whole.push_back(timer.whole_film(stats));
    }
    const std::string name = fmt::format("film/benchmark.json/1280x720/3x3/depth:4/frames:{}/", frames);
    const int threads = timer.limits().frames, exr_threads = timer.limits().exr_threads;
    record.add_times(name + "kernels", kernels);
    record.add_times(name + "writers", writers, {{"threads", threads}, {"exr_threads", exr_threads}});
    record.add_times(name + "film", whole,
                     {{"overlap", std::max(median_of(kernels), median_of(writers)) / median_of(whole)},
                      {"threads", threads},
                      {"exr_threads", exr_threads},
                      {"frame_render_ms", median_frame(stats, [](const FrameStats& f) { return f.render_seconds; })},
                      {"frame_kernel_ms", median_frame(stats, [](const FrameStats& f) { return f.device.kernel; })},
                      {"frame_transfer_ms", median_frame(stats, [](const FrameStats& f) { return f.device.transfer; })},
                      {"frame_encode_ms", median_frame(stats, [](const FrameStats& f) { return f.encode_seconds; })},
                      {"frame_write_ms", median_frame(stats, [](const FrameStats& f) { return f.write_seconds; })}});
}

}  // namespace cistula::bench
