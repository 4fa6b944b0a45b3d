#include "image/reader/oiio_module.h"

#include <algorithm>
#include <bitset>
#include <cstdint>
#include <fstream>
#include <optional>

#include "base/shown_text.h"
#include "image/color/tiff_tags.h"

namespace cistula {
namespace {

/// Whether a JPEG file has the marker of its end. Segments are skipped, since they may hold whole pictures.
bool has_jpeg_end(std::ifstream& file) {
    constexpr int end = 0xd9;
    constexpr int first_restart = 0xd0;
    constexpr int start = 0xd8;
    constexpr int stuffed = 0x00;
    constexpr int temporary = 0x01;
    for (int byte = file.get(); file; byte = file.get()) {
        if (byte != 0xff) continue;
        while (byte == 0xff) byte = file.get();
        if (byte == end) return true;
        if (byte == stuffed || byte == temporary || (byte >= first_restart && byte <= start)) continue;
        const int high = file.get();
        const int low = file.get();
        if (file) file.seekg(std::max(high * 256 + low - 2, 0), std::ios::cur);
    }
    return false;
}

std::string jpeg_damage(std::ifstream& file) {
    return has_jpeg_end(file) ? "" : "it is cut off: a JPEG file ends with a marker, and this one does not";
}

/// The header of a DDS file.
class DdsHeader {
  public:
    explicit DdsHeader(std::ifstream& file) { file.read(bytes_, sizeof bytes_); }

    /// Bytes that the file has at least, which hold the largest picture of each face.
    uint64_t least_size() const {
        const uint64_t height = number(12);
        const uint64_t width = number(16);
        const uint64_t faces = (number(112) & 0x200) != 0 ? std::bitset<32>(number(112) & 0xfc00).count() : 1;
        const uint64_t picture = is_compressed() ? (width + 3) / 4 * ((height + 3) / 4) * (has_small_blocks() ? 8 : 16)
                                                 : width * height * std::max<uint64_t>((number(88) + 7) / 8, 1);
        return (is_extended() ? 148 : 128) + faces * picture;
    }

    /// How many levels of a mip map the file says that it has.
    uint64_t levels() const { return (number(8) & 0x20000) != 0 ? number(28) : 1; }

    /// Whether a channel that the pixels have is given no bits of them.
    bool has_empty_channel() const {
        const uint64_t flags = number(80);
        const bool alpha = (flags & 0x3) != 0;
        const bool rgb = (flags & 0x40) != 0;
        const bool luminance = (flags & 0x20000) != 0;
        return !is_compressed() && ((alpha && number(104) == 0) || ((rgb || luminance) && number(92) == 0) ||
                                    (rgb && (number(96) == 0 || number(100) == 0)));
    }

  private:
    uint64_t number(int at) const {
        uint32_t value = 0;
        for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<uint8_t>(bytes_[at + i]);
        return value;
    }
    std::string_view code() const { return {bytes_ + 84, 4}; }
    bool is_compressed() const { return (number(80) & 4) != 0; }
    bool is_extended() const { return is_compressed() && code() == "DX10"; }
    bool has_small_blocks() const {
        const uint64_t kind = is_extended() ? number(128) : 0;
        return code() == "DXT1" || code() == "ATI1" || code() == "BC4U" || code() == "BC4S" ||
               (kind >= 70 && kind <= 72) || (kind >= 79 && kind <= 81);
    }

    char bytes_[148] = {};
};

std::string dds_damage(std::ifstream& file, uint64_t size) {
    const DdsHeader header(file);
    if (header.has_empty_channel()) return "its header gives a channel no bits: a mask is 0";
    constexpr uint64_t most_levels = 32;  // OpenImageIO 2.4 goes over as many as the header says, whatever the size
    if (header.levels() > most_levels)
        return "its header says that it has " + std::to_string(header.levels()) + " levels of a mip map";
    const uint64_t needed = header.least_size();
    if (size >= needed) return "";
    return "it is cut off: it has " + std::to_string(size) + " bytes, and its header says " + std::to_string(needed);
}

/// The first number of a tag of a TIFF file, without a sign.
std::optional<uint64_t> tiff_number(const FileNumbers& file, uint64_t tag) {
    const std::optional<TiffTag> found = find_tiff_tag(file, tag);
    return found ? std::optional(file.at(found->values, static_cast<int>(found->size))) : std::nullopt;
}

std::string tiff_damage(std::ifstream& file) {
    constexpr uint64_t bits_tag = 258;
    constexpr uint64_t photometric_tag = 262;
    constexpr uint64_t white_is_zero = 0;
    const FileNumbers numbers(file, file.get() == 'I');
    const std::optional<uint64_t> bits = tiff_number(numbers, bits_tag);
    if (!bits)
        return "it has no tag BitsPerSample, and so 1 bit a sample, and would be read as if it had 8; save it with the "
               "tag, or as PNG";
    if (*bits > 8 && tiff_number(numbers, photometric_tag) == white_is_zero)
        return "its samples have " + std::to_string(*bits) +
               " bits, and 0 is white (WhiteIsZero), which would be read as black; save it with 0 as black, or as PNG";
    return "";
}

std::string radiance_damage(std::ifstream& file) {
    std::string line;
    while (std::getline(file, line) && !line.empty()) {
    }
    if (!std::getline(file, line)) return "";
    if (line.starts_with("-Y ") && line.find(" +X ") != line.npos) return "";
    return "its resolution line is " + quoted(line) +
           ", and it would be read as '-Y HEIGHT +X WIDTH', from the top left; save it so, or as EXR";
}

}  // namespace

std::string picture_damage(std::string_view format, const std::string& path) {
    if (format != "jpeg" && format != "dds" && format != "tiff" && format != "hdr") return "";
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    const auto size = static_cast<uint64_t>(std::max<std::streamoff>(file.tellg(), 0));
    file.seekg(0);
    if (format == "tiff") return tiff_damage(file);
    if (format == "hdr") return radiance_damage(file);
    return format == "jpeg" ? jpeg_damage(file) : dds_damage(file, size);
}

}  // namespace cistula
