#include "image/picture/picture_io.h"

#include <png.h>

#include <cerrno>
#include <cmath>
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

std::string encode_png(const ColorPicture& linear) {
    const bool opaque = linear.alpha.empty();
    std::vector<uint8_t> pixels;
    pixels.reserve(4 * linear.texels.size());
    for (size_t i = 0; i < linear.texels.size(); ++i) {
        for (int c = 0; c < 3; ++c) pixels.push_back(srgb8_from_linear(linear.texels[i][c]));
        if (!opaque) pixels.push_back(static_cast<uint8_t>(std::lround(255 * linear.alpha[i])));
    }
    png_image image = {};
    image.version = PNG_IMAGE_VERSION;
    image.width = linear.width;
    image.height = linear.height;
    image.format = opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
    std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
    png_alloc_size_t size = bytes.size();
    errno = 0;
    if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr)) {
        if (errno == ENOMEM) throw std::bad_alloc();
        throw std::runtime_error(std::string("libpng: ") + image.message);
    }
    bytes.resize(size);
    return bytes;
}

}  // namespace cistula
