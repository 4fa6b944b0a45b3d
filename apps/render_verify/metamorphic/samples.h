// Supersampling: it changes nothing in a constant picture, and counts exactly where an edge crosses a pixel.
#pragma once

#include <random>

#include "apps/render_verify/metamorphic/films.h"
#include "cistula/numerics/fixed_sum.h"

namespace cistula::verify::metamorphic {

struct ConstantScene {
    static constexpr const char* name = "metamorphic/constant-scene";
    static constexpr const char* exact = "the color itself, for 1 to 64 x 64 samples a pixel";
    static constexpr Bound bound = no_failures("pixels");

    /// A scene that has one color everywhere: the background, a room in ambient light, clear solids in front.
    static SceneDescription scene_of(int kind, const glm::dvec3& color) {
        SceneDescription scene = empty_scene();
        scene.camera.position = {0.125, -2.5, 0.25};
        MaterialDescription& wall = scene.materials[0];
        wall.color = color;
        scene.ambient = glm::dvec3(1);
        MaterialDescription clear;
        clear.transmission = 1;
        if (kind > 0) add_object(scene, solid_object(PlatonicSolid::cube, {0, 0, 0}, 8));
        if (kind > 1) {
            const int material = add_material(scene, clear);
            add_object(scene, solid_object(PlatonicSolid::icosahedron, {0, 0, 0}, 1, {10, 20, 30}), material);
            add_object(scene, torus(1.25, 0.5, 12, 8), material);
        }
        if (kind == 0) scene.background = color;
        return scene;
    }

    template <class Real>
    static void compare(Stage& stage, Tally& tally) {
        std::mt19937_64 random(7);
        // Between 1/4 and 1 of a bound under 2: the sums keep multiples of 2^-47 at 64 x 64 samples, 2^-50 there being
        // their unit and 2^-3 the least share, and all 53 bits of a double at up to 8 x 8, where it is 2^-56.
        const auto component = [&](int bits) {
            const auto steps = int64_t(random() >> (64 - bits));
            return 0.25 + 0.75 * std::ldexp(double(steps), -bits);
        };
        const int most = stage.quick ? 1 : 32;
        for (int variant = 0; variant < 3 * most; ++variant) {
            const int kind = variant % 3;
            for (const int k : {1, 2, 3, 5, 8, 13, 16, 37, 64}) {
                const int bits = k <= 8 ? 53 : 40;
                glm::dvec3 color;
                for (int c = 0; c < 3; ++c) color[c] = component(bits);
                const Film film = stage.render(scene_of(kind, color), frame_of(3, 2, k, 8));
                for (size_t i = 0; i < film.pixels.size(); ++i) {
                    const PixelRecord& pixel = film.pixels[i];
                    bool same = film.flags == 0 && pixel.hits == (kind > 0 ? uint32_t(k * k) : 0u);
                    for (int c = 0; c < 3; ++c)
                        same &= resolve<Real>(pixel.radiance[c], film.fixed_shift, uint32_t(film.samples),
                                              film.radiance_exponent) == Real(color[c]);
                    tally.place = place_of(uint64_t(variant), uint64_t(k), i);
                    tally.expect(same);
                }
            }
        }
    }
    static void render(Stage& stage, Tally& tally) {
        stage.in_double() ? compare<double>(stage, tally) : compare<float>(stage, tally);
    }
};

/// Samples of a picture in half steps from its center, as in camera_direction, and a line a x + b y = c there.
struct SampleLine {
    int a, b;
    double c;

    bool left_of(int across, int down) const { return a * across + b * down < c; }
};

/// A camera above a sheet in the plane z = 0 that ends at a line of the picture. `beyond`: the sheet on the other side,
/// which starts with the same two corners.
inline SceneDescription half_plane(const SampleLine& line, int samples_across, bool beyond) {
    constexpr double height = 4, reach = 8;
    SceneDescription scene = empty_scene();
    scene.camera.position = {0, 0, height};
    scene.camera.up = {0, 1, 0};
    scene.frame = FrameOfReference{{0, 0, 0}, -4, {}};
    const double step = height * camera_at(scene.camera, 0).camera.tan_half_width / samples_across;
    const double size = std::sqrt(double(line.a * line.a + line.b * line.b));
    const glm::dvec3 normal(line.a / size, -line.b / size, 0), along(-normal.y, normal.x, 0);  // down is -y
    const double offset = line.c / size * step;  // of the line from the middle, which may be outside of the picture
    const glm::dvec3 middle = normal * offset;
    const glm::dvec3 one = middle + along * reach, other = middle - along * reach;
    const glm::dvec3 away = normal * ((beyond ? 1 : -1) * (reach + std::abs(offset)));
    add_object(scene, sheet({one, other, other + away, one + away}));
    return scene;
}

/// Calls `visit` for the sample positions of a pixel.
template <class Visit>
void for_each_sample(int width, int height, int k, int x, int y, const Visit& visit) {
    for (int j = 0; j < k; ++j)
        for (int i = 0; i < k; ++i) visit(2 * (x * k + i) + 1 - width * k, 2 * (y * k + j) + 1 - height * k);
}

struct HalfPlane {
    static constexpr const char* name = "metamorphic/half-plane";
    static constexpr const char* exact = "coverage k/N: the samples of a pixel on one side of a line";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;

    static void render(Stage& stage, Tally& tally) {
        constexpr int width = 8, height = 6;
        std::mt19937_64 random(11);
        const auto between = [&](int low, int high) { return low + int(random() % uint64_t(high - low + 1)); };
        const uint64_t lines = stage.quick ? 60 : 3000;
        for (uint64_t n = 0; n < lines; ++n) {
            const int k = between(1, 8);
            SampleLine line{between(-5, 5), between(-5, 5), 0};
            if (line.a == 0 && line.b == 0) line.a = 1;
            // Halves: no sample is nearer than 1/15 of a step, and rounding of corners and rays is below 1/1000 of one.
            line.c = between(-5 * width * k, 5 * width * k) / 2 + 0.5;
            const Film film = stage.render(half_plane(line, width * k, false), frame_of(width, height, k));
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    uint32_t inside = 0;
                    for_each_sample(width, height, k, x, y,
                                    [&](int across, int down) { inside += line.left_of(across, down); });
                    const size_t i = size_t(y * width + x);
                    tally.place = place_of(n, 0, i);
                    tally.expect(film.flags == 0 && film.pixels[i].hits == inside);
                    tally.witness(inside > 0 && inside < uint32_t(k * k));
                }
        }
    }
};

struct SharedBorder {
    static constexpr const char* name = "metamorphic/half-plane/shared-border";
    static constexpr const char* exact =
        "samples on a border that two sheets share, each by itself: one of them has it";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;

    static void render(Stage& stage, Tally& tally) {
        constexpr int width = 9, height = 7;
        std::mt19937_64 random(13);
        const auto between = [&](int low, int high) { return low + int(random() % uint64_t(high - low + 1)); };
        const uint64_t lines = stage.quick ? 60 : 3000;
        for (uint64_t n = 0; n < lines; ++n) {
            const int k = 1 + 2 * between(0, 3);  // with odd numbers a sample is in the very middle
            SampleLine line{between(-1, 1), between(-1, 1), 0};
            if (n % 2) line.a = between(-6, 6), line.b = between(-6, 6);
            if (line.a == 0 && line.b == 0) line.a = 1;
            if (n % 4 == 3) line.c = between(-width * k, width * k);
            const FrameSettings settings = frame_of(width, height, k);
            const Film left = stage.render(half_plane(line, width * k, false), settings);
            const Film right = stage.render(half_plane(line, width * k, true), settings);
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    const size_t i = size_t(y * width + x);
                    tally.place = place_of(n, 0, i);
                    tally.expect(left.flags == 0 && right.flags == 0 &&
                                 left.pixels[i].hits + right.pixels[i].hits == uint32_t(k * k));
                    for_each_sample(width, height, k, x, y, [&](int across, int down) {
                        tally.witness(line.a * across + line.b * down == line.c);
                    });
                }
        }
    }
};

}  // namespace cistula::verify::metamorphic
