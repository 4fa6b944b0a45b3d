// Interface of the module for OpenImageIO, which programs load when a picture or a view needs it. Plain C types, so
// that each side frees what it allocated and no exception crosses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "image/picture/stored_picture.h"

namespace cistula {

/// A picture of a file.
struct OiioPicture {
    int32_t x, y, width, height;
    int32_t display_x, display_y, display_width, display_height;
    uint32_t level;  // of a mip map
    uint32_t channels;
    StoredType type;           // halves come as floats
    const char* format;        // of the file: "png"
    const char* const* names;  // of the channels
};

/// Callbacks of whoever reads a file. Every function gets `self`; what is given is copied before it returns.
struct OiioHost {
    void* self;
    bool is_texture;  // what is wanted are colors: of the first picture three channels, or one where it has fewer than
                      // three, as uint8, uint16 or float; otherwise all of the file as it stands
    uint64_t left;    // bytes that its texels, 12 each, or its values may take
    /// Announces the next picture. False: the host refuses and knows the reason; the module returns.
    bool (*picture)(void* self, const OiioPicture* picture) noexcept;
    /// Says which ICC profile a texture has.
    void (*profile)(void* self, const void* bytes, size_t count) noexcept;
    /// Says what the picture's header says, unless it is a texture.
    void (*attribute)(void* self, const char* name, const char* type, const char* text) noexcept;
    /// Takes the next `texels` texels of the picture, row-major from the top left.
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
    /// Reads a file; colors as stored, not multiplied by alpha. True on success; otherwise `failed` was called, or
    /// `picture` refused.
    bool (*read)(const char* path, const OiioHost* host) noexcept;

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
inline constexpr const char* oiio_module_entry = "cistula_oiio_module_8";

/// The module's functions. It is loaded from that directory at the first call, and stays loaded. Throws
/// std::runtime_error with what needs it, `users`, where it cannot be loaded, and where the build has none
/// (CISTULA_WITH_OIIO=OFF); std::bad_alloc where `ulimit -v` leaves too little for it.
const OiioModule& load_oiio(const std::filesystem::path& directory, const std::string& users);

// What the module is made of.

/// What is wrong with a file that OpenImageIO has opened as `format`, which decoders get wrong without a word, for a
/// message. JPEG, DDS: it is cut off, where decoders make up the rest, or its header would have them decode without
/// end. TIFF, Radiance: it is of a kind that OpenImageIO 2.4 reads as another. Empty for other formats.
std::string picture_damage(std::string_view format, const std::string& path);

/// The functions of OiioModule of these names.
OiioView* open_view(const char* config, const char* name, const OiioViewHost* host) noexcept;
const char* assumed_space(const OiioView* view) noexcept;
bool apply_view(const OiioView* view, float* rgb, size_t count) noexcept;
void close_view(OiioView* view) noexcept;

}  // namespace cistula
