// Handling of Ctrl-C, SIGTERM, SIGHUP and SIGPIPE through a flag that renderers poll.
#pragma once

#include <atomic>

namespace cistula {

/// While an object of this class exists, SIGINT, SIGTERM, SIGHUP, and SIGPIPE that another process sends, end the
/// process at once, with exit code 130, a line, and without the temporaries of files (AtomicFile). Only one object at a
/// time: run_program() has it.
class InterruptGuard {
  public:
    /// `program`: its name, for the line.
    explicit InterruptGuard(const char* program);
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;
};

/// While an object of this class exists, the first of these signals sets a flag instead; the second ends the process,
/// without a line. Only one object at a time.
class StopOnInterrupt {
  public:
    explicit StopOnInterrupt(std::atomic<bool>& stop);
    ~StopOnInterrupt();
    StopOnInterrupt(const StopOnInterrupt&) = delete;
    StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;
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
