#include "progress.h"

#include <fmt/format.h>

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace cistula {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

int terminal_columns() {
    winsize size = {};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

bool is_terminal() {
    const char* kind = std::getenv("TERM");
    return isatty(STDERR_FILENO) && (kind == nullptr || std::string_view(kind) != "dumb");
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

std::string format_duration(double seconds) {
    const auto whole = static_cast<long long>(std::clamp(std::ceil(seconds), 0.0, 1e9));
    if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
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

ProgressReport::ProgressReport(ProgressStyle style, size_t frames, const RenderProgress& progress)
    : output_(style == ProgressStyle::none    ? Output::none
              : style == ProgressStyle::plain ? Output::lines
              : is_terminal()                 ? Output::bar
                                              : Output::sparse_lines),
      count_(frames),
      progress_(progress) {
    if (output_ != Output::none) thread_ = std::thread([this] { watch(); });
}

ProgressReport::~ProgressReport() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        erase();
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void ProgressReport::begin_frame(int frame, size_t index, uint64_t pixels) {
    const std::lock_guard lock(mutex_);
    frame_ = frame;
    index_ = index;
    pixels_ = pixels;
    frame_start_ = Clock::now();
    in_frame_ = true;
}

void ProgressReport::end_frame() {
    const std::lock_guard lock(mutex_);
    if (output_ == Output::lines) std::fprintf(stderr, "%s\n", progress_line(state()).c_str());
    in_frame_ = false;
}

void ProgressReport::say(const std::string& line) {
    const std::lock_guard lock(mutex_);
    erase();
    std::fprintf(stderr, "%s\n", line.c_str());
}

void ProgressReport::watch() {
    std::unique_lock lock(mutex_);
    while (
        !wake_.wait_for(lock, std::chrono::milliseconds(output_ == Output::bar ? 100 : 500), [this] { return stop_; }))
        if (in_frame_) draw();
}

ProgressState ProgressReport::state() const {
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

void ProgressReport::draw() {
    if (output_ == Output::bar) {
        std::fprintf(stderr, "\r%s\033[K", progress_bar(state(), terminal_columns() - 1).c_str());
        std::fflush(stderr);
        drawn_ = true;
        return;
    }
    // Within a long frame only: a line every 10 s, or every 30 s where nobody asked for lines.
    if (seconds_since(last_line_) < (output_ == Output::lines ? 10 : 30)) return;
    last_line_ = Clock::now();
    std::fprintf(stderr, "%s\n", progress_line(state()).c_str());
}

void ProgressReport::erase() {
    if (!drawn_) return;
    std::fprintf(stderr, "\r\033[K");
    std::fflush(stderr);
    drawn_ = false;
}

}  // namespace cistula
