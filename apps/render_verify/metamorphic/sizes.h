// Pictures of one pixel, strips of 65,536 pixels, fields of view from almost 0 to almost 180 degrees.
#pragma once

#include "apps/render_verify/metamorphic/films.h"
#include "apps/render_verify/metamorphic/samples.h"

namespace cistula::verify::metamorphic {

inline constexpr double pi = 3.14159265358979323846;

/// A picture of one pixel with k x k samples takes the same rays as one of k x k pixels. The sums have fewer bits for
/// more samples: what is added, at most two numbers a ray, loses less than one unit each.
struct OnePixel {
    static constexpr const char* name = "metamorphic/one-pixel";
    static constexpr const char* exact = "1 x 1 with k x k samples: the sum of k x k pixels, a unit a number added";
    static constexpr Bound bound = no_failures("images");
    static constexpr bool needs_witness = true;

    static void render(Stage& stage, Tally& tally) {
        for (uint64_t seed = 0, left = stage.quick ? 20 : 150; seed < generated_scene_count && left > 0; ++seed) {
            SceneDescription scene = small_scene(seed);
            if (stage.quick && is_heavy(scene)) continue;
            --left;
            scene.cutoff = 0;
            for (const int k : {1, 2, 5, 8}) {
                tally.place = place_of(seed, uint64_t(k), 0);
                const Film one = stage.render(scene, frame_of(1, 1, k, 3)),
                           many = stage.render(scene, frame_of(k, k, 1, 3));
                const PixelRecord &pixel = one.pixels[0], &chosen = many.pixels[size_t(k / 2 * k + k / 2)];
                uint64_t hits = 0, rays = 0;
                int64_t sums[3] = {0, 0, 0};
                const int shift = many.fixed_shift - one.fixed_shift;
                for (const PixelRecord& other : many.pixels) {
                    hits += other.hits;
                    rays += other.rays;
                    // Each pixel's own rounding down counts as a number of one ray.
                    for (int c = 0; c < 3; ++c) sums[c] += other.radiance[c] >> shift;
                }
                PixelRecord middle = pixel;  // compared except for its sums
                middle.hits = chosen.hits;
                middle.rays = chosen.rays;
                bool holds = one.flags == 0 && many.flags == 0 && pixel.hits == hits && pixel.rays == rays;
                for (int c = 0; c < 3; ++c) {
                    holds &= magnitude(sums[c] - pixel.radiance[c]) <= int64_t(3 * rays);
                    middle.radiance[c] = chosen.radiance[c];
                    middle.pruned[c] = chosen.pruned[c];
                    middle.cut[c] = chosen.cut[c];
                }
                tally.expect(holds && same_pixel(middle, chosen));
                tally.witness(k > 1 && pixel.hits > 0);
            }
        }
    }
};

/// Pixels to the left of (or above) a border between two pixels, in strips, and crops of the strips' ends.
struct Strips {
    static constexpr const char* name = "metamorphic/strips";
    static constexpr const char* exact = "65,536 x 1 and 1 x 65,536: every pixel on the right side of a border";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        constexpr int length = 65536;
        for (const bool tall : {false, true})
            for (const int border : {-65534, -20000, 0, 2, 65534}) {
                SceneDescription scene = half_plane({tall ? 0 : 1, tall ? 1 : 0, double(border)}, length, false);
                // The field of view is that of the width: a tall strip has that of its one pixel.
                if (tall)
                    scene.camera.field_of_view =
                        360 / pi * std::atan(std::tan(scene.camera.field_of_view * (pi / 360)) / length);
                FrameSettings settings = frame_of(tall ? 1 : length, tall ? length : 1);
                const Film film = stage.render(scene, settings);
                for (int i = 0; i < length; ++i) {
                    tally.place = place_of(tall, uint64_t(border + length), size_t(i));
                    // Borders are even, samples odd: half a pixel is 2^-16 of the picture, rounding 2^-21.
                    tally.expect(film.flags == 0 &&
                                 film.pixels[size_t(i)].hits == (2 * i + 1 - length < border ? 1u : 0u));
                }
                for (const int first : {0, length - 3}) {
                    settings.crop = tall ? PixelRect{0, first, 1, 3} : PixelRect{first, 0, 3, 1};
                    const Film part = stage.render(scene, settings);
                    for (int i = 0; i < 3; ++i)
                        tally.expect(part.flags == 0 &&
                                     same_pixel(part.pixels[size_t(i)], film.pixels[size_t(first + i)]));
                }
            }
    }
};

/// Cameras at a distance that makes the picture equally large on the plane for any field of view.
struct WideFields {
    static constexpr const char* name = "metamorphic/fields-of-view";
    static constexpr const char* exact = "coverage of a half-plane from 1e-6 to 179.999 degrees";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        constexpr int width = 2048, height = 3;
        uint64_t field = 0;
        for (const double degrees : {1e-6, 1e-3, 1.0, 60.0, 90.0, 120.0, 179.0, 179.9, 179.999}) {
            uint64_t number = 0;
            for (const SampleLine& line : {SampleLine{1, 0, 2 - width}, SampleLine{1, 0, 30},
                                           SampleLine{1, 0, width - 2}, SampleLine{1, 1, 0}, SampleLine{3, -2, 4000}}) {
                SceneDescription scene = half_plane(line, width, false);
                const double half_width = 4 * std::tan(scene.camera.field_of_view * (pi / 360));
                scene.camera.field_of_view = degrees;
                scene.camera.position.z = half_width / std::tan(degrees * (pi / 360));
                const Film film = stage.render(scene, frame_of(width, height));
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x) {
                        // Lines go by even numbers, samples have odd ones: the nearest are 2^-12 of the picture off, so
                        // that a tangent off by 2^-10 shows; 20 roundings of 2^-24, of numbers up to 3, do not.
                        const bool inside = line.left_of(2 * x + 1 - width, 2 * y + 1 - height);
                        const PixelRecord& pixel = film.pixels[size_t(y * width + x)];
                        tally.place = place_of(field, number, size_t(y * width + x));
                        tally.expect(film.flags == 0 && pixel.hits == (inside ? 1u : 0u) && (pixel.id == 1) == inside);
                    }
                ++number;
            }
            ++field;
        }
    }
};

}  // namespace cistula::verify::metamorphic
