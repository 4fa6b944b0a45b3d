#include "image/color/srgb_codes.h"

#include <algorithm>
#include <array>

#include "cistula/numerics/elementary.h"

namespace cistula {

uint8_t srgb8_from_linear(float linear) {
    // Entry i is the lowest linear value of code i + 1, that of i + 1/2. A search is exact and needs no power per
    // pixel.
    static const std::array<double, 255> starts = [] {
        std::array<double, 255> table;
        for (int i = 0; i < 255; ++i) table[i] = elementary::srgb_to_linear((i + 0.5) / 255.0);
        return table;
    }();
    if (!(linear > 0)) return 0;
    const auto above = std::upper_bound(starts.begin(), starts.end(), static_cast<double>(linear));
    return static_cast<uint8_t>(above - starts.begin());
}

float srgb8_to_linear(uint8_t code) {
    static const std::array<float, 256> values = [] {
        std::array<float, 256> table;
        for (size_t i = 0; i < 256; ++i)
            table[i] = static_cast<float>(elementary::srgb_to_linear(static_cast<double>(i) / 255.0));
        return table;
    }();
    return values[code];
}

}  // namespace cistula
