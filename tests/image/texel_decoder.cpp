// Numbers of files become linear Rec. 709, by their curve and their space.
#include "image/color/texel_decoder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cistula/numerics/elementary.h"
#include "testing/support/special_values.h"

namespace cistula {
namespace {

template <class Sample>
std::vector<glm::vec3> texels(std::string_view encoding, const std::vector<Sample>& samples, uint32_t channels = 3,
                              bool is_half = false) {
    std::vector<glm::vec3> result;
    const TexelDecoder decoder(file_encoding(encoding, {}, false), sizeof(Sample), is_half);
    decoder.append({reinterpret_cast<const char*>(samples.data()), samples.size() * sizeof(Sample)}, channels, result);
    return result;
}

TEST(TexelDecoder, CodesAreDividedByTheLargest) {
    for (int i = 0; i < 256; ++i) {
        const auto expected = glm::vec3(static_cast<float>(elementary::srgb_to_linear(i / 255.0)));
        EXPECT_EQ(texels<uint8_t>("srgb", {static_cast<uint8_t>(i)}, 1).at(0), expected);
        EXPECT_EQ(texels<uint16_t>("srgb", {static_cast<uint16_t>(257 * i)}, 1).at(0), expected);
        EXPECT_EQ(texels<uint8_t>("linear", {static_cast<uint8_t>(i)}, 1).at(0),
                  glm::vec3(static_cast<float>(i / 255.0)));
    }
    EXPECT_EQ(texels<uint8_t>("data", {0, 255, 51, 7, 102, 153, 204, 9}, 4),
              (std::vector<glm::vec3>{{0, 1, 0.2f}, {0.4f, 0.6f, 0.8f}}));
    EXPECT_EQ(texels<uint16_t>("g22_rec709_scene", {65535, 0, 32768}).at(0).z,
              static_cast<float>(elementary::pow(32768 / 65535.0, 2.2)));
}

TEST(TexelDecoder, FloatsOfTheOwnSpaceStayTheSameBits) {
    using test::infinity, test::nan;
    const std::vector<float> numbers = {0.1f, -0.0f, 1e-45f, 3.4e38f, -7, infinity};
    const auto found = texels("lin_rec709_scene", numbers);
    for (size_t i = 0; i < numbers.size(); ++i) {
        EXPECT_EQ(found[i / 3][static_cast<int>(i % 3)], numbers[i]);
        EXPECT_EQ(std::signbit(found[i / 3][static_cast<int>(i % 3)]), std::signbit(numbers[i]));
    }
    EXPECT_TRUE(std::isnan(texels("linear", std::vector<float>{nan, 1, 1}).at(0).x));
}

TEST(TexelDecoder, ColorsOfOtherSpacesAreConverted) {
    // ACEScg, by its published matrix to Rec. 709 with Bradford's adaptation.
    const glm::vec3 acescg = texels("lin_ap1_scene", std::vector<float>{0.5f, 0.25f, 0.1f}).at(0);
    const float expected[] = {0.688752f, 0.219018f, 0.071053f};
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(acescg[c], expected[c], 2e-6f);
    // The green of Display P3 is none of Rec. 709's.
    const glm::vec3 green = texels<uint8_t>("srgb_p3d65_scene", {0, 255, 0}).at(0);
    EXPECT_NEAR(green.x, -0.224940f, 1e-6f);
    EXPECT_NEAR(green.y, 1.042057f, 1e-6f);
    EXPECT_NEAR(green.z, -0.078636f, 1e-6f);
}

TEST(TexelDecoder, GrayStaysGrayInAnySpace) {
    for (const ColorEncoding& encoding : color_encodings) {
        const auto curve = static_cast<float>(encoding.curve(static_cast<double>(0.3f)));
        const std::vector<glm::vec3> expected = {glm::vec3(curve)};
        EXPECT_EQ(texels<float>(encoding.name, {0.3f}, 1), expected) << encoding.name;
        EXPECT_EQ(texels<float>(encoding.name, {0.3f, 0.3f, 0.3f}), expected) << encoding.name;
    }
}

TEST(TexelDecoder, WhatIsNegativeByRoundingAloneIsZero) {
    const glm::dmat3 to_ap1 = color_matrix(color_spaces().front(), *find_color_space("lin_ap1_scene"));
    const glm::dvec3 colors[] = {{1, 0, 0}, {0, 0.3, 0}, {0, 0, 7}, {0.2, 0.9, 0}, {0, 1e-6, 2e-6}, {123, 0, 456}};
    int negative = 0;
    for (const glm::dvec3& color : colors) {
        const glm::vec3 stored(to_ap1 * color);
        const glm::vec3 back = texels("lin_ap1_scene", std::vector<float>{stored.x, stored.y, stored.z}).at(0);
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(back[c], 0);
            EXPECT_NEAR(back[c], color[c], 1e-6 * (color.x + color.y + color.z));
        }
        const glm::dvec3 exact =
            color_matrix(*find_color_space("lin_ap1_scene"), color_spaces().front()) * glm::dvec3(stored);
        for (int c = 0; c < 3; ++c) negative += exact[c] < 0;
    }
    EXPECT_GT(negative, 0);  // without that there would be some
    // Halves are rounded more; what is out by more than that is a color that Rec. 709 does not have.
    const std::vector<float> out = {0.5f, 0.0382f, 0.05f};
    EXPECT_LT(texels("lin_ap1_scene", out).at(0).y, -0.01f);
    EXPECT_LT(texels("lin_ap1_scene", out, 3, true).at(0).y, -0.01f);
    const std::vector<float> nearly = {0.5f, 0.05716f, 0.01f};
    EXPECT_LT(texels("lin_ap1_scene", nearly).at(0).y, 0);
    EXPECT_EQ(texels("lin_ap1_scene", nearly, 3, true).at(0).y, 0);
}

}  // namespace
}  // namespace cistula
