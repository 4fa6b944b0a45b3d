// What is in a PNG, as libpng reads it.
#pragma once

#include <png.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace cistula {

/// The sRGB codes of a PNG, row-major from the top left.
struct PngPixels {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> bytes;  // red, green, blue, and alpha if the file has it

    std::array<int, 3> at(uint32_t x, uint32_t y) const {
        const uint8_t* pixel = &bytes.at(3 * (y * width + x));
        return {pixel[0], pixel[1], pixel[2]};
    }
};

inline PngPixels png_pixels(const std::string& png) {
    png_image image = {};
    image.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_memory(&image, png.data(), png.size())) throw std::runtime_error(image.message);
    image.format = (image.format & PNG_FORMAT_FLAG_ALPHA) != 0 ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
    PngPixels pixels{image.width, image.height, std::vector<uint8_t>(PNG_IMAGE_SIZE(image))};
    if (!png_image_finish_read(&image, nullptr, pixels.bytes.data(), 0, nullptr))
        throw std::runtime_error(image.message);
    return pixels;
}

}  // namespace cistula
