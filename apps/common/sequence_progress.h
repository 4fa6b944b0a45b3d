// Progress display while the frames of a sequence render.
#pragma once

#include <chrono>
#include <string>

#include "apps/common/status_line.h"
#include "render/renderer.h"
#include "sequence/sequence_events.h"

namespace cistula {

/// State of a sequence's rendering.
struct ProgressState {
    int frame = 0;        // number of the current frame
    size_t index = 0;     // its index among the frames to render, from 0
    size_t count = 1;     // frames to render
    double fraction = 0;  // of the current frame, 0 to 1
    double elapsed = 0;   // seconds since the sequence began
    double rays_per_second = 0;
};

/// Estimated seconds left at the average speed so far; negative if nothing is done yet.
double remaining_seconds(const ProgressState& state);

/// A rate with its unit: "950 rays/s", "12.3 Mrays/s".
std::string format_rate(double rays_per_second);

/// A progress bar of at most `columns` characters, without a line end.
std::string progress_bar(const ProgressState& state, int columns);
std::string progress_line(const ProgressState& state);

struct EventRecord;

/// What a program says of a sequence besides its progress.
enum class Talk { errors, some, much };

/// Shows a sequence's progress from a RenderProgress: a bar on a terminal, a line now and then elsewhere, or records
/// for programs; and says what else happens to it. All members may be called on any thread.
class SequenceProgress : public SequenceEvents {
  public:
    SequenceProgress(ProgressStyle style, Talk talk, const RenderProgress& progress);

    void read(const std::vector<std::string>& files) override;
    void begin(size_t frames) override;
    void kept(int frame, const std::string& file) override;
    void begin_frame(int frame, size_t index, size_t count, uint64_t pixels) override;
    void end_frame(const FrameStats& frame) override;
    void written(const FrameStats& frame) override;
    void snapshot(int frame, const std::string& file, double fraction) override;
    void warning(const std::string& line) override;
    void remark(const std::string& line) override;
    void end(const RunStats& stats, size_t done, size_t frames) override;

  private:
    void say(const std::string& line);
    void record(const EventRecord& record);
    using Clock = std::chrono::steady_clock;

    ProgressState state() const;
    std::string text(int columns) const;

    const ProgressStyle style_;
    const Talk talk_;
    const RenderProgress& progress_;
    Clock::time_point start_ = Clock::now();
    bool in_frame_ = false;
    int frame_ = 0;
    size_t index_ = 0;
    size_t count_ = 1;
    uint64_t pixels_ = 1;
    Clock::time_point frame_start_ = start_;
    StatusLine line_;  // declared last: it uses the members above
};

}  // namespace cistula
