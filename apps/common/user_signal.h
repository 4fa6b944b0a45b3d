// SIGUSR1, by which users ask a running program for something.
#pragma once

namespace cistula {

/// While an object of this class exists, SIGUSR1 is caught and counted. Only one object at a time.
class UserSignal {
  public:
    UserSignal();
    ~UserSignal();
    UserSignal(const UserSignal&) = delete;
    UserSignal& operator=(const UserSignal&) = delete;

    /// Waits for a signal; several that came since the last call are one. False once close() was called.
    bool wait();

    /// Ends the wait of another thread, and all later ones.
    void close();
};

}  // namespace cistula
