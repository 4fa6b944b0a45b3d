// Comparison of films: bit for bit, or as pictures whose borders may lie up to a pixel apart.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "cistula/model/effects.h"
#include "render/record/film_picture.h"
#include "scene/description/camera_path.h"
#include "verify/case.h"

namespace cistula::verify {

/// The place of a pixel as a number: 3001200017 is scene 3, variation 12, pixel 17.
inline uint64_t place_of(uint64_t scene, uint64_t variation, size_t pixel) {
    return scene * 1'000'000'000 + variation * 1'000'000 + pixel;
}
/// The place of the first pixel of a scene.
inline uint64_t place_of_scene(uint64_t scene) {
    return scene * 1'000'000;
}

/// Calls take(pixel, x, y) for each pixel of a film.
template <class Take>
void for_each_pixel(const Film& film, const Take& take) {
    for (int y = 0; y < int(film.rect.height); ++y)
        for (int x = 0; x < int(film.rect.width); ++x) take(size_t(y * int(film.rect.width) + x), x, y);
}
/// Calls take(pixel, direction), with the direction of the ray through the pixel's middle in the scene.
template <class Take>
void for_each_view(const Film& film, const SceneDescription& scene, const Take& take) {
    const Camera camera = camera_at(scene.camera, 0).camera;
    for_each_pixel(film, [&](size_t pixel, int x, int y) {
        take(pixel, camera_direction(camera, x + 0.5, y + 0.5, int(film.rect.width), int(film.rect.height)));
    });
}

// ---- bit for bit

/// Whether two pixels are equal bit for bit, with z multiplied by a power of two.
inline bool same_pixel(const PixelRecord& a, const PixelRecord& b, float z_factor = 1) {
    bool same = a.hits == b.hits && a.rays == b.rays && a.id == b.id &&
                bits_as<uint32_t>(a.z) == bits_as<uint32_t>(b.z * z_factor);
    for (int c = 0; c < 3; ++c)
        same &= a.radiance[c] == b.radiance[c] && a.pruned[c] == b.pruned[c] && a.cut[c] == b.cut[c] &&
                bits_as<uint32_t>(a.normal[c]) == bits_as<uint32_t>(b.normal[c]);
    return same;
}

/// Expects equal pixels, one try each. A film with flags, or of another size or scale, fails for all.
inline void expect_same(Tally& tally, const Film& found, const Film& expected, uint64_t scene, uint64_t variation,
                        float z_factor = 1, int exponent = 0) {
    const bool comparable = found.flags == 0 && expected.flags == 0 && found.pixels.size() == expected.pixels.size() &&
                            found.fixed_shift == expected.fixed_shift &&
                            found.radiance_exponent == expected.radiance_exponent + exponent;
    for (size_t i = 0; i < expected.pixels.size(); ++i) {
        tally.place = place_of(scene, variation, i);
        tally.expect(comparable && same_pixel(found.pixels[i], expected.pixels[i], z_factor));
    }
}

/// Expects equal hits only: the numbers of samples that hit, and the solids.
inline void expect_same_hits(Tally& tally, const Film& found, const Film& expected, uint64_t scene,
                             uint64_t variation) {
    for (size_t i = 0; i < expected.pixels.size(); ++i) {
        tally.place = place_of(scene, variation, i);
        tally.expect(found.flags == 0 && found.pixels[i].hits == expected.pixels[i].hits &&
                     found.pixels[i].id == expected.pixels[i].id);
    }
}

/// Whether a film shows more than a background of one color.
inline bool shows_something(const Film& film) {
    const auto hit = [](const PixelRecord& pixel) { return pixel.hits > 0; };
    return std::count_if(film.pixels.begin(), film.pixels.end(), hit) * 20 > ptrdiff_t(film.pixels.size());
}

/// The settings of a frame of one size.
inline FrameSettings frame_of(int width, int height, int supersample = 1, int depth = 2) {
    FrameSettings settings;
    settings.set_size(width, height);
    settings.supersample = supersample;
    settings.depth = depth;
    return settings;
}

// ---- as pictures

/// The largest difference of a pixel's channels.
inline double difference(const glm::vec3& a, const glm::vec3& b) {
    double largest = 0;
    for (int c = 0; c < 3; ++c) largest = max_or_second(magnitude(double(a[c]) - double(b[c])), largest);
    return largest;
}

/// Whether a color lies between the least and the largest of a picture's pixels at a place and around it, to 1e-3.
inline bool is_between(const glm::vec3& color, const ColorPicture& picture, int x, int y) {
    const int width = int(picture.width);
    const int height = int(picture.height);
    for (int c = 0; c < 3; ++c) {
        float low = INFINITY;
        float high = -INFINITY;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
            for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
                const float value = picture.texels[size_t(v * width + u)][c];
                low = std::min(low, value);
                high = std::max(high, value);
            }
        if (!(color[c] >= low - 1e-3f && color[c] <= high + 1e-3f)) return false;
    }
    return true;
}

/// Expects every pixel to be that of one of the others, or between those around it there. `place`: of the first pixel.
inline void expect_one_of(Tally& tally, const Film& film, std::initializer_list<const Film*> others, uint64_t place) {
    const ColorPicture found = to_color(film);
    std::vector<ColorPicture> pictures;
    bool reliable = film.flags == 0;
    for (const Film* other : others) {
        pictures.push_back(to_color(*other));
        reliable = reliable && other->flags == 0;
    }
    for_each_pixel(film, [&](size_t i, int x, int y) {
        tally.place = place + i;
        tally.expect(reliable && std::any_of(pictures.begin(), pictures.end(), [&](const ColorPicture& picture) {
                         return is_between(found.texels[i], picture, x, y);
                     }));
    });
}
/// Expects a scene's film to be another's, but for borders that are up to a pixel apart. `number`: of the scene.
inline void expect_same_picture(const Stage& stage, Tally& tally, const SceneDescription& scene, const Film& expected,
                                uint64_t number) {
    expect_one_of(tally, stage.film(scene), {&expected}, place_of_scene(number));
}
inline void expect_same_picture(const Stage& stage, Tally& tally, const SceneDescription& scene,
                                const SceneDescription& expected, uint64_t number) {
    expect_same_picture(stage, tally, scene, stage.film(expected), number);
}

/// Measures how far the pixels of two films differ.
inline void measure_difference(Tally& tally, const Film& film, const Film& other, uint64_t place) {
    const ColorPicture found = to_color(film);
    const ColorPicture expected = to_color(other);
    const bool reliable = film.flags == 0 && other.flags == 0;
    for (size_t i = 0; i < expected.texels.size(); ++i) {
        tally.place = place + i;
        tally.measure(reliable ? difference(found.texels[i], expected.texels[i]) : INFINITY);
    }
}

/// The mean radiance of a pixel, with all digits of its sums.
inline double radiance(const Film& film, size_t pixel, int channel = 0) {
    return film.flags == 0 ? double(film.pixels[pixel].radiance[channel]) * film.unit() : INFINITY;
}

}  // namespace cistula::verify
