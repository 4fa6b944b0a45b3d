// Between the library and its module for OpenImageIO, which is loaded when the first texture needs it: plain C types,
// so that each side frees what it allocated and no exception crosses.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cistula {

/// What a sample is; the value is its size in bytes.
enum class OiioSamples : uint32_t { uint8 = 1, uint16 = 2, float32 = 4 };

/// The side that calls. Every function gets `self`; reasons are copied before they return.
struct OiioHost {
    void* self;
    /// Room for width * height * channels samples, row-major from the top left; null, with a reason kept: do not go on.
    void* (*room)(void* self, uint32_t width, uint32_t height, uint32_t channels, OiioSamples type) noexcept;
    /// Why the call fails, without the name of the file.
    void (*failed)(void* self, const char* reason) noexcept;
};

/// True on success. Otherwise `failed` was called, or a function of the host has refused.
struct OiioModule {
    /// Colors as stored, not multiplied by alpha: three channels, or one where the file has fewer than three.
    bool (*read)(const char* path, const OiioHost* host) noexcept;
};

/// The one function that the module exports. Its number changes with this header.
using OiioModuleEntry = const OiioModule* (*)();
inline constexpr const char* oiio_module_entry = "cistula_oiio_module_2";

}  // namespace cistula
