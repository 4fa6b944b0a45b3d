// Numbers in files, highest byte first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace cistula {

/// The number in `size` bytes from `at` on, at most 4; bytes beyond the end count as 0.
inline uint32_t big_endian(std::string_view bytes, size_t at, size_t size = 4) {
    uint32_t number = 0;
    for (size_t i = at; i < at + size; ++i)
        number = number << 8 | (i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0u);
    return number;
}

}  // namespace cistula
