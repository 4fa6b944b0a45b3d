// Files that are written whole or not at all: a failure or an interruption leaves the old file as it was.
#pragma once

#include <string>
#include <string_view>

#include "scene/base/file_bytes.h"

namespace cistula {

/// Write to temporary(), then commit(). Without a commit the destructor removes what was written.
/// The temporary lies beside the target as ".NAME.XXXXXX.part", so that renaming it is one step of the file system.
/// A link is followed: the file that it points to is replaced. Only regular files are ever replaced.
class AtomicFile {
  public:
    /// Creates the temporary, empty, with the permissions of the file that it will replace.
    /// Throws Error(ExitCode::file) with the system's reason.
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const std::string& path() const { return path_; }
    const std::string& temporary() const { return temporary_; }

    /// Appends to the temporary. Throws Error(ExitCode::file).
    void write(std::string_view bytes);

    /// Forces the bytes to the disk and puts the file in its place. Throws Error(ExitCode::file).
    void commit();

  private:
    std::string path_;       // as the user wrote it, for messages
    std::string target_;     // with links followed
    std::string temporary_;  // empty once committed
    int descriptor_ = -1;
};

/// Replaces the file by these bytes, or leaves it untouched and throws Error(ExitCode::file).
void write_file_atomically(const std::string& path, std::string_view bytes);

}  // namespace cistula
