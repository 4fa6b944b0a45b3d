// Progress display for programs that run in steps.
#pragma once

#include <chrono>
#include <string>

#include "apps/common/status_line.h"
#include "render/renderer.h"

namespace cistula {

/// Shows the current step and the estimated time left: on a terminal a line that is redrawn; elsewhere a line now and
/// then, and one for each step if the style is plain. Also holds the flag that Ctrl-C sets.
class StepProgress {
  public:
    explicit StepProgress(ProgressStyle style);

    /// Begins a step of `parts` parts, or of parts whose weights add up to that.
    void begin(const std::string& step, double parts);
    /// Names the part under way.
    void name_part(const std::string& name);
    /// Counts a part as done.
    void advance(double weight = 1);
    /// Begins a part that is a frame of this many pixels, each of which counts when it is done.
    void frame(uint64_t pixels);

    /// Prints a line on standard error, unless the style is none.
    void say(const std::string& line);

    /// Runs `write`, which writes to the terminal, while the status line is erased.
    template <class Write>
    void aside(const Write& write) {
        line_.aside(write);
    }

    RenderProgress render;  // of the current frame

  private:
    using Clock = std::chrono::steady_clock;

    std::string text() const;

    const bool quiet_;
    std::string step_, part_;
    double parts_ = 0, done_ = 0;
    uint64_t pixels_ = 0;
    Clock::time_point start_ = Clock::now();
    StatusLine line_;  // declared last: it uses the members above
};

}  // namespace cistula
