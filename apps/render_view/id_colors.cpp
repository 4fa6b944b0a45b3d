#include "id_colors.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "image/color/srgb_codes.h"

namespace cistula {

glm::vec3 id_color(uint32_t id) {
    if (id == 0) return glm::vec3(0);
    constexpr uint32_t golden = 2654435769;  // 2^32 / the golden ratio: multiples of it spread evenly
    const double hue = static_cast<double>(id * golden) * 0x1p-32 * 6;
    constexpr struct {
        int low, high;  // sRGB codes of the weakest and the strongest channel
    } degrees[] = {{30, 235}, {120, 255}, {0, 150}, {85, 190}};
    const auto& [low, high] = degrees[(id ^ id >> 8 ^ id >> 16 ^ id >> 24) % 4];
    glm::vec3 color;
    for (int c = 0; c < 3; ++c) {
        const double around =
            std::abs(std::fmod(hue + 6 - 2 * c, 6) - 3);  // from 0, opposite to the channel's hue, to 3
        const double share = std::clamp(around - 1, 0.0, 1.0);
        color[c] = srgb8_to_linear(static_cast<uint8_t>(low + std::lround(share * (high - low))));
    }
    return color;
}

uint32_t id_of(float value) {
    if (value >= 0 && value < 0x1p32f && std::floor(value) == value) return static_cast<uint32_t>(value);
    return std::bit_cast<uint32_t>(value);
}

}  // namespace cistula
