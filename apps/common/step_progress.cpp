#include "apps/common/step_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cistula {

StepProgress::StepProgress(ProgressStyle style)
    : quiet_(style == ProgressStyle::none), line_(style, [this](int) { return text(); }) {}

void StepProgress::begin(const std::string& step, double parts) {
    line_.update([&] {
        step_ = step;
        part_.clear();
        parts_ = parts;
        done_ = 0;
        pixels_ = 0;
        start_ = Clock::now();
    });
    line_.milestone(step);
}

void StepProgress::name_part(const std::string& name) {
    line_.update([&] { part_ = name; });
}

void StepProgress::advance(double weight) {
    line_.update([&] {
        done_ += weight;
        pixels_ = 0;
    });
}

void StepProgress::frame(uint64_t pixels) {
    line_.update([&] { pixels_ = pixels; });
}

void StepProgress::say(const std::string& line) {
    if (!quiet_) line_.say(line);
}

std::string StepProgress::text() const {
    if (step_.empty()) return "";
    const double within =
        pixels_ > 0 ? std::min(1.0, static_cast<double>(render.pixels_done) / static_cast<double>(pixels_)) : 0;
    const double fraction = parts_ > 0 ? std::min(1.0, (done_ + within) / parts_) : 0;
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    const std::string left = fraction > 0 ? format_duration(elapsed * (1 - fraction) / fraction) : "?";
    const std::string name = part_.empty() ? step_ : step_ + ": " + part_;
    return fmt::format("{}: {:.0f} %, ETA {}", name, std::floor(100 * fraction), left);
}

}  // namespace cistula
