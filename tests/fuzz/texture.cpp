// Picture files, through the program that reads pictures and its module for OpenImageIO, to texels. That a library
// crashes or hangs is an error like any other; what it tells this process must not do harm here.
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>

#include "image/reader/picture_reader.h"
#include "mesh_checks.h"
#include "testing/support/scratch_directory.h"

namespace {

/// The extension by which the bytes are read as what they begin like.
std::string extension_of(const std::string& bytes) {
    const struct {
        const char* start;
        const char* extension;
    } known[] = {{"\x89PNG", ".png"}, {"\xff\xd8", ".jpg"}, {"BM", ".bmp"},   {"DDS ", ".dds"},   {"#?", ".hdr"},
                 {"GIF8", ".gif"},    {"II*", ".tif"},      {"MM", ".tif"},   {"RIFF", ".webp"},  {"P6", ".ppm"},
                 {"8BPS", ".psd"},    {"\x01\xda", ".sgi"}, {"FORM", ".iff"}, {"v/1\x01", ".exr"}};
    for (const auto& [start, extension] : known)
        if (bytes.starts_with(start)) return extension;
    return ".tga";
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace cistula;
    static const ScratchDirectory scratch;
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    const std::string path = scratch.file(std::string("a").append(extension_of(bytes)));
    put_bytes(path, bytes);
    constexpr uint64_t limit = 32'000'000;
    static std::unique_ptr<TextureReader> reader;  // with its child process, which takes a while to start
    static uint64_t used = limit;
    if (used > limit / 2) {
        reader = std::make_unique<TextureReader>(TextureLimits{limit, 1});
        used = 0;
    }
    try {
        ClampedTexels clamped;
        const ColorPicture picture = reader->read(path, &clamped);
        fuzz::require(picture.texels.size() == static_cast<size_t>(picture.width) * picture.height);
        used += picture.texels.size() * texel_bytes;
        fuzz::require(used <= limit);
        for (const glm::vec3& texel : picture.texels)
            for (int c = 0; c < 3; ++c) fuzz::require(std::isfinite(texel[c]) && texel[c] >= 0);
    } catch (const Error& error) {
        fuzz::check_error(error, ErrorKind::file);
    }
    return 0;
}
