// What a user sees while frames render: a bar on a terminal, now and then a line elsewhere.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "options.h"
#include "scene/renderer.h"

namespace cistula {

/// Where a film stands.
struct ProgressState {
    int frame = 0;        // number of the frame in work
    size_t index = 0;     // its place among the frames to render, from 0
    size_t count = 1;     // frames to render
    double fraction = 0;  // of the frame in work, 0 to 1
    double elapsed = 0;   // seconds since the film began
    double rays_per_second = 0;
};

/// Seconds left, if the rest goes as what is done went; negative where nothing is done.
double remaining_seconds(const ProgressState& state);

/// "0:07", "12:34", "1:02:03".
std::string format_duration(double seconds);

/// "950 rays/s", "12.3 Mrays/s".
std::string format_rate(double rays_per_second);

/// One line of at most `columns` characters, without a line end.
std::string progress_bar(const ProgressState& state, int columns);
std::string progress_line(const ProgressState& state);

/// Watches a RenderProgress from a thread of its own and writes to standard error.
class ProgressReport {
  public:
    ProgressReport(ProgressStyle style, size_t frames, const RenderProgress& progress);
    ~ProgressReport();

    void begin_frame(int frame, size_t index, uint64_t pixels);
    void end_frame();

    /// A line of its own on standard error, the bar drawn again below it.
    void say(const std::string& line);

  private:
    using Clock = std::chrono::steady_clock;
    enum class Output { bar, lines, sparse_lines, none };

    void watch();
    ProgressState state() const;  // mutex_ held
    void draw();                  // mutex_ held
    void erase();                 // mutex_ held

    const Output output_;
    const size_t count_;
    const RenderProgress& progress_;
    const Clock::time_point start_ = Clock::now();

    std::mutex mutex_;
    std::condition_variable wake_;
    bool stop_ = false, in_frame_ = false, drawn_ = false;
    int frame_ = 0;
    size_t index_ = 0;
    uint64_t pixels_ = 1;
    Clock::time_point frame_start_ = start_, last_line_ = start_;
    std::thread thread_;
};

}  // namespace cistula
