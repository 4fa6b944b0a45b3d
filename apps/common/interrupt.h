// Handling of Ctrl-C, SIGTERM and SIGHUP through a flag that renderers poll.
#pragma once

#include <atomic>

namespace cistula {

/// While an object of this class exists, the first SIGINT, SIGTERM or SIGHUP is caught and the second ends the process.
/// Before watch() the first one also ends it, with exit code 130 and a line that says that nothing was written. Only
/// one object at a time.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    /// Lets interruptions set `stop` from now on; it must outlive the guard.
    void watch(std::atomic<bool>& stop);
};

}  // namespace cistula
