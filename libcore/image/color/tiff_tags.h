// Numbers in picture files, and tags of TIFF files (6.0, and BigTIFF). Private to image/.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

namespace cistula {

/// The number in `size` bytes from `at` on, at most 4; bytes beyond the end count as 0.
inline uint32_t big_endian(std::string_view bytes, size_t at, size_t size = 4) {
    uint32_t number = 0;
    for (size_t i = at; i < at + size; ++i)
        number = number << 8 | (i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0u);
    return number;
}

/// Reads a file's numbers in its own order of bytes; what lies beyond the end is 0.
class FileNumbers {
  public:
    FileNumbers(std::istream& file, bool little) : file_(file), little_(little) {}

    uint64_t at(uint64_t place, int size) const {
        const std::string bytes = text(place, static_cast<size_t>(size));
        uint64_t number = 0;
        for (size_t i = 0; i < bytes.size(); ++i)
            number = number << 8 | static_cast<unsigned char>(bytes[little_ ? bytes.size() - 1 - i : i]);
        return number;
    }

    /// That many bytes; those beyond the end are 0.
    std::string text(uint64_t place, size_t size) const {
        std::string bytes(size, '\0');
        if (place > uint64_t{1} << 62) return bytes;
        file_.clear();
        file_.seekg(static_cast<std::streamoff>(place));
        file_.read(bytes.data(), static_cast<std::streamsize>(size));
        return bytes;
    }

  private:
    std::istream& file_;
    bool little_;
};

/// A tag of the first picture.
struct TiffTag {
    uint64_t type, count;  // of its values
    uint64_t size;         // bytes of a value
    uint64_t values;       // place of the first

    static constexpr uint64_t rational = 5;
    static constexpr uint64_t single = 11;
};

/// None: the picture does not have that tag. `file` reads in the file's order of bytes.
inline std::optional<TiffTag> find_tiff_tag(const FileNumbers& file, uint64_t tag) {
    constexpr uint64_t most_entries = 4096;
    constexpr uint64_t sizes[] = {8, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4};  // by type; later types have 8
    const bool is_big = file.at(2, 2) == 43;
    const uint64_t directory = is_big ? file.at(8, 8) : file.at(4, 4);
    const uint64_t entries = file.at(directory, is_big ? 8 : 2);
    for (uint64_t i = 0; i < std::min(entries, most_entries); ++i) {
        const uint64_t entry = directory + (is_big ? 8 + 20 * i : 2 + 12 * i);
        if (file.at(entry, 2) != tag) continue;
        TiffTag found = {file.at(entry + 2, 2), file.at(entry + 4, is_big ? 8 : 4), 8, entry + (is_big ? 12 : 8)};
        if (found.type < std::size(sizes)) found.size = sizes[found.type];
        const int room = is_big ? 8 : 4;  // for values that are not elsewhere
        if (found.count > static_cast<uint64_t>(room) / found.size) found.values = file.at(found.values, room);
        return found;
    }
    return std::nullopt;
}

}  // namespace cistula
