// Reads picture files as they stand, which may come from strangers.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "scene/image/stored_picture.h"
#include "scene/image/texture_limits.h"

namespace cistula {

/// Reads files within limits that count for all of them together. OpenEXR, by extension or by content, is read by every
/// build, in this process; other formats by OpenImageIO, in a child process as textures are (TextureReader). Of one
/// thread.
class StoredReader {
  public:
    explicit StoredReader(const TextureLimits& limits = {});
    ~StoredReader();
    StoredReader(const StoredReader&) = delete;
    StoredReader& operator=(const StoredReader&) = delete;

    /// All of a file: parts or subimages, levels, channels, attributes, no value converted. Throws
    /// Error(ExitCode::file) with the path, and std::bad_alloc.
    StoredFile read(const std::string& path);

  private:
    StoredFile read_in_child(const std::string& path);

    TextureLimits limits_;
    uint64_t left_;  // bytes
    std::unique_ptr<class ReaderProcess> process_;
};

}  // namespace cistula
