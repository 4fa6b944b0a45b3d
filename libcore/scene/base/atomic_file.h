// Atomic writing of files: a failure or an interruption leaves the old file unchanged.
#pragma once

#include <string>
#include <string_view>

#include "scene/base/file_bytes.h"

namespace cistula {

/// A file that replaces its target in one step. Write to temporary(), then commit(); without a commit the destructor
/// removes what was written. The temporary is ".NAME.XXXXXX.part" beside the target, so that replacing is one rename.
/// Symbolic links are followed: the file that they point to is replaced. Only regular files are replaced.
class AtomicFile {
  public:
    /// Creates the temporary, empty, with the permissions of the file that it will replace. Throws
    /// Error(ExitCode::file) with the system's reason.
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const std::string& path() const { return path_; }
    const std::string& temporary() const { return temporary_; }

    /// Appends to the temporary. Throws Error(ExitCode::file).
    void write(std::string_view bytes);

    /// Flushes the bytes to the disk and renames the temporary to the target. Throws Error(ExitCode::file).
    void commit();

  private:
    std::string path_;       // as the user wrote it, for messages
    std::string target_;     // symbolic links resolved
    std::string temporary_;  // empty once committed
    int descriptor_ = -1;
};

/// Replaces the file by these bytes, or leaves it unchanged and throws Error(ExitCode::file).
void write_file_atomically(const std::string& path, std::string_view bytes);

}  // namespace cistula
