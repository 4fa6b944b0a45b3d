#include "apps/common/sequence_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/common/progress_record.h"
#include "sequence/stats.h"

namespace cistula {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string left_text(const ProgressState& state) {
    const double left = remaining_seconds(state);
    return left < 0 ? "?" : format_duration(left);
}

}  // namespace

double remaining_seconds(const ProgressState& state) {
    const double done = static_cast<double>(state.index) + state.fraction;
    return done > 0 ? state.elapsed * (static_cast<double>(state.count) - done) / done : -1;
}

std::string format_rate(double rays_per_second) {
    if (rays_per_second >= 999.5e6) return fmt::format("{:.2f} Grays/s", rays_per_second * 1e-9);
    if (rays_per_second >= 999.5e3) return fmt::format("{:.1f} Mrays/s", rays_per_second * 1e-6);
    if (rays_per_second >= 999.5) return fmt::format("{:.1f} krays/s", rays_per_second * 1e-3);
    return fmt::format("{:.0f} rays/s", rays_per_second);
}

std::string progress_bar(const ProgressState& state, int columns) {
    const std::string head = state.count > 1
                                 ? fmt::format("frame {} ({}/{}) ", state.frame, state.index + 1, state.count)
                                 : fmt::format("frame {} ", state.frame);
    const std::string tail = fmt::format(" {:3.0f} %  {}  ETA {}", std::floor(state.fraction * 100),
                                         format_rate(state.rays_per_second), left_text(state));
    const int room = std::min(columns - static_cast<int>(head.size() + tail.size()) - 2, 40);
    std::string line = head;
    if (room >= 5) {
        const int full = std::clamp(static_cast<int>(state.fraction * room), 0, room);
        line += '[' + std::string(static_cast<size_t>(full), '#') + std::string(static_cast<size_t>(room - full), '-') +
                ']';
    }
    return (line + tail).substr(0, static_cast<size_t>(std::max(columns, 0)));
}

std::string progress_line(const ProgressState& state) {
    return fmt::format("frame {} ({}/{}): {:.0f} %, {}, ETA {}", state.frame, state.index + 1, state.count,
                       std::floor(state.fraction * 100), format_rate(state.rays_per_second), left_text(state));
}

// Records are printed however little the program says.
SequenceProgress::SequenceProgress(ProgressStyle style, Talk talk, const RenderProgress& progress)
    : style_(talk == Talk::errors && !is_for_programs(style) ? ProgressStyle::none : style),
      talk_(talk),
      progress_(progress),
      line_(style_, [this](int columns) { return text(columns); }) {}

void SequenceProgress::read(const std::vector<std::string>& files) {
    record({.event = "read", .files = files});
}

void SequenceProgress::begin(size_t frames) {
    line_.update([&] {
        count_ = frames;
        start_ = Clock::now();
    });
    record({"begin"});
}

void SequenceProgress::kept(int frame, const std::string& file) {
    record({"kept", frame, file});
}

void SequenceProgress::begin_frame(int frame, size_t index, size_t count, uint64_t pixels) {
    line_.update([&] {
        frame_ = frame;
        index_ = index;
        count_ = count;
        pixels_ = pixels;
        frame_start_ = Clock::now();
        in_frame_ = true;
    });
    record({"frame", frame});
}

void SequenceProgress::end_frame(const FrameStats& frame) {
    line_.milestone(progress_line(state()));
    line_.record(state_record(style_, state()));
    line_.update([&] { in_frame_ = false; });
    if (talk_ == Talk::much)
        say(fmt::format("render: frame {}: {:.3f} s, {} rays, {}", frame.frame, frame.render_seconds,
                        frame.rays.total(),
                        format_rate(static_cast<double>(frame.rays.total()) / frame.render_seconds)));
}

void SequenceProgress::written(const FrameStats& frame) {
    record({"written", frame.frame, frame.file});
}

void SequenceProgress::snapshot(int frame, const std::string& file, double fraction) {
    record({"snapshot", frame, file, fraction});
}

void SequenceProgress::warning(const std::string& line) {
    remark("warning: " + line);
}

void SequenceProgress::remark(const std::string& line) {
    if (talk_ != Talk::errors) say("render: " + line);
}

void SequenceProgress::end(const RunStats&, size_t done, size_t frames) {
    line_.update([&] { in_frame_ = false; });
    line_.aside([] {});
    record({"end", -1, "", -1, fmt::format("{} of {} frames written", done, frames)});
}

void SequenceProgress::say(const std::string& text) {
    const std::string line = with_options(text);
    line_.say(line);
    record({"message", -1, "", -1, line});
}

void SequenceProgress::record(const EventRecord& record) {
    if (!is_for_programs(style_)) return;
    ProgressState now;
    line_.update([&] { now = state(); });
    if (const std::string lines = event_record(style_, record, now); !lines.empty()) line_.record(lines);
}

ProgressState SequenceProgress::state() const {
    const double pixels = static_cast<double>(progress_.pixels_done.load());
    const double rays = static_cast<double>(progress_.rays.load());
    const double frame_seconds = std::max(seconds_since(frame_start_), 1e-6);
    return {frame_,
            index_,
            count_,
            std::min(pixels / static_cast<double>(pixels_), 1.0),
            seconds_since(start_),
            rays / frame_seconds};
}

std::string SequenceProgress::text(int columns) const {
    if (!in_frame_) return "";
    if (is_for_programs(style_)) return state_record(style_, state());
    return columns > 0 ? progress_bar(state(), columns) : progress_line(state());
}

}  // namespace cistula
