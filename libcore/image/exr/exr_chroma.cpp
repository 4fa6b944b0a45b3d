#include "image/exr/exr_file.h"

#include <algorithm>
#include <vector>

#include "cistula/numerics/real.h"

namespace cistula {
namespace {

using glm::dvec3;

/// Fills in a channel of texel i of a line of `count`, `step` texels apart, from those of even numbers.
void reconstruct(glm::vec3* line, size_t step, size_t i, size_t count, int channel) {
    // Weights of the texels at distances 1, 3, 5, ... to either side (OpenEXR, ImfRgbaYca.cpp); beyond the ends of the
    // line its outermost ones go on.
    constexpr double filter[] = {0.627123, -0.186077, 0.087929, -0.043159, 0.019597, -0.007540, 0.002128};
    const size_t last = (count - 1) / 2 * 2;
    const auto at = [&](size_t k) { return static_cast<double>(line[k * step][channel]); };
    double sum = 0;
    for (size_t tap = 0; tap < std::size(filter); ++tap) {
        const size_t distance = 2 * tap + 1;
        sum += filter[tap] * (at(i > distance ? i - distance : 0) + at(std::min(i + distance, last)));
    }
    line[i * step][channel] = static_cast<float>(sum);
}

void reconstruct(ColorPicture& picture, int channel) {
    const size_t width = picture.width;
    const size_t height = picture.height;
    glm::vec3* const texels = picture.texels.data();
    for (size_t y = 0; y < height; y += 2)
        for (size_t x = 1; x < width; x += 2) reconstruct(texels + y * width, 1, x, width, channel);
    for (size_t y = 1; y < height; y += 2)
        for (size_t x = 0; x < width; ++x) reconstruct(texels + x, width, y, height, channel);
}

dvec3 rgb_of(const glm::vec3& chroma, const dvec3& weights) {
    const double luminance = chroma[1];
    if (chroma[0] == 0 && chroma[2] == 0) return dvec3(luminance);
    const double red = (chroma[0] + 1.0) * luminance;
    const double blue = (chroma[2] + 1.0) * luminance;
    return {red, (luminance - red * weights[0] - blue * weights[2]) / weights[1], blue};
}

double largest(const dvec3& color) {
    return max_or_second(color.x, max_or_second(color.y, color.z));
}

/// 0 for gray, 1 where a channel is 0, more where one is negative.
double saturation(const dvec3& color) {
    const double most = largest(color);
    return most > 0 ? 1 - min_or_second(color.x, min_or_second(color.y, color.z)) / most : 0;
}

/// The color with its saturation multiplied by `factor`, and the luminance that it had.
dvec3 desaturated(const dvec3& color, double factor, const dvec3& weights) {
    const auto luminance = [&](const dvec3& c) { return c.x * weights.x + c.y * weights.y + c.z * weights.z; };
    dvec3 result;
    for (int c = 0; c < 3; ++c) {
        const double most = largest(color);
        result[c] = max_or_second(most - (most - color[c]) * factor, 0.0);
    }
    const double after = luminance(result);
    return after > 0 ? result * (luminance(color) / after) : result;
}

/// Desaturates what is far more saturated than its four diagonal neighbors; of the rows beyond the picture, the first
/// repeats row 0, the last the row before it.
void limit_saturation(ColorPicture& picture, const dvec3& weights) {
    const size_t width = picture.width;
    const size_t height = picture.height;
    const auto saturations = [&](size_t y) {
        std::vector<double> row(width);
        for (size_t x = 0; x < width; ++x) row[x] = saturation(dvec3(picture.texels[y * width + x]));
        return row;
    };
    std::vector<double> here = saturations(0);
    std::vector<double> above = here;
    for (size_t y = 0; y < height; ++y) {
        std::vector<double> below = y + 1 < height ? saturations(y + 1) : above;
        for (size_t x = 0; x < width; ++x) {
            const size_t left = x > 0 ? x - 1 : 0;
            const size_t right = std::min(x + 1, width - 1);
            const double mean = min_or_second(0.25 * (above[left] + above[right] + below[left] + below[right]), 1.0);
            const double most = 0.75 + 0.25 * mean;
            glm::vec3& texel = picture.texels[y * width + x];
            if (here[x] > mean && here[x] > most) texel = glm::vec3(desaturated(dvec3(texel), most / here[x], weights));
        }
        above = std::move(here);
        here = std::move(below);
    }
}

}  // namespace

void colors_from_chroma(ColorPicture& picture, const bool (&is_halved)[3], const dvec3& weights) {
    for (const int channel : {0, 2})
        if (is_halved[channel]) reconstruct(picture, channel);
    for (glm::vec3& texel : picture.texels) texel = glm::vec3(rgb_of(texel, weights));
    if (is_halved[0] || is_halved[2]) limit_saturation(picture, weights);
}

}  // namespace cistula
