// Errors that a user can act on. Programs print them as one line on standard error and return the exit code.
#pragma once

#include <atomic>
#include <stdexcept>
#include <string_view>

#include "base/shown_text.h"

namespace cistula {

/// Exit codes of every program (docs/programs.md).
enum class ExitCode : int {
    done = 0,
    failed = 1,  // a comparison or a test case failed
    usage = 2,   // the command line or the scene is wrong
    file = 3,    // a file cannot be read or written
    device = 4,  // no usable GPU, or CUDA is not in this build
    target = 5,  // --target-error was not met
    interrupted = 130,
};

/// An error for the user. what() is the whole message, on one line (shown_text.h): the place (file:line:column or file:
/// JSON pointer), what is wrong, what would be right.
class Error : public std::runtime_error {
  public:
    Error(ExitCode code, std::string_view message) : std::runtime_error(message_line(message)), code_(code) {}
    ExitCode code() const { return code_; }

  private:
    ExitCode code_;
};

/// A flag by which any thread stops long work, which looks at it every few milliseconds. Without a flag nothing stops.
class StopSignal {
  public:
    StopSignal() = default;
    StopSignal(const std::atomic<bool>& flag) : flag_(&flag) {}

    bool is_given() const { return flag_ && *flag_; }
    /// Throws Error (interrupted) if the signal is given.
    void check() const {
        if (is_given()) throw Error(ExitCode::interrupted, "interrupted; nothing was written");
    }

  private:
    const std::atomic<bool>* flag_ = nullptr;
};

}  // namespace cistula
