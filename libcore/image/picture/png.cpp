#include "image/picture/png.h"

#include <png.h>

#include <cerrno>
#include <new>
#include <stdexcept>

#include "image/color/srgb_codes.h"

namespace cistula {
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
    const bool opaque = linear.alpha.empty();
    std::vector<uint8_t> pixels;
    pixels.reserve(4 * linear.texels.size());
    for (size_t i = 0; i < linear.texels.size(); ++i) {
        for (int c = 0; c < 3; ++c) pixels.push_back(srgb8_from_linear(linear.texels[i][c]));
        if (!opaque) pixels.push_back(static_cast<uint8_t>(255 * linear.alpha[i] + 0.5f));
    }
    return encode(linear.width, linear.height, opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA, pixels, {});
}

std::string encode_indexed_png(uint32_t width, uint32_t height, const std::vector<uint8_t>& pixels,
                               const std::vector<uint8_t>& colors) {
    return encode(width, height, PNG_FORMAT_RGB_COLORMAP, pixels, colors);
}

}  // namespace cistula
