// Numbers as bytes, in either order.
#pragma once

#include <cstdint>
#include <string>

namespace cistula::test {

inline std::string little_endian(uint64_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i);
    return text;
}

inline std::string big_endian(uint64_t value, int bytes) {
    const std::string text = little_endian(value, bytes);
    return {text.rbegin(), text.rend()};
}

}  // namespace cistula::test
