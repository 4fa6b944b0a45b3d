// Handling of Ctrl-C, SIGTERM, SIGHUP and SIGPIPE through a flag that renderers poll.
#pragma once

#include <atomic>

namespace cistula {

/// While an object of this class exists, the first SIGINT, SIGTERM, SIGHUP, or SIGPIPE that another process sends, sets
/// a flag, and the second ends the process at once, with exit code 130 and without the temporaries of files
/// (AtomicFile). So does the first one, with a line, where no flag is watched. One within another is the same one.
class InterruptGuard {
  public:
    /// `program`: its name, for the line.
    explicit InterruptGuard(const char* program = "render");
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
