// Pictures as they are shown: exposure, the curve that keeps bright colors apart, bloom.
#include "image/view/picture_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "image/color/srgb_codes.h"
#include "testing/support/special_values.h"

namespace cistula {
namespace {

using test::infinity;
using test::nan;

bool same_bits(const ColorPicture& a, const ColorPicture& b) {
    return a.texels.size() == b.texels.size() &&
           std::memcmp(a.texels.data(), b.texels.data(), a.texels.size() * sizeof(glm::vec3)) == 0;
}

/// A black picture with one color.
ColorPicture point(uint32_t width, uint32_t height, uint32_t x, uint32_t y, const glm::vec3& color) {
    ColorPicture picture{width, height, std::vector<glm::vec3>(width * height, glm::vec3(0))};
    picture.texels[y * width + x] = color;
    return picture;
}

TEST(PictureView, TheDefaultChangesNoBit) {
    const ColorPicture picture{2, 2, {{0, 0.5f, 1}, {-1, 100, nan}, {1e-42f, 3, -0.0f}, {infinity, -infinity, 7}}};
    EXPECT_TRUE(same_bits(viewed(picture, {}, 2), picture));
}

TEST(PictureView, AStopDoublesTheLight) {
    const ColorPicture picture{2, 1, {{0.1f, 0.7f, 3}, {0, -2, 1e-30f}}};
    ColorPicture brighter = picture, darker = picture;
    for (glm::vec3& texel : brighter.texels) texel *= 8;
    for (glm::vec3& texel : darker.texels) texel /= 4;
    EXPECT_TRUE(same_bits(viewed(picture, {3, ViewCurve::srgb, 0}, 1), brighter));
    EXPECT_TRUE(same_bits(viewed(picture, {-2, ViewCurve::srgb, 0}, 1), darker));
}

TEST(PictureView, FilmicKeepsMiddleGrayAndTellsBrightGraysApart) {
    const auto code = [](float gray) { return srgb8_from_linear(filmic_color(glm::vec3(gray))[0]); };
    EXPECT_EQ(code(0.18f), srgb8_from_linear(0.18f));
    EXPECT_EQ(code(0), 0);
    // The values that the header names.
    EXPECT_NEAR(filmic_color(glm::vec3(1))[0], 0.63, 0.005);
    EXPECT_NEAR(filmic_color(glm::vec3(4))[0], 0.9, 0.005);
    EXPECT_NEAR(filmic_color(glm::vec3(16))[0], 0.98, 0.005);
    for (float gray = 0x1p-9f; gray < 16; gray *= 2) EXPECT_LT(code(gray), code(2 * gray)) << gray;
    for (const float gray : {1e3f, 1e10f, 3e38f, infinity}) EXPECT_LE(filmic_color(glm::vec3(gray))[0], 1) << gray;
}

/// The hue of HSV: the share that the middle channel has of what the largest has over the smallest.
TEST(PictureView, FilmicKeepsHues) {
    for (const glm::vec3 color : {glm::vec3(1, 0.5f, 0), glm::vec3(0.1f, 0.2f, 0.8f), glm::vec3(3, 9, 6)})
        for (const float factor : {0.01f, 1.0f, 30.0f}) {
            const glm::vec3 shown = filmic_color(factor * color);
            const auto hue = [](glm::vec3 c) {
                std::sort(&c[0], &c[0] + 3);
                return (c[1] - c[0]) / (c[2] - c[0]);
            };
            EXPECT_NEAR(hue(shown), hue(color), 1e-4) << factor;
            EXPECT_LE(std::max({shown[0], shown[1], shown[2]}), 1);
        }
    const glm::vec3 dim = filmic_color({0.1f, 0, 0}), bright = filmic_color({1000, 0, 0});
    EXPECT_LT(dim[1], 1e-4f);
    EXPECT_GT(bright[1], 0.95f);  // white, as film burns out
}

TEST(PictureView, FilmicShowsWhatIsNoColorAsAColor) {
    EXPECT_EQ(filmic_color({nan, nan, nan}), glm::vec3(0));
    EXPECT_EQ(filmic_color({-1, -infinity, 0}), glm::vec3(0));
    const glm::vec3 mixed = filmic_color({infinity, nan, -3});
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(mixed[c] >= 0 && mixed[c] <= 1) << mixed[c];
}

TEST(Bloom, LeavesPicturesThatAreNotAboveWhite) {
    const ColorPicture picture{3, 1, {{1, 1, 1}, {0.5f, 0, 1}, {-3, 0, 0}}};
    EXPECT_TRUE(same_bits(viewed(picture, {0, ViewCurve::srgb, 5}, 1), picture));
}

TEST(Bloom, AddsTheLightAboveWhiteOnceAllAround) {
    const uint32_t side = 129, middle = 64;
    const ColorPicture picture = point(side, side, middle, middle, {11, 5.5f, 0});
    ColorPicture shown = picture;
    add_bloom(shown, 1, side);
    ASSERT_EQ(bloom_radius(side), 2u);
    double sum[3] = {};
    for (const glm::vec3& texel : shown.texels)
        for (int c = 0; c < 3; ++c) sum[c] += static_cast<double>(texel[c]);
    // Of the color 10/11 is above white, whose largest channel is 11.
    EXPECT_NEAR(sum[0], 11 + 10, 1e-4);
    EXPECT_NEAR(sum[1], 5.5 + 5, 1e-4);
    EXPECT_EQ(sum[2], 0);
    const auto at = [&](uint32_t x, uint32_t y) { return shown.texels[y * side + x][0]; };
    for (uint32_t d = 1; d <= 7; ++d) {
        EXPECT_EQ(at(middle + d, middle), at(middle - d, middle)) << d;
        EXPECT_NEAR(at(middle + d, middle), at(middle, middle + d), 1e-7) << d;
        EXPECT_TRUE(d == 7 || at(middle + d, middle) > at(middle + d + 1, middle)) << d;
    }
    EXPECT_GT(at(middle + 6, middle), 0);  // three boxes of half a width of 2
    EXPECT_LT(std::abs(at(middle + 7, middle)), 1e-9f);
}

TEST(Bloom, SpreadsTheSameShareOfEveryHeight) {
    EXPECT_EQ(bloom_radius(1), 1u);
    EXPECT_EQ(bloom_radius(720), 11u);
    EXPECT_EQ(bloom_radius(2160), 33u);
    // A crop spreads as its frame does.
    ColorPicture crop = point(9, 1, 4, 0, {101, 101, 101});
    add_bloom(crop, 1, 192);
    ASSERT_EQ(bloom_radius(192), 3u);
    EXPECT_GT(crop.texels[0][0], 0);
}

TEST(Bloom, IsNotStainedByWhatIsNoColorOrTooBright) {
    for (const float value : {nan, infinity, 3e38f}) {
        ColorPicture picture = point(64, 64, 8, 8, {value, 0, 0});
        picture.texels[40 * 64 + 40] = glm::vec3(3);
        add_bloom(picture, 1, 64);
        for (uint32_t y = 30; y < 64; ++y)
            for (uint32_t x = 0; x < 64; ++x) {
                const glm::vec3& texel = picture.texels[y * 64 + x];
                const bool is_near =
                    std::max(x, 40u) - std::min(x, 40u) <= 3 && std::max(y, 40u) - std::min(y, 40u) <= 3;
                EXPECT_TRUE(is_near ? texel[0] > 0 && texel[0] <= 4 : std::abs(texel[0]) < 1e-6f)
                    << value << " at " << x << "," << y << ": " << texel[0];
            }
    }
}

}  // namespace
}  // namespace cistula
