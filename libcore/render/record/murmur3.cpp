#include "render/record/murmur3.h"

#include <bit>
#include <cstddef>

namespace cistula {
namespace {

constexpr uint32_t first_factor = 0xcc9e2d51u, second_factor = 0x1b873593u;

uint32_t mixed(uint32_t word) {
    return std::rotl(word * first_factor, 15) * second_factor;
}

}  // namespace

uint32_t murmur3(std::string_view text) {
    const auto byte = [&](size_t i) { return uint32_t{static_cast<unsigned char>(text[i])}; };
    uint32_t hash = 0;
    const size_t whole = text.size() / 4 * 4;
    for (size_t i = 0; i < whole; i += 4) {
        hash ^= mixed(byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24);
        hash = std::rotl(hash, 13) * 5 + 0xe6546b64u;
    }
    uint32_t rest = 0;
    for (size_t i = text.size(); i-- > whole;) rest = rest << 8 | byte(i);
    hash ^= mixed(rest);
    hash ^= static_cast<uint32_t>(text.size());
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

float cryptomatte_id(std::string_view name) {
    uint32_t bits = murmur3(name);
    const uint32_t exponent = bits >> 23 & 255u;
    if (exponent == 0 || exponent == 255) bits ^= 1u << 23;
    return std::bit_cast<float>(bits);
}

}  // namespace cistula
