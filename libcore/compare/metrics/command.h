// Runs of other programs, with a folder for what they write.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"

namespace cistula {

/// A folder that goes with the object.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::string file(const std::string& name) const { return path_ + "/" + name; }

  private:
    std::string path_;
};

/// How a program ended: its exit code, or less than 0 if a signal ended it; what it printed on both streams.
struct CommandEnd {
    int code = 0;
    std::string said;
};

/// Runs a program of PATH in a folder, with nothing to read, and waits for it; nothing if it cannot be started. Its
/// output goes through `temporary`. Once `stop` is given, the program and those that it started are ended. Throws Error
/// (interrupted).
std::optional<CommandEnd> run_command(std::vector<std::string> words, const std::string& folder,
                                      const TemporaryFolder& temporary, StopSignal stop);

}  // namespace cistula
