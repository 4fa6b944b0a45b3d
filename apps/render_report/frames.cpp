#include "frames.h"

#include <fmt/format.h>

#include <condition_variable>
#include <mutex>
#include <thread>

#include "base/error.h"
#include "base/timing.h"
#include "sequence/sequence_loop.h"

namespace cistula::report {
namespace {

/// Watches a render and stops `frame` when it exceeds a limit or when `shown`, the progress on display, is stopped.
class Watch {
  public:
    Watch(const FrameLimit& limit, RenderProgress& shown)
        : limit_(limit), shown_(shown), thread_([this] { watch(); }) {}
    ~Watch() { end(); }

    /// Ends the watch; returns whether a limit was exceeded.
    bool end() {
        {
            const std::lock_guard lock(mutex_);
            done_ = true;
        }
        wake_.notify_all();
        if (thread_.joinable()) thread_.join();
        return late_;
    }

    RenderProgress frame;

  private:
    void watch() {
        using Clock = std::chrono::steady_clock;
        const auto start = Clock::now();
        auto moved = start;
        std::unique_lock lock(mutex_);
        while (!wake_.wait_for(lock, std::chrono::milliseconds(10), [this] { return done_; })) {
            const auto now = Clock::now();
            const auto seconds_from = [&](auto then) { return std::chrono::duration<double>(now - then).count(); };
            const uint64_t done = frame.pixels_done;
            if (shown_.pixels_done.exchange(done) != done) moved = now;
            late_ = late_ || seconds_from(start) > limit_.whole || seconds_from(moved) > limit_.still;
            if (late_ || shown_.stop) frame.stop = true;
        }
    }

    const FrameLimit limit_;
    RenderProgress& shown_;
    std::mutex mutex_;
    std::condition_variable wake_;
    bool done_ = false, late_ = false;
    std::thread thread_;  // declared last: it uses the members above
};

}  // namespace

Frames::Frames(const SceneDescription& description, const Machine& machine, int frame_width, int frame_height,
               StepProgress& watched)
    : renderers(description, machine),
      scene(description),
      camera(camera_at(description.camera, 0)),
      width(frame_width),
      height(frame_height),
      progress(watched) {}

void check_interrupt(const StepProgress& progress) {
    if (progress.render.stop) throw Error(ErrorKind::interrupted, "interrupted; nothing was written");
}

double Frames::render(const Setting& setting, Film& film, uint32_t effects) {
    FrameSettings settings = frame_settings(setting, width, height);
    settings.effects = effects;
    return render(renderers.of(setting), settings, film);
}

double Frames::kernel_ms(const Setting& setting, double seconds) {
    const double kernel = renderers.of(setting).times().kernel;
    return 1e3 * (kernel > 0 ? kernel : seconds);
}

double Frames::render(Renderer& renderer, const FrameSettings& settings, Film& film) {
    begin();
    const double seconds = seconds_of([&] { renderer.render(camera, settings, film, progress.render); });
    check(film);
    return seconds;
}

std::optional<double> Frames::render_within(const FrameLimit& limit, const Setting& setting, Film& film) {
    Renderer& renderer = renderers.of(setting);
    begin();
    Watch watch(limit, progress.render);
    const double seconds =
        seconds_of([&] { renderer.render(camera, frame_settings(setting, width, height), film, watch.frame); });
    if (watch.end()) {
        check_interrupt(progress);
        return std::nullopt;
    }
    check(film);
    return seconds;
}

void Frames::begin() {
    check_interrupt(progress);
    progress.render.pixels_done = 0;
    progress.render.rays = 0;
}

void Frames::check(const Film& film) const {
    check_interrupt(progress);
    if (film.flags != 0)
        throw Error(ErrorKind::failed,
                    fmt::format("{}: a frame cannot be trusted: {}", scene.source, describe_flags(film.flags, scene)));
}

}  // namespace cistula::report
