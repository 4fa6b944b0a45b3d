// Progress display while the frames of a film render.
#pragma once

#include <chrono>
#include <string>

#include "apps/common/status_line.h"
#include "scene/film/renderer.h"

namespace cistula {

/// State of a film's rendering.
struct ProgressState {
    int frame = 0;        // number of the current frame
    size_t index = 0;     // its index among the frames to render, from 0
    size_t count = 1;     // frames to render
    double fraction = 0;  // of the current frame, 0 to 1
    double elapsed = 0;   // seconds since the film began
    double rays_per_second = 0;
};

/// Estimated seconds left at the average speed so far; negative if nothing is done yet.
double remaining_seconds(const ProgressState& state);

/// A rate with its unit: "950 rays/s", "12.3 Mrays/s".
std::string format_rate(double rays_per_second);

/// A progress bar of at most `columns` characters, without a line end.
std::string progress_bar(const ProgressState& state, int columns);
std::string progress_line(const ProgressState& state);

struct FilmEvent;

/// Shows a film's progress from a RenderProgress: a bar on a terminal, a line now and then elsewhere, or records for
/// programs. All members may be called on any thread.
class FilmProgress {
  public:
    FilmProgress(ProgressStyle style, const RenderProgress& progress);

    /// Begins a film of so many frames, of which some may be complete.
    void begin(size_t count);

    /// Begins frame number `frame`, which is at `index` of the `count` frames to render.
    void begin_frame(int frame, size_t index, size_t count, uint64_t pixels);
    void end_frame();

    /// Takes the bar away when no frame is left to render.
    void end();

    /// Prints a line on standard error and redraws the bar below it.
    void say(const std::string& line);

    /// Prints a record where the style is for programs.
    void record(const FilmEvent& event);

  private:
    using Clock = std::chrono::steady_clock;

    ProgressState state() const;
    std::string text(int columns) const;

    const ProgressStyle style_;
    const RenderProgress& progress_;
    const Clock::time_point start_ = Clock::now();
    bool in_frame_ = false;
    int frame_ = 0;
    size_t index_ = 0, count_ = 1;
    uint64_t pixels_ = 1;
    Clock::time_point frame_start_ = start_;
    StatusLine line_;  // declared last: it uses the members above
};

}  // namespace cistula
