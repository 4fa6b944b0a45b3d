// Reads textures, which may come from strangers.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "scene/image/clamped_texels.h"
#include "scene/image/picture.h"
#include "scene/image/texture_limits.h"

namespace cistula {

/// Reads textures within limits that count for all of them together. Libraries decode pictures in a child process, the
/// program cistula-read-picture, which the first one starts: a picture that makes a library crash, hang or take
/// memory without end is an error like any other. Raw pictures, .data and .out, need no child. Of one thread.
class TextureReader {
  public:
    explicit TextureReader(const TextureLimits& limits = {});
    ~TextureReader();
    TextureReader(const TextureReader&) = delete;
    TextureReader& operator=(const TextureReader&) = delete;

    /// A texture as linear RGB. OpenEXR, by extension or by content, and raw pictures are read by every build, other
    /// formats through OpenImageIO. Integer samples are decoded from sRGB, floating-point ones are linear. Values that
    /// are negative, infinite or not a number are clamped and counted in `clamped`; without that they are an error.
    /// Throws Error(ExitCode::file) with the path.
    ColorPicture read(const std::string& path, ClampedTexels* clamped);

  private:
    ColorPicture read_any(const std::string& path);
    ColorPicture read_in_child(const std::string& path, bool is_exr);

    TextureLimits limits_;
    uint64_t left_;  // bytes
    std::unique_ptr<class ReaderProcess> process_;
};

}  // namespace cistula
