// Small files that claim to be large pictures, or unfold to much.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <stdexcept>
#include <string>

#include "testing/support/byte_order.h"

namespace cistula::bombs {

using test::big_endian;
using test::little_endian;

/// A zlib stream of so many zeros: a block that unfolds to a mebibyte, over and over.
inline std::string zeros(uint64_t count) {
    const auto deflated = [](size_t size, int flush) {
        z_stream stream = {};
        if (deflateInit2(&stream, 9, Z_DEFLATED, -15, 9, Z_DEFAULT_STRATEGY) != Z_OK) throw std::runtime_error("zlib");
        std::string in(size, '\0'), out(size / 64 + 100, '\0');
        stream.next_in = reinterpret_cast<Bytef*>(in.data());
        stream.avail_in = static_cast<uInt>(in.size());
        stream.next_out = reinterpret_cast<Bytef*>(out.data());
        stream.avail_out = static_cast<uInt>(out.size());
        deflate(&stream, flush);
        out.resize(stream.total_out);
        deflateEnd(&stream);
        return out;
    };
    const std::string block = deflated(1 << 20, Z_FULL_FLUSH);
    std::string stream = "\x78\xda";
    for (uint64_t i = 0; i < count >> 20; ++i) stream += block;
    stream += deflated(count & 0xfffff, Z_FINISH);
    return stream + big_endian(count % 65521 << 16 | 1, 4);  // Adler-32
}

inline std::string png_chunk(const std::string& type, const std::string& data) {
    const std::string body = type + data;
    const uint64_t sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    return big_endian(data.size(), 4) + body + big_endian(sum, 4);
}

/// RGB of 8 bits.
inline std::string png(uint32_t width, uint32_t height, const std::string& deflated, const std::string& chunks = "") {
    return "\x89PNG\r\n\x1a\n" +
           png_chunk("IHDR", big_endian(width, 4) + big_endian(height, 4) + std::string("\x08\x02\0\0\0", 5)) + chunks +
           png_chunk("IDAT", deflated) + png_chunk("IEND", "");
}

/// Without pixels, as all below.
inline std::string bmp(uint32_t width, uint32_t height) {
    return "BM" + little_endian(54, 4) + little_endian(0, 4) + little_endian(54, 4) + little_endian(40, 4) +
           little_endian(width, 4) + little_endian(height, 4) + little_endian(1, 2) + little_endian(24, 2) +
           std::string(24, '\0');
}

/// type: 2 true color, 10 the same with run lengths.
inline std::string tga(uint32_t width, uint32_t height, int type) {
    return little_endian(0, 2) + little_endian(static_cast<uint64_t>(type), 1) + std::string(9, '\0') +
           little_endian(width, 2) + little_endian(height, 2) + little_endian(24, 1) + std::string(64, '\0');
}

inline std::string hdr(uint32_t width, uint32_t height) {
    return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) +
           "\n\x02\x02";
}

inline std::string jpeg(uint32_t width, uint32_t height) {
    const std::string tables =
        big_endian(0xffdb, 2) + big_endian(67, 2) + std::string(1, '\0') + std::string(64, '\x01');
    const std::string frame = big_endian(0xffc0, 2) + big_endian(11, 2) + big_endian(8, 1) + big_endian(height, 2) +
                              big_endian(width, 2) + std::string("\x01\x01\x11\0", 4);
    const std::string dc = big_endian(0xffc4, 2) + big_endian(20, 2) + std::string("\0\x01", 2) + std::string(16, '\0'),
                      ac = big_endian(0xffc4, 2) + big_endian(20, 2) + std::string("\x10\x01", 2) +
                           std::string(16, '\0');
    return big_endian(0xffd8, 2) + tables + frame + dc + ac + big_endian(0xffda, 2) + big_endian(8, 2) +
           std::string("\x01\x01\0\0\x3f\0", 6) + std::string(8, '\0');
}

/// RGB of 24 bits, the green ones in this mask, or blocks of a four-letter code.
inline std::string dds(uint32_t width, uint32_t height, const std::string& code = "", uint32_t green = 0xff00) {
    const std::string format = little_endian(32, 4) + little_endian(code.empty() ? 0x40 : 4, 4) +
                               (code.empty() ? std::string(4, '\0') : code) + little_endian(code.empty() ? 24 : 0, 4) +
                               little_endian(0xff0000, 4) + little_endian(green, 4) + little_endian(0xff, 4) +
                               little_endian(0, 4);
    return "DDS " + little_endian(124, 4) + little_endian(0x1007, 4) + little_endian(height, 4) +
           little_endian(width, 4) + std::string(56, '\0') + format + little_endian(0x1000, 4) + std::string(16, '\0');
}

}  // namespace cistula::bombs
