#include "image.h"

#include <algorithm>
#include <cmath>

#include "compare/page/page_parts.h"
#include "image/picture/picture_io.h"

namespace cistula::report {
namespace {

Image image_of(uint32_t width, uint32_t height, const std::string& png) {
    return {static_cast<int>(width), static_cast<int>(height), base64(png)};
}

}  // namespace

Image to_image(const ColorPicture& linear) {
    return image_of(linear.width, linear.height, encode_png(linear));
}

std::array<uint8_t, 3> heat_color(double place) {
    // Night blue, violet, red, orange, pale yellow, with evenly increasing lightness.
    static constexpr double stops[][3] = {{10, 12, 40}, {84, 20, 110}, {186, 54, 85}, {249, 142, 9}, {252, 253, 191}};
    const double at = std::clamp(place, 0.0, 1.0) * 4;
    const int low = std::min(static_cast<int>(at), 3);
    std::array<uint8_t, 3> color{};
    for (size_t c = 0; c < 3; ++c)
        color[c] = static_cast<uint8_t>(std::lround(stops[low][c] + (at - low) * (stops[low + 1][c] - stops[low][c])));
    return color;
}

Image to_heat_image(int width, int height, const std::vector<double>& values) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const double low = std::log(std::max(*least, 1.0)), high = std::log(std::max(*most, 1.0));
    constexpr int shades = 64;  // few, to keep the file small
    std::vector<uint8_t> colors, pixels;
    for (int i = 0; i < shades; ++i)
        for (const uint8_t c : heat_color(static_cast<double>(i) / (shades - 1))) colors.push_back(c);
    pixels.reserve(values.size());
    for (const double value : values) {
        const double place = high > low ? (std::log(std::max(value, 1.0)) - low) / (high - low) : 0;
        pixels.push_back(static_cast<uint8_t>(std::lround(place * (shades - 1))));
    }
    const uint32_t columns = static_cast<uint32_t>(width), rows = static_cast<uint32_t>(height);
    return image_of(columns, rows, encode_indexed_png(columns, rows, pixels, colors));
}

}  // namespace cistula::report
