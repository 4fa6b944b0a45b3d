#include "image/view/picture_view.h"

#include <algorithm>
#include <limits>

#include "cistula/numerics/elementary.h"

namespace cistula {

glm::vec3 filmic_color(const glm::vec3& color) {
    constexpr double contrast = 1.2;
    constexpr double gray = 0.18;
    constexpr double largest = std::numeric_limits<float>::max();
    static const double knee = elementary::pow(gray, contrast) * (1 - gray) / gray;
    double light[3], most = 0;
    for (int c = 0; c < 3; ++c) {
        light[c] = color[c] > 0 ? std::min(static_cast<double>(color[c]), largest) : 0;
        most = std::max(most, light[c]);
    }
    if (most == 0) return glm::vec3(0);
    const double power = elementary::pow(most, contrast);
    const double tone = power / (power + knee);
    const double white = tone * tone * tone * tone * tone * tone;
    glm::vec3 shown;
    for (int c = 0; c < 3; ++c) shown[c] = static_cast<float>(tone * ((1 - white) * (light[c] / most) + white));
    return shown;
}

ColorPicture viewed(ColorPicture linear, const PictureView& view, uint32_t full_height) {
    if (view.exposure != 0) {
        const double factor = elementary::exp2(view.exposure);
        for (glm::vec3& texel : linear.texels)
            for (int c = 0; c < 3; ++c) texel[c] = static_cast<float>(texel[c] * factor);
    }
    if (view.bloom > 0) add_bloom(linear, view.bloom, full_height);
    if (view.curve == ViewCurve::filmic)
        for (glm::vec3& texel : linear.texels) texel = filmic_color(texel);
    if (view.config) view.config->apply(linear);
    return linear;
}

}  // namespace cistula
