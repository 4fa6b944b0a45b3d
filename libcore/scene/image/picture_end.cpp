#include "scene/image/picture_end.h"

#include <algorithm>
#include <bitset>
#include <cstdint>
#include <fstream>

namespace cistula {
namespace {

/// Whether a JPEG file has the marker of its end. Segments are skipped, since they may hold whole pictures.
bool has_jpeg_end(std::ifstream& file) {
    constexpr int end = 0xd9, first_restart = 0xd0, start = 0xd8, stuffed = 0x00, temporary = 0x01;
    for (int byte = file.get(); file; byte = file.get()) {
        if (byte != 0xff) continue;
        while (byte == 0xff) byte = file.get();
        if (byte == end) return true;
        if (byte == stuffed || byte == temporary || (byte >= first_restart && byte <= start)) continue;
        const int high = file.get(), low = file.get();
        if (file) file.seekg(std::max(high * 256 + low - 2, 0), std::ios::cur);
    }
    return false;
}

std::string missing_in_jpeg(std::ifstream& file) {
    return has_jpeg_end(file) ? "" : "it is cut off: a JPEG file ends with a marker, and this one does not";
}

/// What a DDS file's header says of its size; a stored picture has at least that many bytes.
std::string missing_in_dds(std::ifstream& file, uint64_t size) {
    char header[148] = {};
    file.read(header, sizeof header);
    const auto number = [&](int at) {
        uint32_t value = 0;
        for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<uint8_t>(header[at + i]);
        return static_cast<uint64_t>(value);
    };
    const uint64_t height = number(12), width = number(16), dxgi = number(128);
    const std::string_view code(header + 84, 4);
    const bool compressed = (number(80) & 4) != 0, extended = compressed && code == "DX10";
    const bool small_blocks = code == "DXT1" || code == "ATI1" || code == "BC4U" || code == "BC4S" ||
                              (extended && ((dxgi >= 70 && dxgi <= 72) || (dxgi >= 79 && dxgi <= 81)));
    const bool cube = (number(112) & 0x200) != 0;
    const uint64_t faces = cube ? std::bitset<32>(number(112) & 0xfc00).count() : 1;
    const uint64_t picture = compressed ? (width + 3) / 4 * ((height + 3) / 4) * (small_blocks ? 8 : 16)
                                        : width * height * std::max<uint64_t>((number(88) + 7) / 8, 1);
    const uint64_t needed = (extended ? 148 : 128) + faces * picture;
    if (size >= needed) return "";
    return "it is cut off: it has " + std::to_string(size) + " bytes, and its header says " + std::to_string(needed);
}

}  // namespace

std::string missing_end(std::string_view format, const std::string& path) {
    if (format != "jpeg" && format != "dds") return "";
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    const auto size = static_cast<uint64_t>(std::max<std::streamoff>(file.tellg(), 0));
    file.seekg(0);
    return format == "jpeg" ? missing_in_jpeg(file) : missing_in_dds(file, size);
}

}  // namespace cistula
