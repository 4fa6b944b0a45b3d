// Comparison of pictures whose borders may lie up to a pixel apart.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "apps/render_verify/contact/site.h"
#include "render/record/film_picture.h"

namespace cistula::verify::contact {

inline constexpr float alike = 1e-3f;

/// The largest difference of a pixel's channels.
inline double difference(const glm::vec3& a, const glm::vec3& b) {
    double largest = 0;
    for (int c = 0; c < 3; ++c) largest = max_or_second(magnitude(double(a[c]) - double(b[c])), largest);
    return largest;
}

/// Whether a color lies between the least and the largest of a picture's pixels at a place and around it, to 1e-3.
inline bool is_between(const glm::vec3& color, const ColorPicture& picture, int x, int y) {
    const int width = int(picture.width), height = int(picture.height);
    for (int c = 0; c < 3; ++c) {
        float low = INFINITY, high = -INFINITY;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
            for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
                const float value = picture.texels[size_t(v * width + u)][c];
                low = std::min(low, value);
                high = std::max(high, value);
            }
        if (!(color[c] >= low - alike && color[c] <= high + alike)) return false;
    }
    return true;
}

/// Expects every pixel to be that of one of the others, or between those around it there. `place`: of the first pixel.
inline void expect_one_of(Tally& tally, const Film& film, std::initializer_list<const Film*> others, uint64_t place) {
    const int width = int(film.rect.width), height = int(film.rect.height);
    const ColorPicture found = to_color(film);
    std::vector<ColorPicture> pictures;
    bool reliable = film.flags == 0;
    for (const Film* other : others) {
        pictures.push_back(to_color(*other));
        reliable = reliable && other->flags == 0;
    }
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::vec3& color = found.texels[size_t(y * width + x)];
            const bool fits = std::any_of(pictures.begin(), pictures.end(), [&](const ColorPicture& picture) {
                return is_between(color, picture, x, y);
            });
            tally.place = place + uint64_t(y * width + x);
            tally.expect(reliable && fits);
        }
}

/// Measures how far the pixels of two films differ.
inline void measure_difference(Tally& tally, const Film& film, const Film& other, uint64_t place) {
    const ColorPicture found = to_color(film), expected = to_color(other);
    const bool reliable = film.flags == 0 && other.flags == 0;
    for (size_t i = 0; i < expected.texels.size(); ++i) {
        tally.place = place + i;
        tally.measure(reliable ? difference(found.texels[i], expected.texels[i]) : INFINITY);
    }
}

/// Where a ray starts on paper is 32 u M from where it would start without bodies that touch it, and the scene may have
/// another center: colors, which are below 4 and smooth, differ by some 2^8 u.
inline constexpr Bound bound_of_colors = at_most(0x1p-16, 0x1p-16, "of 1");

/// The place of the first pixel of a scene.
inline uint64_t place_of_scene(uint64_t scene) {
    return scene * 1'000'000;
}

}  // namespace cistula::verify::contact
