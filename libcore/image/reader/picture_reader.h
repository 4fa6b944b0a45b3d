// Reads pictures, which may come from strangers: as textures, and as they stand in their files.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "image/color/clamped_texels.h"
#include "image/picture/picture.h"
#include "image/picture/stored_picture.h"
#include "image/reader/texture_limits.h"

namespace cistula {

enum class ReadKind : uint32_t;

/// Has pictures decoded in a child process, the program cistula-read-picture, which the first one starts: a picture
/// that makes a library crash, hang or take memory without end is an error like any other. Its limits count for all
/// pictures together. Of one thread.
class GuardedReader {
  public:
    GuardedReader(const GuardedReader&) = delete;
    GuardedReader& operator=(const GuardedReader&) = delete;

  protected:
    /// `users` need the program, for the message where it is not found.
    GuardedReader(const TextureLimits& limits, std::string users);
    ~GuardedReader();

    /// Asks for a file, and calls `take` with the answer. Throws Error (file) with the path, and
    /// std::bad_alloc.
    void ask(const std::string& path, ReadKind kind, const std::function<void(class ReaderReply& reply)>& take);

    const TextureLimits limits_;
    uint64_t left_;  // bytes

  private:
    std::string users_;
    std::unique_ptr<class ReaderProcess> process_;
};

/// A texture's numbers, as a program has them that has no file: texels row by row from the top left, each of so many
/// channels. The first three are red, green and blue; the first is gray where there are fewer. The largest integer is
/// white.
struct TexelArray {
    uint32_t width = 0;
    uint32_t height = 0;
    uint32_t channels = 3;
    std::variant<std::vector<uint8_t>, std::vector<uint16_t>, std::vector<float>> values;
};

/// Reads textures. Raw pictures, .data and .out, need no child.
class TextureReader : public GuardedReader {
  public:
    explicit TextureReader(const TextureLimits& limits = {});

    /// A texture as linear Rec. 709. OpenEXR, by extension or by content, and raw pictures are read by every build,
    /// other formats through OpenImageIO. `encoding`, the name of one of color_encodings, says what its numbers mean;
    /// without it the file does, and if that says nothing, integers are sRGB, floating-point numbers linear Rec. 709.
    /// Values that are then negative, infinite or not a number are clamped and counted in `clamped`; without that they
    /// are an error. Throws Error (file) with the path, and std::bad_alloc.
    ColorPicture read(const std::string& path, ClampedTexels* clamped, std::string_view encoding = {});

    /// A texture of an array, in the same way. Throws Error (usage).
    ColorPicture decode(const TexelArray& array, ClampedTexels* clamped, std::string_view encoding = {});
};

/// Reads picture files as they stand. OpenEXR, by extension or by content, is read by every build, in this process;
/// other formats by OpenImageIO, in a child process.
class StoredReader : public GuardedReader {
  public:
    explicit StoredReader(const TextureLimits& limits = {});

    /// All of a file: parts or subimages, levels, channels, attributes, no value converted. Throws
    /// Error (file) with the path, and std::bad_alloc.
    StoredFile read(const std::string& path);

    /// Two files to be compared; the values of EXRs only where `want` says so of what their headers say.
    std::pair<StoredFile, StoredFile> read_two(const std::string& first, const std::string& second,
                                               const std::function<bool(const StoredFile&, const StoredFile&)>& want);
};

}  // namespace cistula
