#include "scene/image/raw_picture.h"

#include <cstdint>
#include <stdexcept>

#include "scene/base/atomic_file.h"
#include "scene/image/srgb_codes.h"

namespace cistula {
namespace {

constexpr size_t header_size = 8;

uint32_t little_endian(const std::string& bytes, size_t at) {
    uint32_t value = 0;
    for (size_t i = 0; i < 4; ++i) value |= static_cast<uint32_t>(static_cast<uint8_t>(bytes[at + i])) << (8 * i);
    return value;
}

void append_little_endian(std::string& bytes, uint32_t value) {
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 255u);
}

}  // namespace

ColorPicture read_raw_picture(const std::string& path) {
    const std::string bytes = read_file(path);
    if (bytes.size() < header_size)
        throw file_error(path, "read",
                         "it has " + std::to_string(bytes.size()) +
                             " bytes; a .data file begins with 8, its width and height as two 32-bit integers");
    const int64_t width = static_cast<int32_t>(little_endian(bytes, 0));
    const int64_t height = static_cast<int32_t>(little_endian(bytes, 4));
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    if (width < 1 || height < 1 || width > largest_picture_side || height > largest_picture_side)
        throw file_error(path, "read",
                         "its size is " + size + "; width and height of a .data file are 1 to " +
                             std::to_string(largest_picture_side));
    const uint64_t expected = header_size + 4 * static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
    if (bytes.size() != expected)
        throw file_error(path, "read",
                         "it has " + std::to_string(bytes.size()) + " bytes, which is too " +
                             (bytes.size() < expected ? "few" : "many") + "; a .data file of " + size + " texels has " +
                             std::to_string(expected));

    ColorPicture picture;
    picture.width = static_cast<uint32_t>(width);
    picture.height = static_cast<uint32_t>(height);
    picture.texels.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
    const auto channel = [&](size_t at) { return linear_from_srgb8(static_cast<uint8_t>(bytes[at])); };
    for (size_t i = 0; i < picture.texels.size(); ++i) {
        const size_t at = header_size + 4 * i;
        picture.texels[i] = glm::vec3(channel(at), channel(at + 1), channel(at + 2));
    }
    return picture;
}

void write_raw_picture(const std::string& path, const ColorPicture& linear) {
    if (linear.texels.size() != static_cast<size_t>(linear.width) * linear.height)
        throw std::invalid_argument("write_seed_frame: texels must number width * height");
    std::string bytes;
    bytes.reserve(header_size + 4 * linear.texels.size());
    append_little_endian(bytes, linear.width);
    append_little_endian(bytes, linear.height);
    for (const glm::vec3& texel : linear.texels) {
        for (int c = 0; c < 3; ++c) bytes += static_cast<char>(srgb8_from_linear(texel[c]));
        bytes += static_cast<char>(255);
    }
    write_file_atomically(path, bytes);
}

}  // namespace cistula
