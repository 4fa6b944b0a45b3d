// Ctrl-C and SIGTERM: a flag that the renderer looks at now and then.
#pragma once

#include <atomic>

namespace cistula {

/// While one lives, the first SIGINT or SIGTERM is caught and the second ends the process at once. Before watch() the
/// first one ends it too, with exit code 130 and a line that says that nothing was written. One at a time.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    /// From now on an interruption sets `stop`, which must outlive the guard.
    void watch(std::atomic<bool>& stop);
};

}  // namespace cistula
