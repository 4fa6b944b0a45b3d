#include "scene/image/srgb_codes.h"

#include <algorithm>
#include <array>
#include <vector>

#include "cistula/numerics/elementary.h"

namespace cistula {
namespace {

template <class Table>
Table linear_table(Table table) {
    const double largest = static_cast<double>(table.size() - 1);
    for (size_t i = 0; i < table.size(); ++i)
        table[i] = static_cast<float>(elementary::srgb_to_linear(static_cast<double>(i) / largest));
    return table;
}

}  // namespace

float linear_from_srgb8(uint8_t code) {
    static const auto table = linear_table(std::array<float, 256>());
    return table[code];
}

float linear_from_srgb16(uint16_t code) {
    static const auto table = linear_table(std::vector<float>(65536));
    return table[code];
}

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

}  // namespace cistula
