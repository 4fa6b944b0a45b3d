#include "apps/common/status_line.h"

#include <fmt/format.h>

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "base/shown_text.h"

namespace cistula {
namespace {

int terminal_columns() {
    winsize size = {};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// What reads records gets each as soon as it is there.
void print_record(const std::string& lines) {
    std::fputs((lines + "\n").c_str(), stdout);
    std::fflush(stdout);
}

}  // namespace

bool is_terminal() {
    const char* kind = std::getenv("TERM");
    return isatty(STDERR_FILENO) && (kind == nullptr || std::string_view(kind) != "dumb");
}

std::string format_duration(double seconds) {
    const auto whole = static_cast<long long>(std::clamp(std::ceil(seconds), 0.0, 1e9));
    if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

StatusLine::StatusLine(ProgressStyle style, std::function<std::string(int columns)> text)
    : output_(style == ProgressStyle::none    ? Output::none
              : is_for_programs(style)        ? Output::records
              : style == ProgressStyle::plain ? Output::lines
              : is_terminal()                 ? Output::drawn
                                              : Output::sparse_lines),
      text_(std::move(text)) {
    if (output_ != Output::none) thread_ = std::thread([this] { watch(); });
}

StatusLine::~StatusLine() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        erase();
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void StatusLine::say(const std::string& line) {
    aside([&] { std::fprintf(stderr, "%s\n", message_line(line).c_str()); });
}

void StatusLine::milestone(const std::string& line) {
    if (output_ == Output::lines) say(line);
}

void StatusLine::record(const std::string& lines) {
    const std::lock_guard lock(mutex_);
    if (output_ == Output::records) print_record(lines);
}

void StatusLine::watch() {
    const auto period = std::chrono::milliseconds(output_ == Output::drawn     ? 100
                                                  : output_ == Output::records ? 1000
                                                                               : 500);
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, period, [this] { return stop_; })) show();
}

void StatusLine::show() {
    if (output_ == Output::records) {
        if (const std::string text = text_(0); !text.empty()) print_record(text);
        return;
    }
    const bool drawn = output_ == Output::drawn;
    const auto silence = std::chrono::seconds(output_ == Output::lines ? 10 : 30);
    if (!drawn && Clock::now() - last_line_ < silence) return;
    const int columns = std::max(terminal_columns() - 1, 1);
    const std::string text = text_(drawn ? columns : 0);
    const std::string line = drawn ? first_characters(text, static_cast<size_t>(columns)) : message_line(text);
    if (line.empty()) return;
    if (drawn) {
        std::fprintf(stderr, "\r%s\033[K", line.c_str());
        std::fflush(stderr);
        drawn_ = true;
        return;
    }
    last_line_ = Clock::now();
    std::fprintf(stderr, "%s\n", line.c_str());
}

void StatusLine::erase() {
    if (!drawn_) return;
    std::fprintf(stderr, "\r\033[K");
    std::fflush(stderr);
    drawn_ = false;
}

}  // namespace cistula
