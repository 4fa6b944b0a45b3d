#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "apps/render/progress.h"

namespace cistula::report {

Progress::Progress(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {
    if (!quiet_) thread_ = std::thread([this] { watch(); });
}

Progress::~Progress() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        erase();
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void Progress::begin(const std::string& step, double parts) {
    const std::lock_guard lock(mutex_);
    step_ = step;
    parts_ = parts;
    done_ = 0;
    pixels_ = 0;
    start_ = last_line_ = Clock::now();
    if (quiet_ || terminal_) return;
    fmt::print(stderr, "{}\n", step_);
}

void Progress::advance(double weight) {
    const std::lock_guard lock(mutex_);
    done_ += weight;
    pixels_ = 0;
}

void Progress::frame(uint64_t pixels) {
    const std::lock_guard lock(mutex_);
    pixels_ = pixels;
}

void Progress::say(const std::string& line) {
    const std::lock_guard lock(mutex_);
    erase();
    if (!quiet_) fmt::print(stderr, "{}\n", line);
}

void Progress::watch() {
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, std::chrono::milliseconds(200), [this] { return stop_; })) draw();
}

std::string Progress::line() const {
    const double within =
        pixels_ > 0 ? std::min(1.0, static_cast<double>(render.pixels_done) / static_cast<double>(pixels_)) : 0;
    const double fraction = parts_ > 0 ? std::min(1.0, (done_ + within) / parts_) : 0;
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    return fmt::format("{}: {:.0f} %, ETA {}", step_, 100 * fraction,
                       fraction > 0 ? format_duration(elapsed * (1 - fraction) / fraction) : "?");
}

void Progress::draw() {
    if (step_.empty()) return;
    if (terminal_) {
        fmt::print(stderr, "\r{}\033[K", line());
        std::fflush(stderr);
        drawn_ = true;
    } else if (Clock::now() - last_line_ > std::chrono::seconds(15)) {
        last_line_ = Clock::now();
        fmt::print(stderr, "{}\n", line());
    }
}

void Progress::erase() {
    if (!drawn_) return;
    fmt::print(stderr, "\r\033[K");
    drawn_ = false;
}

}  // namespace cistula::report
