// Whole numbers in files of either order of bytes. Private to image/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>

namespace cistula {

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

}  // namespace cistula
