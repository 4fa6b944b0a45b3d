// The layers of a film as channels of a file: the sums by their names, first hits, and Cryptomatte.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>

#include <nlohmann/json.hpp>

#include "cistula/numerics/fixed_sum.h"
#include "render/record/film_channel.h"
#include "render/record/film_picture.h"

namespace cistula {
namespace {

/// A film of one pixel of four samples: two meet object 1, one object 2, one a visible light.
class FilmLayers : public ::testing::Test {
  protected:
    FilmLayers() {
        channels_.light = channels_.position = channels_.uv = channels_.albedo = channels_.depth_ray =
            channels_.material_id = channels_.object_mattes = channels_.material_mattes = channels_.light_mattes = true;
        for (bool& wanted : channels_.path) wanted = true;
        film_.full_width = film_.full_height = film_.rect.width = film_.rect.height = 1;
        film_.samples = 4;
        film_.fixed_shift = fixed_shift(4);
        film_.pixels.assign(1);
        LayerNames names;
        names.objects = {"b\u00f6x", "ball"};
        names.materials = {"steel"};
        names.object_materials = {0, 0};
        names.visible_lights = {"lamp"};
        names.light_groups = {"key", "fill"};
        begin_layers(film_.layers, layers_for(channels_), 1, std::make_shared<const LayerNames>(names));
        film_.layers.clear(0, 1);
        film_.layers.center[0] = 10;
        film_.layers.unit_length = 2;
        const LayerPlan& plan = film_.layers.plan;
        const int64_t one = int64_t{4} << film_.fixed_shift;  // the sum of a mean of 1
        for (int layer = 0; layer < path_layer_count; ++layer) word(plan.path + 3 * layer + 1) = one / 64 * (layer + 1);
        for (int layer = 0; layer < 5; ++layer) word(plan.light + 3 * layer) = one / 128 * (layer + 1);
        word(plan.objects) = int64_t{1} << object_shift | 2;
        word(plan.objects + 1) = int64_t{3} << object_shift | 1;
        word(plan.objects + 2) = int64_t{2} << object_shift | 1;
        const FirstHit hit{{0.5, -1, 0.25}, {0.125f, 0.75f}, {0.5f, 0.25f, 1}, 7.5f, 1, 1};
        std::memcpy(&word(plan.first_hit), &hit, sizeof hit);
    }

    std::vector<std::string> light_layers() const {
        std::vector<std::string> names;
        for (const auto& channel : to_layers(film_, channels_).channels)
            if (channel.name.starts_with("Combined_") && channel.name.ends_with(".R")) names.push_back(channel.name);
        return names;
    }
    int64_t& word(int i) { return film_.layers.words[static_cast<size_t>(i)]; }
    float value(std::string_view name) const {
        const LayeredPicture picture = to_layers(film_, channels_);
        for (const auto& channel : picture.channels)
            if (channel.name == name) return channel.values[0];
        ADD_FAILURE() << "no channel " << name;
        return 0;
    }

    Film film_;
    OutputChannels channels_;
};

TEST_F(FilmLayers, SingleLayersOfLightsAreThoseOfAll) {
    const float fill = value("Combined_fill.R");
    EXPECT_EQ(light_layers().size(), 5u);
    channels_.light_layers = {"fill", "glow"};
    EXPECT_EQ(light_layers(), (std::vector<std::string>{"Combined_glow.R", "Combined_fill.R"}));
    EXPECT_EQ(value("Combined_fill.R"), fill);
}

TEST_F(FilmLayers, DivisionsStandUnderTheirNames) {
    EXPECT_EQ(value("emission.G"), 1.0f / 64);
    EXPECT_EQ(value("transmission.G"), 7.0f / 64);
    EXPECT_EQ(value("transmission.R"), 0.0f);
    EXPECT_EQ(value("Combined_ambient.R"), 1.0f / 128);
    EXPECT_EQ(value("Combined_environment.R"), 2.0f / 128);
    EXPECT_EQ(value("Combined_glow.R"), 3.0f / 128);
    EXPECT_EQ(value("Combined_key.R"), 4.0f / 128);
    EXPECT_EQ(value("Combined_fill.R"), 5.0f / 128);
}

TEST_F(FilmLayers, ATransparentBackgroundLeavesItsLayersToo) {
    const int64_t one = int64_t{4} << film_.fixed_shift;
    film_.background[1] = one / 128;  // what each of the four samples added: nothing was hit
    EXPECT_EQ(value("background.G"), 2.0f / 64);
    channels_.transparent = true;
    EXPECT_EQ(value("background.G"), 0.0f);
    EXPECT_EQ(value("emission.G"), 1.0f / 64);
}

TEST_F(FilmLayers, FirstHitsAreInTheScene) {
    EXPECT_EQ(value("P.X"), 11.0f);
    EXPECT_EQ(value("P.Y"), -2.0f);
    EXPECT_EQ(value("P.Z"), 0.5f);
    EXPECT_EQ(value("uv.U"), 0.125f);
    EXPECT_EQ(value("uv.V"), 0.75f);
    EXPECT_EQ(value("albedo.B"), 1.0f);
    EXPECT_EQ(value("depth_ray"), 7.5f);
    EXPECT_EQ(value("material_id"), 1.0f);
    std::memset(&word(film_.layers.plan.first_hit), 0, sizeof(FirstHit));
    EXPECT_EQ(value("depth_ray"), 1e10f);
    EXPECT_EQ(value("P.X"), 0.0f);
}

/// Ids and coverage, the largest first.
TEST_F(FilmLayers, MattesAreRankedByCoverage) {
    EXPECT_EQ(value("CryptoObject00.r"), cryptomatte_id("b\u00f6x"));
    EXPECT_EQ(value("CryptoObject00.g"), 0.5f);
    EXPECT_EQ(value("CryptoObject00.b"), cryptomatte_id("ball"));
    EXPECT_EQ(value("CryptoObject00.a"), 0.25f);
    EXPECT_EQ(value("CryptoObject01.r"), 0.0f);
    EXPECT_EQ(value("CryptoObject01.g"), 0.0f);
    EXPECT_EQ(value("CryptoMaterial00.r"), cryptomatte_id("steel"));
    EXPECT_EQ(value("CryptoMaterial00.g"), 0.75f);
    EXPECT_EQ(value("CryptoLight00.r"), cryptomatte_id("lamp"));
    EXPECT_EQ(value("CryptoLight00.g"), 0.25f);
}

/// Large frames are encoded by all cores, each with ranks of its own.
TEST_F(FilmLayers, MattesOfManyPixelsAreThoseOfEach) {
    constexpr int side = 512;
    film_.full_width = film_.full_height = film_.rect.width = film_.rect.height = side;
    film_.pixels.assign(size_t{side} * side);
    begin_layers(film_.layers, layers_for(channels_), film_.pixels.size(), film_.layers.names);
    film_.layers.clear(0, film_.pixels.size());
    const auto coverage = [](size_t pixel) { return static_cast<int64_t>(pixel / 1024 % 4 + 1); };
    for (size_t pixel = 0; pixel < film_.pixels.size(); ++pixel)
        film_.layers.of(pixel)[film_.layers.plan.objects] =
            int64_t{static_cast<int>(pixel % 2) + 1} << object_shift | coverage(pixel);
    const float ids[] = {cryptomatte_id("b\u00f6x"), cryptomatte_id("ball")};
    for (int round = 0; round < 4; ++round)
        for (const auto& channel : to_layers(film_, channels_).channels) {
            size_t wrong = 0;
            for (size_t pixel = 0; pixel < channel.values.size(); ++pixel) {
                wrong += channel.name == "CryptoObject00.r" && channel.values[pixel] != ids[pixel % 2];
                wrong += channel.name == "CryptoObject00.g" &&
                         channel.values[pixel] != static_cast<float>(coverage(pixel)) / 4;
            }
            EXPECT_EQ(wrong, 0u) << channel.name;
        }
}

TEST_F(FilmLayers, TheHeaderTellsNamesByIds) {
    const auto attributes = to_layers(film_, channels_).attributes;
    const auto text = [&](const std::string& name) {
        return std::get<std::string>(attributes.at("cryptomatte/" + name));
    };
    EXPECT_EQ(text("3ae39a5/name"), "CryptoObject");  // the key is the hash of the name, as in files of other renderers
    EXPECT_EQ(text("3ae39a5/hash"), "MurmurHash3_32");
    EXPECT_EQ(text("3ae39a5/conversion"), "uint32_to_float32");
    const auto manifest = nlohmann::json::parse(text("3ae39a5/manifest"));
    ASSERT_EQ(manifest.size(), 2u);
    for (const char* name : {"b\u00f6x", "ball"})
        EXPECT_EQ(std::stoul(manifest[name].get<std::string>(), nullptr, 16),
                  std::bit_cast<uint32_t>(cryptomatte_id(name)));
}

/// Values of MurmurHash3_x86_32 with seed 0 by another implementation.
TEST(Murmur3, HasItsKnownValues) {
    EXPECT_EQ(murmur3(""), 0u);
    EXPECT_EQ(murmur3("test"), 0xba6bd213u);
    EXPECT_EQ(murmur3("Hello, world!"), 0xc0363e43u);
    EXPECT_EQ(murmur3("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
    // Lengths with each number of bytes after the last whole word.
    EXPECT_EQ(murmur3("a"), 0x3c2569b2u);
    EXPECT_EQ(murmur3("aa"), 0x371091a9u);
    EXPECT_EQ(murmur3("aaa"), 0xb4d05fb7u);
    EXPECT_EQ(murmur3("aaaa"), 0x7eeed987u);
}

TEST(Murmur3, IdsAreNormalNumbers) {
    for (int i = 0; i < 20000; ++i) {
        const float id = cryptomatte_id("object" + std::to_string(i));
        EXPECT_TRUE(std::isnormal(id)) << i;
    }
}

}  // namespace
}  // namespace cistula
