#include "image/view/picture_view.h"

#include <algorithm>
#include <utility>

namespace cistula {
namespace {

/// The color's light above white. It is limited so that a sum that it leaves again keeps nothing of it.
glm::vec3 light_above_white(glm::vec3 color) {
    float most = 0;
    for (int c = 0; c < 3; ++c) {
        color[c] = color[c] > 0 ? std::min(color[c], 65504.0f) : 0;
        most = std::max(most, color[c]);
    }
    return most > 1 ? color * (1 - 1 / most) : glm::vec3(0);
}

/// The mean of the texels up to `radius` away along each row, with rows and columns exchanged; 0 outside.
ColorPicture box_mean_turned(const ColorPicture& from, uint32_t radius) {
    ColorPicture to{from.height, from.width, std::vector<glm::vec3>(from.texels.size())};
    const double share = 1 / (2.0 * radius + 1);
    for (size_t y = 0; y < from.height; ++y) {
        const glm::vec3* row = &from.texels[y * from.width];
        double sum[3] = {};
        const auto add = [&](const glm::vec3& texel, double sign) {
            for (int c = 0; c < 3; ++c) sum[c] += sign * static_cast<double>(texel[c]);
        };
        for (size_t x = 0; x < std::min(radius, from.width); ++x) add(row[x], 1);
        for (size_t x = 0; x < from.width; ++x) {
            if (x + radius < from.width) add(row[x + radius], 1);
            if (x > radius) add(row[x - radius - 1], -1);
            for (int c = 0; c < 3; ++c) to.texels[x * from.height + y][c] = static_cast<float>(sum[c] * share);
        }
    }
    return to;
}

}  // namespace

uint32_t bloom_radius(uint32_t full_height) {
    return std::max(full_height / 64, 1u);
}

void add_bloom(ColorPicture& picture, double amount, uint32_t full_height) {
    ColorPicture light{picture.width, picture.height, std::vector<glm::vec3>(picture.texels.size())};
    for (size_t i = 0; i < picture.texels.size(); ++i) light.texels[i] = light_above_white(picture.texels[i]);
    constexpr int boxes = 3;  // each is a mean along rows and one along columns
    for (int i = 0; i < 2 * boxes; ++i) light = box_mean_turned(light, bloom_radius(full_height));
    for (size_t i = 0; i < picture.texels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            picture.texels[i][c] += static_cast<float>(amount * static_cast<double>(light.texels[i][c]));
}

}  // namespace cistula
