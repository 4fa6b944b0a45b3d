// What a user sees while a program goes through its steps.
#pragma once

#include <chrono>
#include <string>

#include "apps/common/status_line.h"
#include "scene/film/renderer.h"

namespace cistula {

/// Shows the step under way and how long it may still take: a line drawn again and again on a terminal; elsewhere now
/// and then a line, and one for each step where the style is plain. Also holds the flag that Ctrl-C sets.
class StepProgress {
  public:
    explicit StepProgress(ProgressStyle style);

    /// Begins a step of so many parts, or of parts whose weights have this sum.
    void begin(const std::string& step, double parts);
    /// Names the part under way.
    void name_part(const std::string& name);
    /// Counts a part as done.
    void advance(double weight = 1);
    /// Begins a part that is a frame of this many pixels, each of which counts as soon as it is done.
    void frame(uint64_t pixels);

    /// A line of its own on standard error; nothing where the style is none.
    void say(const std::string& line);

    /// Runs `write`, which writes to the terminal, while the line is out of the way.
    template <class Write>
    void aside(const Write& write) {
        line_.aside(write);
    }

    RenderProgress render;  // of the frame under way

  private:
    using Clock = std::chrono::steady_clock;

    std::string text(int columns) const;

    const bool quiet_;
    std::string step_, part_;
    double parts_ = 0, done_ = 0;
    uint64_t pixels_ = 0;
    Clock::time_point start_ = Clock::now();
    StatusLine line_;  // after all that it shows
};

}  // namespace cistula
