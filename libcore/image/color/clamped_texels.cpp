#include "image/color/clamped_texels.h"

#include <fmt/format.h>

#include "cistula/numerics/real.h"

namespace cistula {
namespace {

bool is_radiance(float value) {
    return is_finite(value) && value >= 0;
}

}  // namespace

ClampedTexels clamp_texels(ColorPicture& picture) {
    ClampedTexels clamped;
    clamped.values = 3 * static_cast<uint64_t>(picture.texels.size());
    float largest = 0;
    for (size_t i = 0; i < picture.texels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const float value = picture.texels[i][c];
            if (is_radiance(value)) {
                largest = max_or_second(value, largest);
                continue;
            }
            if (clamped.count() == 0) {
                clamped.x = static_cast<uint32_t>(i % picture.width);
                clamped.y = static_cast<uint32_t>(i / picture.width);
                clamped.channel = static_cast<uint32_t>(c);
                clamped.first = value;
            }
            ++(value < 0 ? clamped.negative : value > 0 ? clamped.infinite : clamped.not_numbers);
        }
    if (largest > 0) clamped.largest = largest;
    if (clamped.count() == 0) return clamped;
    for (glm::vec3& texel : picture.texels)
        for (int c = 0; c < 3; ++c)
            if (!is_radiance(texel[c])) texel[c] = texel[c] > 0 ? clamped.largest : 0;
    return clamped;
}

std::string ClampedTexels::warning() const {
    std::string kinds;
    const auto add = [&](uint64_t number, const char* what) {
        if (number > 0) kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", number, what);
    };
    add(negative, "negative (taken as 0)");
    add(not_numbers, "not a number (taken as 0)");
    if (infinite > 0) add(infinite, fmt::format("infinite (taken as {:.9g})", largest).c_str());
    return fmt::format(
        "values of its texels that are no radiance: {}, of {}; the first one is at ({}, {}); "
        "\"strict\": true refuses them",
        kinds, values, x, y);
}

std::string ClampedTexels::refusal() const {
    return fmt::format("texel ({}, {}) has {} = {:.9g}, and so {} of {} values; texels are finite and not negative", x,
                       y, "RGB"[channel], first, count(), values);
}

}  // namespace cistula
