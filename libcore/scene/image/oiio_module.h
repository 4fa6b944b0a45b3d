// Interface of the module for OpenImageIO, which programs load when a picture or a view needs it. Plain C types, so
// that each side frees what it allocated and no exception crosses.
#pragma once

#include <cstddef>
#include <cstdint>

#include "scene/image/reply_type.h"

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

/// A picture of a file, with all of its channels as they stand.
struct OiioPicture {
    int32_t x, y, width, height;
    int32_t display_x, display_y, display_width, display_height;
    uint32_t level;  // of a mip map
    uint32_t channels;
    ReplyType type;            // halves come as floats
    const char* format;        // of the file: "png"
    const char* const* names;  // of the channels
};

/// Callbacks of whoever reads all of a file. Every function gets `self`; what is given is copied before it returns.
struct OiioStoredHost {
    void* self;
    uint64_t left;  // bytes that all values may take
    /// Announces the next picture. False: the host refuses and knows the reason; the module returns.
    bool (*picture)(void* self, const OiioPicture* picture) noexcept;
    /// Says what the picture's header says.
    void (*attribute)(void* self, const char* name, const char* type, const char* text) noexcept;
    /// Takes the values of the next `texels` texels of the picture.
    void (*samples)(void* self, const void* from, size_t texels) noexcept;
    /// Reports why the call fails, without the file's name.
    void (*failed)(void* self, const char* reason) noexcept;
};

/// A view of an OpenColorIO config, ready to be applied; the module's.
struct OiioView;

/// Callbacks of whoever opens a view. Every function gets `self`; texts are copied before it returns.
struct OiioViewHost {
    void* self;
    /// Names a view that the config has.
    void (*view)(void* self, const char* name) noexcept;
    /// Reports why the config or the view cannot be used.
    void (*failed)(void* self, const char* reason) noexcept;
};

/// Functions of the module.
struct OiioModule {
    /// Reads a picture. Colors as stored, not multiplied by alpha: three channels, or one where the file has fewer than
    /// three. True on success; otherwise `failed` was called, or `begin` refused.
    bool (*read)(const char* path, const OiioHost* host) noexcept;

    /// Reads all of a file: its pictures, their levels, channels and attributes, as they stand. True on success;
    /// otherwise `failed` was called, or `picture` refused.
    bool (*read_stored)(const char* path, const OiioStoredHost* host) noexcept;

    /// Opens a view of the config in a file, or, where `config` is empty, of the one that is part of OpenColorIO (2.2
    /// and later). A view of the default display goes by its name, others by "VIEW (DISPLAY)". All names go to `view`.
    /// Null: `failed` was called, or, where it was not, there is no view of that name.
    OiioView* (*open_view)(const char* config, const char* name, const OiioViewHost* host) noexcept;

    /// The color space of the config that linear Rec. 709 is taken for though the config does not say so; null where it
    /// does.
    const char* (*assumed_space)(const OiioView* view) noexcept;

    /// Turns linear Rec. 709 into the codes of the view's display, 0 to 1: `count` triples. Any thread. False where
    /// that fails, for want of memory for instance.
    bool (*apply_view)(const OiioView* view, float* rgb, size_t count) noexcept;

    void (*close_view)(OiioView* view) noexcept;
};

/// The one function that the module exports. Its number changes whenever this header does.
using OiioModuleEntry = const OiioModule* (*)();
inline constexpr const char* oiio_module_entry = "cistula_oiio_module_7";

}  // namespace cistula
