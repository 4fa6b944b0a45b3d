#include "base/stages.h"

#include <chrono>
#include <ctime>

namespace cistula {
namespace {

using Clock = std::chrono::steady_clock;

StageSeconds seconds{};
Clock::time_point since;
Stage current = Stage::start;
thread_local bool is_timed = false;

/// Enters the time since the last call.
void count() {
    const Clock::time_point now = Clock::now();
    seconds[static_cast<size_t>(current)] += std::chrono::duration<double>(now - since).count();
    since = now;
}

}  // namespace

void begin_stages() {
    since = Clock::now();
    is_timed = true;
    timespec used = {};  // by a single thread so far: no more than passed
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    seconds = {};
    seconds[static_cast<size_t>(Stage::start)] =
        static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
    current = Stage::start;
}

Stage enter_stage(Stage stage) {
    if (!is_timed) return Stage::other;
    count();
    const Stage before = current;
    current = stage;
    return before;
}

StageSeconds stage_seconds() {
    if (is_timed) count();
    return seconds;
}

}  // namespace cistula
