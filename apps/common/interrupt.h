// Handling of Ctrl-C, SIGTERM, SIGHUP and SIGPIPE through a flag that renderers poll.
#pragma once

#include <atomic>

namespace cistula {

/// While an object of this class exists, the first SIGINT, SIGTERM, SIGHUP, or SIGPIPE that another process sends, is
/// caught and the second ends the process, unless that is SIGPIPE where run_program() has it be a write error.
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

class SnapshotRequests;

/// While an object of this class exists, SIGUSR1 asks for a snapshot. Only one object at a time.
class UserSignal {
  public:
    explicit UserSignal(SnapshotRequests& requests);
    ~UserSignal();
    UserSignal(const UserSignal&) = delete;
    UserSignal& operator=(const UserSignal&) = delete;
};

}  // namespace cistula
