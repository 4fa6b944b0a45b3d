// Reads textures, which may come from strangers.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

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

    /// A texture as linear Rec. 709. OpenEXR, by extension or by content, and raw pictures are read by every build,
    /// other formats through OpenImageIO. `encoding`, the name of one of color_encodings, says what its numbers mean;
    /// without it the file does, and if that says nothing, integers are sRGB, floating-point numbers linear Rec. 709.
    /// Values that are then negative, infinite or not a number are clamped and counted in `clamped`; without that they
    /// are an error. Throws Error(ExitCode::file) with the path, and std::bad_alloc.
    ColorPicture read(const std::string& path, ClampedTexels* clamped, std::string_view encoding = {});

  private:
    ColorPicture read_any(const std::string& path, std::string_view encoding);
    ColorPicture read_in_child(const std::string& path, bool is_exr, std::string_view encoding);

    TextureLimits limits_;
    uint64_t left_;  // bytes
    std::unique_ptr<class ReaderProcess> process_;
};

}  // namespace cistula
