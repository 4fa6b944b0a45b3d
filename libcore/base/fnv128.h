// 128-bit FNV-1a, for hashes of films, scenes and cameras.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

#include "cistula/numerics/portable.h"

namespace cistula {

/// A 128-bit FNV-1a hash with the published constants (offset basis 0x6c62272e07bb0142 62b821756295c58d, prime 2^88 +
/// 0x13b). Numbers enter as their bytes, lowest first; floating-point numbers as their bits, so -0 is not 0.
class Fnv128 {
  public:
    void add_bytes(const void* data, size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (size_t i = 0; i < size; ++i) add_byte(bytes[i]);
    }
    template <std::integral T>
    void add(T value) {
        auto bits = static_cast<uint64_t>(static_cast<std::make_unsigned_t<T>>(value));
        size_t i = 0;
        for (; bits != 0; ++i, bits >>= 8) add_byte(static_cast<unsigned char>(bits));
        if (i < sizeof(T)) state_ *= powers[sizeof(T) - i];  // the zeros above
    }
    void add(float value) { add(bits_as<uint32_t>(value)); }
    void add(double value) { add(bits_as<uint64_t>(value)); }

    /// The hash as 32 lower-case hexadecimal digits.
    std::string hex() const {
        std::string text;
        for (int shift = 124; shift >= 0; shift -= 4)
            text += "0123456789abcdef"[static_cast<int>(state_ >> shift) & 15];
        return text;
    }

  private:
    __extension__ typedef unsigned __int128 Wide;
    static constexpr Wide prime = (static_cast<Wide>(1) << 88) + 0x13b;

    /// The prime to the power of 0 to 8: what as many zeros do.
    static constexpr std::array<Wide, 9> powers = [] {
        std::array<Wide, 9> all{1};
        for (size_t i = 1; i < all.size(); ++i) all[i] = all[i - 1] * prime;
        return all;
    }();

    void add_byte(unsigned char byte) { state_ = (state_ ^ byte) * prime; }

    Wide state_ = (static_cast<Wide>(0x6c62272e07bb0142u) << 64) + 0x62b821756295c58du;
};

}  // namespace cistula
