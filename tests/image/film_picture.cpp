// The integers of a film as channels: exact values, a ledger that stays a bound, a hash that sees every field.
#include "render/record/film_picture.h"

#include <Imath/half.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>
#include <string_view>

#include "cistula/numerics/fixed_sum.h"
#include "render/record/film_difference.h"
#include "testing/support/special_values.h"

namespace cistula {
namespace {

using test::infinity;

Film film_of(int samples, int exponent, const std::vector<PixelRecord>& pixels) {
    Film film;
    film.full_width = 64;
    film.full_height = 48;
    film.rect = {7, 5, static_cast<int>(pixels.size()), 1};
    film.samples = samples;
    film.fixed_shift = fixed_shift(static_cast<uint32_t>(samples));
    film.radiance_exponent = exponent;
    film.pixels.begin(pixels.size());
    for (size_t i = 0; i < pixels.size(); ++i) film.pixels.set(i, pixels[i]);
    return film;
}

PixelRecord some_pixel() {
    return {{{1, 2, 3}, 10, 0, 0, 0, 0}, {{4, 5, 6}, {7, 8, 9}}, {12, 13.5f, {0.5f, -0.5f, 0.25f}, 11}};
}

const LayeredPicture::Channel& channel(const LayeredPicture& picture, std::string_view name) {
    for (const auto& each : picture.channels)
        if (each.name == name) return each;
    throw std::runtime_error("no channel " + std::string(name));
}

constexpr OutputChannels everything{false, true, true, true, true, true, true};
constexpr OutputChannels everything_half{true, true, true, true, true, true, true};

TEST(FilmPicture, ChannelsAndWindows) {
    const Film film = film_of(1, 0, {some_pixel(), some_pixel()});
    const auto names = [](const LayeredPicture& picture) {
        std::string all;
        for (const auto& each : picture.channels) all += each.name + (each.half ? "h " : " ");
        return all;
    };
    EXPECT_EQ(names(to_layers(film, {})), "R G B A ");
    EXPECT_EQ(names(to_layers(film, everything)), "R G B A error.R error.G error.B id samples cost Z N.X N.Y N.Z ");
    EXPECT_EQ(names(to_layers(film, everything_half)),
              "Rh Gh Bh Ah error.Rh error.Gh error.Bh id samples cost Z N.Xh N.Yh N.Zh ");
    OutputChannels z_only;
    z_only.z = true;
    EXPECT_EQ(names(to_layers(film, z_only)), "R G B A Z ");
    const LayeredPicture picture = to_layers(film, everything);
    EXPECT_EQ(picture.x, 7);
    EXPECT_EQ(picture.y, 5);
    EXPECT_EQ(picture.width, 2);
    EXPECT_EQ(picture.height, 1);
    EXPECT_EQ(picture.display_width, 64);
    EXPECT_EQ(picture.display_height, 48);
}

TEST(FilmPicture, Values) {
    const int64_t one = int64_t(1) << 60;  // four samples
    const PixelRecord lit = {
        {{4 * one, 2 * one, one}, 3, 4, 0, 0, 0}, {{one, 0, 0}, {one, 3 * one, 0}}, {5, 2.5f, {0, 0.6f, -0.8f}, 77}};
    const PixelRecord empty = {{{0, 0, 0}, 0, 9, 0, 0, 0}, {{0, 0, 0}, {0, 0, 0}}, {0, infinity, {0, 0, 0}, 4}};
    const Film film = film_of(4, 3, {lit, empty});
    const LayeredPicture picture = to_layers(film, everything);
    const auto expect = [&](const char* name, float first, float second) {
        EXPECT_EQ(channel(picture, name).values, (std::vector<float>{first, second})) << name;
    };
    expect("R", 8, 0);
    expect("G", 4, 0);
    expect("B", 2, 0);
    expect("A", 1, 1);
    // A unit for each ray, rounded up: of 77 and 4 rays 20 and 1 in the mean.
    expect("error.R", std::nextafter(4.0f, 5.0f), 0x1p-57f);
    expect("error.G", std::nextafter(6.0f, 7.0f), 0x1p-57f);
    expect("error.B", 20 * 0x1p-57f, 0x1p-57f);
    expect("id", 5, 0);
    expect("samples", 4, 9);  // each pixel's own
    expect("cost", 77, 4);
    expect("Z", 2.5f, 1e10f);
    expect("N.X", 0, 0);
    expect("N.Y", 0.6f, 0);
    expect("N.Z", -0.8f, 0);
    const ColorPicture color = to_color(film);
    EXPECT_EQ(color.width, 2u);
    EXPECT_EQ(color.height, 1u);
    EXPECT_EQ(color.texels, (std::vector<glm::vec3>{{8, 4, 2}, {0, 0, 0}}));
}

TEST(FilmPicture, BackgroundsAreOpaqueOrTransparent) {
    // Two of four samples of the first pixel met something, none of the second.
    const int64_t one = int64_t(1) << 60;
    PixelRecord half_covered = some_pixel(), empty = some_pixel();
    half_covered.hits = 2;
    half_covered.z = 4;
    empty.hits = 0;
    empty.z = infinity;
    const int64_t background[3] = {one, one / 2, 0};
    for (int c = 0; c < 3; ++c) {
        half_covered.radiance[c] = one + 2 * background[c];
        empty.radiance[c] = 4 * background[c];
    }
    Film film = film_of(4, 0, {half_covered, empty});
    std::copy(background, background + 3, film.background);
    OutputChannels channels;
    channels.coverage = channels.z = true;
    const auto expect = [&](const char* name, float first, float second) {
        EXPECT_EQ(channel(to_layers(film, channels), name).values, (std::vector<float>{first, second})) << name;
    };
    expect("R", 0.75f, 1);
    expect("G", 0.5f, 0.5f);
    expect("A", 1, 1);
    expect("coverage", 0.5f, 0);
    expect("Z", 4, 1e10f);
    channels.transparent = true;
    channels.z_far = infinity;
    for (const char* name : {"R", "G", "B"}) expect(name, 0.25f, 0);
    expect("A", 0.5f, 0);
    expect("coverage", 0.5f, 0);
    expect("Z", 4, infinity);
    const ColorPicture shown = to_color(film, true);  // of what was hit, not premultiplied
    EXPECT_EQ(shown.texels, (std::vector<glm::vec3>{glm::vec3(0.5f), glm::vec3(0)}));
    EXPECT_EQ(shown.alpha, (std::vector<float>{0.5f, 0}));
    EXPECT_TRUE(to_color(film).alpha.empty());
}

TEST(FilmPicture, ColorsAreThoseOfTheSpace) {
    const int64_t one = int64_t(1) << 60;
    PixelRecord gray = some_pixel(), red = some_pixel();
    for (int c = 0; c < 3; ++c) gray.radiance[c] = 3 * one;
    red.radiance[0] = 4 * one;
    red.radiance[1] = red.radiance[2] = 0;
    red.pruned[0] = red.cut[0] = red.cut[1] = red.cut[2] = red.pruned[2] = 0;
    red.pruned[1] = 2 * one;
    const Film film = film_of(4, 0, {gray, red});
    for (const ColorSpace& space : color_spaces()) {
        OutputChannels channels;
        channels.error = true;
        channels.space = &space;
        const LayeredPicture picture = to_layers(film, channels);
        const bool own = &space == &color_spaces().front();
        const glm::dmat3 matrix = own ? glm::dmat3(1.0) : color_matrix(color_spaces().front(), space);
        for (int c = 0; c < 3; ++c) {
            const std::string name(1, "RGB"[c]);
            EXPECT_NEAR(channel(picture, name).values[0], 0.75f, 1e-6) << space.id;
            EXPECT_NEAR(channel(picture, name).values[1], matrix[0][c], 1e-6) << space.id;
            EXPECT_GE(channel(picture, "error." + name).values[1], std::abs(matrix[1][c]) / 2) << space.id;
            EXPECT_NEAR(channel(picture, "error." + name).values[1], std::abs(matrix[1][c]) / 2, 1e-6) << space.id;
        }
    }
}

TEST(FilmPicture, LedgerRoundsUpByTheLeastStep) {
    std::mt19937_64 random(1);
    const long double unit = std::ldexp(1.0L, -62);
    for (const int exponent : {0, -40, 90}) {
        for (int i = 0; i < 20000; ++i) {
            const int bits = static_cast<int>(random() % 62);
            const auto value = static_cast<int64_t>(random() % (uint64_t(1) << bits | 1));
            PixelRecord pixel = some_pixel();
            pixel.pruned[0] = value / 3;
            pixel.cut[0] = value - value / 3;
            pixel.rays = 0;
            const Film film = film_of(1, exponent, {pixel});
            const long double exact = std::ldexp(static_cast<long double>(value) * unit, exponent);
            const float bound = channel(to_layers(film, everything), "error.R").values[0];
            ASSERT_GE(static_cast<long double>(bound), exact) << value;
            if (bound > 0) {
                ASSERT_LT(static_cast<long double>(std::nextafter(bound, 0.0f)), exact) << value;
            }
            const float half_bound = channel(to_layers(film, everything_half), "error.R").values[0];
            if (bound > largest_half) {
                ASSERT_EQ(half_bound, largest_half);
                continue;
            }
            ASSERT_GE(half_bound, bound);
            if (half_bound > 0) {
                half below(half_bound);
                ASSERT_EQ(static_cast<float>(below), half_bound) << "not a half";
                below.setBits(static_cast<uint16_t>(below.bits() - 1));
                ASSERT_LT(static_cast<float>(below), bound);
            }
        }
    }
}

TEST(FilmPicture, LedgerRoundsUpOverSamples) {
    PixelRecord pixel = some_pixel();
    pixel.pruned[0] = 1;  // a ninth of the smallest unit is not nothing
    pixel.cut[0] = 0;
    pixel.pruned[1] = pixel.cut[1] = std::numeric_limits<int64_t>::max();
    pixel.rays = 0;
    const Film film = film_of(9, 0, {pixel});
    ASSERT_EQ(film.fixed_shift, 58);
    const LayeredPicture picture = to_layers(film, everything);
    EXPECT_EQ(channel(picture, "error.R").values[0], 0x1p-58f);
    const float bound = channel(picture, "error.G").values[0];  // of 64 / 9, less a unit
    EXPECT_GE(9.0 * bound, 64);
    EXPECT_LT(9.0 * std::nextafter(bound, 0.0f), 64);
    const Film bright = film_of(1, 20, {pixel});
    EXPECT_EQ(channel(to_layers(bright, everything_half), "error.G").values[0], largest_half);
}

TEST(FilmPicture, LedgerHasAUnitForEachRayTimesWhatItsSampleStandsFor) {
    PixelRecord pixel = some_pixel();
    for (int c = 0; c < 3; ++c) pixel.pruned[c] = pixel.cut[c] = 0;
    pixel.rays = 1 << 20;
    const auto error_of = [&](uint32_t samples, int film_samples) {
        pixel.samples = samples;
        return channel(to_layers(film_of(film_samples, 0, {pixel}), everything), "error.G").values[0];
    };
    EXPECT_EQ(error_of(16, 16), 0x1p-58f * (1 << 20) / 16);
    EXPECT_EQ(error_of(256, 256), 0x1p-54f * (1 << 20) / 256);
    EXPECT_EQ(error_of(16, 256), 0x1p-54f * (1 << 20) / 256 * 16);
    EXPECT_EQ(error_of(5, 256), 0x1p-54f * (1 << 20) / 256 * 160);
    pixel.pruned[1] = pixel.cut[1] = std::numeric_limits<int64_t>::max();
    EXPECT_GE(error_of(16, 16), 0x1p64f / 0x1p58f / 16);
}

TEST(FilmPicture, HalfChannelsAreClampedToTheLargestHalf) {
    EXPECT_EQ(largest_half, static_cast<float>(std::numeric_limits<half>::max()));
    PixelRecord dim = some_pixel(), bright = some_pixel();
    for (PixelRecord* pixel : {&dim, &bright}) {
        for (int c = 0; c < 3; ++c) pixel->pruned[c] = pixel->cut[c] = 0;
        pixel->rays = 0;
    }
    const int64_t most = int64_t(65504) << 42;  // in units of 2^-62 and radiances of 2^20
    dim.radiance[0] = most, dim.radiance[1] = most / 2, dim.radiance[2] = 0;
    bright.radiance[0] = most + (int64_t(1) << 42), bright.radiance[1] = most + (int64_t(1) << 36);
    bright.radiance[2] = most << 3;
    dim.cut[0] = most;
    bright.pruned[2] = most + 1;  // rounded up
    dim.z = 1e30f;
    const Film film = film_of(1, 20, {dim, bright, dim});
    uint64_t clamped = 0;
    const LayeredPicture picture = to_layers(film, everything_half, &clamped);
    EXPECT_EQ(clamped, 4u);
    EXPECT_EQ(channel(picture, "R").values, (std::vector<float>{65504, 65504, 65504}));
    EXPECT_EQ(channel(picture, "G").values, (std::vector<float>{32752, 65504, 32752}));
    EXPECT_EQ(channel(picture, "B").values, (std::vector<float>{0, 65504, 0}));
    EXPECT_EQ(channel(picture, "error.R").values[0], 65504);
    EXPECT_EQ(channel(picture, "error.B").values[1], 65504);
    for (const LayeredPicture::Channel& one : picture.channels)
        for (const float value : one.values)
            EXPECT_TRUE(!one.half || std::isfinite(static_cast<float>(half(value)))) << one.name;
    EXPECT_EQ(channel(picture, "Z").values[0], 1e30f);
    // Floats hold them.
    clamped = 0;
    EXPECT_EQ(channel(to_layers(film, everything, &clamped), "R").values[1], 65505);
    EXPECT_EQ(clamped, 0u);
}

TEST(FilmPicture, HashIsFnv1a) {
    // An empty film gives the offset basis of the published 128-bit FNV-1a.
    EXPECT_EQ(film_hash(Film()), "6c62272e07bb014262b821756295c58d");
    // Over zero bytes FNV-1a multiplies by the prime 2^88 + 0x13b; 32 bytes a pixel.
    Film film = film_of(1, 0, {PixelRecord{}});
    __extension__ typedef unsigned __int128 Wide;
    Wide state = (static_cast<Wide>(0x6c62272e07bb0142u) << 64) + 0x62b821756295c58du;
    for (int i = 0; i < 32; ++i) state *= (static_cast<Wide>(1) << 88) + 0x13b;
    char text[33];
    std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(state >> 64),
                  static_cast<unsigned long long>(state));
    EXPECT_EQ(film_hash(film), text);
}

/// Expects that a hash sees each of these changes of a pixel.
template <class Hash>
void expect_seen(const Hash& hash, const std::vector<std::function<void(PixelRecord&)>>& changes) {
    const Film film = film_of(1, 0, {some_pixel(), some_pixel()});
    std::set<std::string> hashes = {hash(film)};
    for (const auto& change : changes) {
        Film other = film;
        other.pixels.change(1, change);
        hashes.insert(hash(other));
    }
    EXPECT_EQ(hashes.size(), 1 + changes.size());
}

TEST(FilmPicture, HashSeesRadianceHitsAndSamplesAndNothingElse) {
    std::vector<std::function<void(PixelRecord&)>> seen, others;
    for (int c = 0; c < 3; ++c) {
        seen.emplace_back([c](PixelRecord& p) { p.radiance[c] ^= int64_t(1) << 61; });
        others.emplace_back([c](PixelRecord& p) { p.pruned[c] ^= 1; });
        others.emplace_back([c](PixelRecord& p) { p.cut[c] ^= 1; });
        others.emplace_back([c](PixelRecord& p) { p.normal[c] = -p.normal[c]; });
    }
    seen.emplace_back([](PixelRecord& p) { ++p.hits; });
    seen.emplace_back([](PixelRecord& p) { std::swap(p.radiance[0], p.radiance[1]); });
    others.emplace_back([](PixelRecord& p) { ++p.rays; });
    others.emplace_back([](PixelRecord& p) { p.id = -p.id; });
    others.emplace_back([](PixelRecord& p) { p.z = std::nextafter(p.z, 0.0f); });
    std::vector<std::function<void(PixelRecord&)>> all = seen;
    all.insert(all.end(), others.begin(), others.end());
    expect_seen(record_hash, all);
    seen.emplace_back([](PixelRecord& p) { ++p.samples; });
    expect_seen(film_hash, seen);

    const Film film = film_of(1, 0, {some_pixel(), some_pixel()});
    Film bare = film;
    bare.pixels.assign(2, some_pixel(), {false, false});
    EXPECT_EQ(film_hash(bare), film_hash(film));
    Film same = film;
    same.full_width = 1000;
    same.rect = {1, 2, 1, 2};
    same.radiance_exponent = 3;
    same.samples = 16;
    same.fixed_shift = 58;
    same.rays.primary = 5;
    same.flags = 1;
    EXPECT_EQ(film_hash(same), film_hash(film));
}

TEST(FilmPicture, NeedsThePartsOfItsChannels) {
    Film film = film_of(1, 0, {some_pixel()});
    const auto values = [&](const OutputChannels& channels) {
        std::vector<float> all;
        for (const auto& each : to_layers(film, channels).channels) all.push_back(each.values.at(0));
        return all;
    };
    for (bool OutputChannels::*one : {&OutputChannels::error, &OutputChannels::id, &OutputChannels::samples,
                                      &OutputChannels::cost, &OutputChannels::z, &OutputChannels::normal}) {
        OutputChannels channels;
        channels.*one = true;
        film.pixels.assign(1, some_pixel());
        const std::vector<float> expected = values(channels);
        const KeptParts parts = parts_for(channels);
        film.pixels.assign(1, some_pixel(), parts);
        EXPECT_EQ(values(channels), expected);
        if (!parts.losses && !parts.sights) continue;
        film.pixels.assign(1, some_pixel(), {false, false});
        EXPECT_THROW(to_layers(film, channels), std::invalid_argument);
    }
}

TEST(FilmPicture, RefusesInconsistentFilms) {
    Film film = film_of(1, 0, {some_pixel()});
    film.rect.width = 2;
    EXPECT_THROW(to_layers(film, {}), std::invalid_argument);
    EXPECT_THROW(to_color(film), std::invalid_argument);
}

}  // namespace
}  // namespace cistula
