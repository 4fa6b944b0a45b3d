// Interface between the program that reads pictures and its module for OpenImageIO, which it loads when a picture needs
// it. Plain C types, so that each side frees what it allocated and no exception crosses.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cistula {

/// Type of a sample; the value is its size in bytes.
enum class OiioSamples : uint32_t { uint8 = 1, uint16 = 2, float32 = 4 };

/// Callbacks of the calling side. Every function gets `self`; reasons are copied before it returns.
struct OiioHost {
    void* self;
    /// Bytes that the texels of the picture may take, 12 each.
    uint64_t left;
    /// Receives the file's ICC profile, if it has one, before `begin`. The bytes are the module's.
    void (*profile)(void* self, const void* bytes, size_t count) noexcept;
    /// Announces a picture. False: the host refuses and knows the reason; the module returns.
    bool (*begin)(void* self, int64_t width, int64_t height, uint32_t channels, OiioSamples type) noexcept;
    /// Takes the next `texels` texels of width * height, row-major from the top left.
    void (*samples)(void* self, const void* from, size_t texels) noexcept;
    /// Reports why the call fails, without the file's name.
    void (*failed)(void* self, const char* reason) noexcept;
};

/// Functions of the module. They return true on success; otherwise `failed` was called, or a function of the host
/// refused.
struct OiioModule {
    /// Reads a picture. Colors as stored, not multiplied by alpha: three channels, or one where the file has fewer than
    /// three.
    bool (*read)(const char* path, const OiioHost* host) noexcept;
};

/// The one function that the module exports. Its number changes whenever this header does.
using OiioModuleEntry = const OiioModule* (*)();
inline constexpr const char* oiio_module_entry = "cistula_oiio_module_5";

}  // namespace cistula
