// Supersampling, sizes of pictures and fields of view; textures and powers of cosines.
#include <random>

#include "cistula/numerics/fixed_sum.h"
#include "verify/cases/metamorphic/rays.h"
#include "verify/cases/metamorphic/scenes.h"

namespace cistula::verify::metamorphic {

SceneDescription half_plane(const SampleLine& line, int samples_across, bool beyond) {
    constexpr double height = 4;
    constexpr double reach = 8;
    SceneDescription scene = empty_scene();
    scene.camera.position = {0, 0, height};
    scene.camera.up = {0, 1, 0};
    scene.frame = FrameOfReference{{0, 0, 0}, -4, {}};
    const double step = height * camera_at(scene.camera, 0).camera.tan_half_width / samples_across;
    const double size = std::sqrt(double(line.a * line.a + line.b * line.b));
    const glm::dvec3 normal(line.a / size, -line.b / size, 0), along(-normal.y, normal.x, 0);  // down is -y
    const double offset = line.c / size * step;  // of the line from the middle, which may be outside of the picture
    const glm::dvec3 middle = normal * offset;
    const glm::dvec3 one = middle + along * reach;
    const glm::dvec3 other = middle - along * reach;
    const glm::dvec3 away = normal * ((beyond ? 1 : -1) * (reach + std::abs(offset)));
    add_object(scene, quad(one, other, other + away, one + away));
    return scene;
}

namespace {

constexpr double pi = 3.14159265358979323846;

// ---- supersampling: it changes nothing in a constant picture, and counts exactly where an edge crosses a pixel

/// A scene that has one color everywhere: the background, a room in ambient light, clear solids in front.
SceneDescription one_color(int kind, const glm::dvec3& color) {
    SceneDescription scene = empty_scene();
    scene.camera.position = {0.125, -2.5, 0.25};
    scene.materials[0].color = color;
    scene.ambient = glm::dvec3(1);
    if (kind > 0) add_object(scene, solid_object(PlatonicSolid::cube, {0, 0, 0}, 8));
    if (kind > 1) {
        const int material = add_material(scene, clear());
        add_object(scene, solid_object(PlatonicSolid::icosahedron, {0, 0, 0}, 1, {10, 20, 30}), material);
        add_object(scene, torus(1.25, 0.5, 12, 8), material);
    }
    if (kind == 0) scene.background = color;
    return scene;
}

template <class Real>
void constant_scene(Stage& stage, Tally& tally) {
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
            const Film film = stage.render(one_color(kind, color), frame_of(3, 2, k, 8));
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

/// Calls `visit` for the sample positions of a pixel.
template <class Visit>
void for_each_sample(int width, int height, int k, int x, int y, const Visit& visit) {
    for (int j = 0; j < k; ++j)
        for (int i = 0; i < k; ++i) visit(2 * (x * k + i) + 1 - width * k, 2 * (y * k + j) + 1 - height * k);
}

void on_half_plane(Stage& stage, Tally& tally) {
    constexpr int width = 8;
    constexpr int height = 6;
    std::mt19937_64 random(11);
    const auto between = [&](int low, int high) { return low + int(random() % uint64_t(high - low + 1)); };
    const uint64_t lines = stage.quick ? 60 : 3000;
    for (uint64_t n = 0; n < lines; ++n) {
        const int k = between(1, 8);
        SampleLine line{between(-5, 5), between(-5, 5), 0};
        if (line.a == 0 && line.b == 0) line.a = 1;
        // Halves: no sample is nearer than 1/15 of a step, and rounding of corners and rays is below 1/1000 of one.
        const int whole = between(-5 * width * k, 5 * width * k) / 2;
        line.c = whole + 0.5;
        const Film film = stage.render(half_plane(line, width * k, false), frame_of(width, height, k));
        for_each_pixel(film, [&](size_t i, int x, int y) {
            uint32_t inside = 0;
            for_each_sample(width, height, k, x, y,
                            [&](int across, int down) { inside += line.left_of(across, down); });
            tally.place = place_of(n, 0, i);
            tally.expect(film.flags == 0 && film.pixels[i].hits == inside);
            tally.witness(inside > 0 && inside < uint32_t(k * k));
        });
    }
}
void shared_border(Stage& stage, Tally& tally) {
    constexpr int width = 9;
    constexpr int height = 7;
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
        for_each_pixel(left, [&](size_t i, int x, int y) {
            tally.place = place_of(n, 0, i);
            tally.expect(left.flags == 0 && right.flags == 0 &&
                         left.pixels[i].hits + right.pixels[i].hits == uint32_t(k * k));
            for_each_sample(width, height, k, x, y,
                            [&](int across, int down) { tally.witness(line.a * across + line.b * down == line.c); });
        });
    }
}

// ---- pictures of one pixel, strips of 65,536 pixels, fields of view from almost 0 to almost 180 degrees

/// A picture of one pixel with k x k samples takes the same rays as one of k x k pixels. The sums have fewer bits for
/// more samples: what is added, at most two numbers a ray, loses less than one unit each.
void one_pixel(Stage& stage, Tally& tally) {
    for_each_scene(stage, 150, 20, [&](uint64_t seed, SceneDescription scene) {
        scene.cutoff = 0;
        for (const int k : {1, 2, 5, 8}) {
            tally.place = place_of(seed, uint64_t(k), 0);
            const Film one = stage.render(scene, frame_of(1, 1, k, 3));
            const Film many = stage.render(scene, frame_of(k, k, 1, 3));
            const PixelRecord &pixel = one.pixels[0], &chosen = many.pixels[size_t(k / 2 * k + k / 2)];
            uint64_t hits = 0;
            uint64_t rays = 0;
            int64_t sums[3] = {0, 0, 0};
            const int shift = many.fixed_shift - one.fixed_shift;
            for (const PixelRecord& other : many.pixels) {
                hits += other.hits;
                rays += other.rays;
                // Each pixel's own rounding down counts as a number of one ray.
                for (int c = 0; c < 3; ++c) sums[c] += other.radiance[c] >> shift;
            }
            PixelRecord middle = chosen;  // what is no sum must be that of the pixel in the middle
            middle.id = pixel.id;
            middle.z = pixel.z;
            bool holds = one.flags == 0 && many.flags == 0 && pixel.hits == hits && pixel.rays == rays;
            for (int c = 0; c < 3; ++c) {
                holds &= magnitude(sums[c] - pixel.radiance[c]) <= int64_t(3 * rays);
                middle.normal[c] = pixel.normal[c];
            }
            tally.expect(holds && same_pixel(middle, chosen));
            tally.witness(k > 1 && pixel.hits > 0);
        }
        return true;
    });
}

/// Pixels to the left of (or above) a border between two pixels, in strips, and crops of the strips' ends.
void strips(Stage& stage, Tally& tally) {
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
                tally.expect(film.flags == 0 && film.pixels[size_t(i)].hits == (2 * i + 1 - length < border ? 1u : 0u));
            }
            for (const int first : {0, length - 3}) {
                settings.crop = tall ? PixelRect{0, first, 1, 3} : PixelRect{first, 0, 3, 1};
                const Film part = stage.render(scene, settings);
                for (int i = 0; i < 3; ++i)
                    tally.expect(part.flags == 0 && same_pixel(part.pixels[size_t(i)], film.pixels[size_t(first + i)]));
            }
        }
}
/// Cameras at a distance that makes the picture equally large on the plane for any field of view.
void wide_fields(Stage& stage, Tally& tally) {
    constexpr int width = 2048;
    constexpr int height = 3;
    uint64_t field = 0;
    for (const double degrees : {1e-6, 1e-3, 1.0, 60.0, 90.0, 120.0, 179.0, 179.9, 179.999}) {
        uint64_t number = 0;
        for (const SampleLine& line : {SampleLine{1, 0, 2 - width}, SampleLine{1, 0, 30}, SampleLine{1, 0, width - 2},
                                       SampleLine{1, 1, 0}, SampleLine{3, -2, 4000}}) {
            SceneDescription scene = half_plane(line, width, false);
            const double half_width = 4 * std::tan(scene.camera.field_of_view * (pi / 360));
            scene.camera.field_of_view = degrees;
            scene.camera.position.z = half_width / std::tan(degrees * (pi / 360));
            const Film film = stage.render(scene, frame_of(width, height));
            // Lines go by even numbers, samples have odd ones: the nearest are 2^-12 of the picture off, so that a
            // tangent off by 2^-10 shows; 20 roundings of 2^-24, of numbers up to 3, do not.
            for_each_pixel(film, [&](size_t i, int x, int y) {
                const bool inside = line.left_of(2 * x + 1 - width, 2 * y + 1 - height);
                const PixelRecord& pixel = film.pixels[i];
                tally.place = place_of(field, number, i);
                tally.expect(film.flags == 0 && pixel.hits == (inside ? 1u : 0u) && (pixel.id == 1) == inside);
            });
            ++number;
        }
        ++field;
    }
}
// ---- textures and powers

/// A part of rays that need no scene.
template <class Functor>
auto without_scene(const char* label, const Functor& functor) {
    return [=](Plan& plan) {
        SceneDescription scene = empty_scene();
        add_object(scene, solid_object(PlatonicSolid::cube));
        plan.add(label, scene, functor, {}, plan.rays(20'000'000, 300'000));
    };
}
void plan_far_floor(Plan& plan) {
    struct Floor {
        const char* label;
        double size, cell;
    };
    for (const Floor& floor : {Floor{"size 1, cell 1/16", 1, 0x1p-4}, Floor{"size 1e3, cell 1", 1e3, 1},
                               Floor{"size 1e6, cell 1", 1e6, 1}, Floor{"size 1e6, cell 16", 1e6, 16},
                               Floor{"size 1e9, cell 1", 1e9, 1}, Floor{"size 1e9, cell 2^14", 1e9, 0x1p14}}) {
        SceneDescription scene = empty_scene();
        scene.materials[0].color = glm::dvec3(1);
        add_checker(scene, glm::dvec2(0.5 / floor.cell));
        add_object(scene, floor_of_half(floor.size));
        plan.add(floor.label, scene, FarFloor{floor.size, floor.cell}, {}, plan.rays(2'000'000, 60'000));
    }
}
}  // namespace

void add_samples(Cases& cases) {
    const Bound pixels = no_failures("pixels");
    const Bound witnessed = no_failures("pixels", needs_witness);
    cases.images("constant-scene", "the color itself, for 1 to 64 x 64 samples a pixel", pixels,
                 [](Stage& stage, Tally& tally) {
                     stage.in_double() ? constant_scene<double>(stage, tally) : constant_scene<float>(stage, tally);
                 });
    cases.images("half-plane", "coverage k/N: the samples of a pixel on one side of a line", witnessed, on_half_plane);
    cases.images("half-plane/shared-border",
                 "samples on a border that two sheets share, each by itself: one of them has it", witnessed,
                 shared_border);
    cases.images("one-pixel", "1 x 1 with k x k samples: the sum of k x k pixels, a unit a number added",
                 no_failures("images", needs_witness), one_pixel);
    cases.images("strips", "65,536 x 1 and 1 x 65,536: every pixel on the right side of a border", pixels, strips);
    cases.images("fields-of-view", "coverage of a half-plane from 1e-6 to 179.999 degrees", pixels, wide_fields);
    cases.rays<CellBorders>("floor-texture/cell-borders",
                            "the cell on the right side of borders up to 1e9 cells out, and an ulp beside",
                            no_failures("look-ups"), without_scene("checkers", CellBorders{}));
    cases.rays<RepeatedTexels>("floor-texture/repeated",
                               "i modulo n, n to 8192, |i| + n to 2^24 in float and 2^30 in double",
                               no_failures("texels"), without_scene("rows", RepeatedTexels{0}));
    cases.rays<RepeatedTexels>("floor-texture/repeated/to-1e9",
                               "i modulo n, n to 8192, |i| to 1e9, where floats are 64 apart", no_failures("texels"),
                               without_scene("rows", RepeatedTexels{1'000'000'000}));
    cases.rays<FarFloor>("floor-texture/far", "a floor's cells to 1e9, 32 u of its size beside borders and farther",
                         no_failures("cells", needs_witness), plan_far_floor);
    // x^(2^j) has the relative error of 2^j - 1 roundings, the product of those in n that of n - 1 in all, each u at
    // most: (n - 1) u, so under n - 1 ulps. What underflows on the way is off by half the least number once more for
    // each of up to 10 products; it is a factor below 1 of what follows. Second-order terms: n^2 u / 2, 0.03 ulps in
    // float.
    cases.rays<IntegerPowers>("powers/by-squaring", "cos^n for n to 1,024; powers of 1/2, 0.5^200 among them, exactly",
                              at_most(1, "n ulps"), without_scene("cos^n", IntegerPowers{}));
    // What elementary.h states for results that are normal, as all are here; computed in double for either type.
    cases.rays<RealPowers>("powers/by-logarithm",
                           "x^y for y in eighths to 1,024, against roots and products in double-double",
                           at_most(elementary::pow_worst_ulp, "ulps"), without_scene("cos^n", RealPowers{}));
    cases.rays<Highlights>("powers/highlight", "at most 1; 0 on the far side; never more at a larger angle or exponent",
                           no_failures("highlights"), without_scene("cos^n", Highlights{}));
}

}  // namespace cistula::verify::metamorphic
