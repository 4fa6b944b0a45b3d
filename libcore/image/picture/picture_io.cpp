#include "image/picture/picture_io.h"

#include <png.h>

#include <cerrno>
#include <new>
#include <stdexcept>
#include <string>

#include "base/atomic_file.h"
#include "base/file_bytes.h"
#include "image/color/srgb_codes.h"
#include "image/reader/picture_reader.h"

namespace cistula {

ColorPicture read_texture(const std::string& path, std::string_view encoding) {
    return TextureReader().read(path, nullptr, encoding);
}

void write_preview(const std::string& path, const ColorPicture& linear) {
    if (linear.width == 0 || linear.texels.size() != static_cast<size_t>(linear.width) * linear.height)
        throw std::invalid_argument("write_preview: texels must number width * height, and be some");
    if (lower_extension(path) != ".png")
        throw file_error(path, "write", std::string("a preview is a PNG"), "give a name that ends in .png");
    std::string bytes;
    try {
        bytes = encode_png(linear);
    } catch (const std::runtime_error& error) {
        throw file_error(path, "write", std::string(error.what()));
    }
    write_file_atomically(path, bytes);
}

namespace {

/// Encodes a PNG. `format`: an 8-bit format of libpng; `colors`: the color map of an indexed one.
std::string encode(uint32_t width, uint32_t height, uint32_t format, const std::vector<uint8_t>& pixels,
                   const std::vector<uint8_t>& colors) {
    png_image image = {};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = format;
    image.colormap_entries = static_cast<png_uint_32>(colors.size() / 3);
    const void* map = colors.empty() ? nullptr : colors.data();
    std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
    png_alloc_size_t size = bytes.size();
    errno = 0;
    if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, map)) {
        if (errno == ENOMEM) throw std::bad_alloc();
        throw std::runtime_error(std::string("libpng: ") + image.message);
    }
    bytes.resize(size);
    return bytes;
}

}  // namespace

std::string encode_png(const ColorPicture& linear) {
    std::vector<uint8_t> pixels;
    pixels.reserve(3 * linear.texels.size());
    for (const glm::vec3& texel : linear.texels)
        for (int c = 0; c < 3; ++c) pixels.push_back(srgb8_from_linear(texel[c]));
    return encode(linear.width, linear.height, PNG_FORMAT_RGB, pixels, {});
}

std::string encode_indexed_png(uint32_t width, uint32_t height, const std::vector<uint8_t>& pixels,
                               const std::vector<uint8_t>& colors) {
    return encode(width, height, PNG_FORMAT_RGB_COLORMAP, pixels, colors);
}

}  // namespace cistula
