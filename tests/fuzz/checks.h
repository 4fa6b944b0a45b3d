// What all targets share.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "base/error.h"
#include "base/shown_text.h"

namespace cistula::fuzz {

inline void require(bool holds) {
    if (!holds) std::abort();
}

/// Aborts unless a text is one line as messages show it.
inline void check_line(const std::string& text) {
    require(!text.empty() && one_line(text) == text);
}

/// Aborts unless an error is one line for the user, of this kind.
inline void check_error(const Error& error, ErrorKind kind) {
    require(error.kind() == kind);
    check_line(error.what());
}

/// Bytes as a file that has a path and lies in memory.
class MemoryFile {
  public:
    MemoryFile(const uint8_t* data, size_t size) : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
        require(descriptor_ >= 0 && write(descriptor_, data, size) == static_cast<ssize_t>(size));
    }
    ~MemoryFile() { close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

  private:
    int descriptor_;
};

}  // namespace cistula::fuzz
