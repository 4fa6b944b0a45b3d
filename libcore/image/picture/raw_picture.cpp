#include "image/picture/raw_picture.h"

#include <cstdint>
#include <stdexcept>

#include "base/atomic_file.h"
#include "base/file_bytes.h"
#include "image/color/srgb_codes.h"
#include "image/color/texel_decoder.h"
#include "image/reader/texture_limits.h"

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

ColorPicture read_raw_picture(const std::string& path, uint64_t left, uint64_t limit, const FileEncoding& encoding) {
    const std::string header = read_file_start(path, header_size);
    if (header.size() < header_size)
        throw file_error(path, "read",
                         "it has " + std::to_string(header.size()) +
                             " bytes; a .data file begins with 8, its width and height as two 32-bit integers");
    const int64_t width = static_cast<int32_t>(little_endian(header, 0));
    const int64_t height = static_cast<int32_t>(little_endian(header, 4));
    const auto check = [&](const std::string& problem) {
        if (!problem.empty()) throw file_error(path, "read", problem);
    };
    check(texture_size_problem(width, height, no_texture_limit, no_texture_limit));
    const uint64_t expected = header_size + 4 * static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
    const auto check_size = [&](uint64_t size) {
        if (size == expected) return;
        throw file_error(path, "read",
                         "it has " + std::to_string(size) + " bytes, which is too " +
                             (size < expected ? "few" : "many") + "; a .data file of " + std::to_string(width) + "x" +
                             std::to_string(height) + " texels has " + std::to_string(expected));
    };
    check_size(regular_file_size(path));
    check(texture_size_problem(width, height, left, limit));
    const std::string bytes = read_file_start(path, expected);
    check_size(bytes.size());

    ColorPicture picture;
    picture.width = static_cast<uint32_t>(width);
    picture.height = static_cast<uint32_t>(height);
    picture.texels.reserve(static_cast<size_t>(width) * static_cast<size_t>(height));
    TexelDecoder(encoding, 1).append(std::string_view(bytes).substr(header_size), 4, picture.texels);
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
