// What a user sees while the report is measured: the step under way and how long it may still take.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "scene/renderer.h"

namespace cistula::report {

/// On a terminal one line that is drawn anew; elsewhere a line for each step, and now and then one within. Also holds
/// the flag that Ctrl-C sets.
class Progress {
  public:
    explicit Progress(bool quiet);
    ~Progress();

    /// A step of `parts` parts, of one weight if `weight` is not told.
    void begin(const std::string& step, double parts);
    void advance(double weight = 1);
    /// While one long frame of this many pixels renders, which is a part: its pixels count too.
    void frame(uint64_t pixels);

    /// A line of its own.
    void say(const std::string& line);

    RenderProgress render;  // of the frame under way

  private:
    using Clock = std::chrono::steady_clock;

    void watch();
    std::string line() const;  // mutex_ held
    void draw();               // mutex_ held
    void erase();              // mutex_ held

    const bool quiet_, terminal_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    bool stop_ = false, drawn_ = false;
    std::string step_;
    double parts_ = 0, done_ = 0;
    uint64_t pixels_ = 0;
    Clock::time_point start_ = Clock::now(), last_line_ = Clock::now();
    std::thread thread_;
};

}  // namespace cistula::report
