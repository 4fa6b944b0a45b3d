// What each kind of layer looks like, as codes of the PNG.
#include "apps/render_view/show.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "apps/render_view/id_colors.h"
#include "image/color/color_space.h"
#include "image/color/srgb_codes.h"
#include "testing/support/special_values.h"

namespace cistula {
namespace {

using Codes = std::vector<std::array<int, 3>>;

using test::infinity;
using test::nan;

std::array<int, 3> code(const glm::vec3& color) {
    return {srgb8_from_linear(color[0]), srgb8_from_linear(color[1]), srgb8_from_linear(color[2])};
}

/// Pictures of one row.
class Show : public testing::Test {
  protected:
    void give(const std::vector<std::vector<float>>& values) {
        channels_.clear();
        for (const std::vector<float>& one : values) channels_.push_back({"", ExrChannel::Type::float_, 1, 1, one, {}});
        part_.width = static_cast<int>(values[0].size());
        part_.height = 1;
        part_.full_height = 10;
    }

    Codes codes(LayerKind kind) {
        std::vector<const ExrChannel*> all;
        for (const ExrChannel& channel : channels_) all.push_back(&channel);
        shown_ = show_layer({"x", kind, 0, {}}, part_, all, view_, exposed_);
        Codes codes;
        for (const glm::vec3& texel : shown_.picture.texels) codes.push_back(code(texel));
        return codes;
    }

    ExrPart part_;
    std::vector<ExrChannel> channels_;
    PictureView view_;
    bool exposed_ = false;
    ShownLayer shown_;
};

TEST_F(Show, ColorsAndLuminanceThroughTheView) {
    give({{0, 0.5f, -1}, {1, 0.25f, 9}, {0.1f, 0.125f, 0}});
    EXPECT_EQ(codes(LayerKind::color), (Codes{code({0, 1, 0.1f}), code({0.5f, 0.25f, 0.125f}), {0, 255, 0}}));
    view_ = {1, ViewCurve::filmic, 0};
    EXPECT_EQ(codes(LayerKind::color)[1], code(filmic_color({1, 0.5f, 0.25f})));
    give({{0.18f, 4}});
    view_.exposure = 0;
    EXPECT_EQ(codes(LayerKind::luminance), (Codes{code(glm::vec3(0.18f)), code(filmic_color(glm::vec3(4)))}));
}

TEST_F(Show, ColorsOfOtherPrimariesAsThoseOfSrgb) {
    const ColorSpace& ap1 = *find_color_space("lin_ap1_scene");
    const auto chromaticities = [&](const ColorSpace& s) {
        std::vector<float> xy;
        for (const auto* point : {s.red, s.green, s.blue, s.white})
            for (int i = 0; i < 2; ++i) xy.push_back(static_cast<float>(point[i]));
        return xy;
    };
    const glm::dvec3 red = color_matrix(color_spaces().front(), ap1) * glm::dvec3(0.6, 0.1, 0.2);
    give({{static_cast<float>(red[0]), 1}, {static_cast<float>(red[1]), 1}, {static_cast<float>(red[2]), 1}});
    part_.attributes["chromaticities"] = chromaticities(ap1);
    EXPECT_EQ(codes(LayerKind::color), (Codes{code({0.6f, 0.1f, 0.2f}), {255, 255, 255}}));
    EXPECT_EQ(shown_.values, "from the file's color space to that of sRGB");
    part_.attributes["chromaticities"] = chromaticities(color_spaces().front());
    EXPECT_EQ(codes(LayerKind::color)[0], code(glm::vec3(red)));
    EXPECT_EQ(shown_.values, "");
    for (const std::vector<float>& damaged : {std::vector<float>(8, 0), {1, 2}, std::vector<float>(8, nan)}) {
        part_.attributes["chromaticities"] = damaged;
        EXPECT_EQ(codes(LayerKind::color)[0], code(glm::vec3(red)));
    }
}

/// IDs and the flag of an ACES container as textures have them; what is not known is said.
TEST_F(Show, ColorsOfNamedSpacesAsThoseOfSrgb) {
    const ColorSpace &ap0 = *find_color_space("lin_ap0_scene"), &own = color_spaces().front();
    const glm::dvec3 red = color_matrix(own, ap0) * glm::dvec3(0.6, 0.1, 0.2);
    give({{static_cast<float>(red[0])}, {static_cast<float>(red[1])}, {static_cast<float>(red[2])}});
    part_.attributes["colorInteropID"] = std::string("lin_ap0_scene");
    EXPECT_EQ(codes(LayerKind::color), (Codes{code({0.6f, 0.1f, 0.2f})}));
    part_.attributes = {{"acesImageContainerFlag", 1}};
    EXPECT_EQ(codes(LayerKind::color), (Codes{code({0.6f, 0.1f, 0.2f})}));
    part_.attributes = {{"colorInteropID", std::string("data")}};
    EXPECT_EQ(codes(LayerKind::color), (Codes{code(glm::vec3(red))}));
    EXPECT_EQ(shown_.values, "");
    part_.attributes = {{"colorInteropID", std::string("acme")}};
    EXPECT_EQ(codes(LayerKind::color), (Codes{code(glm::vec3(red))}));
    EXPECT_EQ(shown_.values, "numbers as they are, as its colorInteropID 'acme' is not known");
    give({{0.5f}, {0.25f}, {1}});
    part_.attributes = {{"colorInteropID", std::string("srgb_rec709_scene")}};
    EXPECT_EQ(codes(LayerKind::color), (Codes{{128, 64, 255}}));
}

TEST_F(Show, LuminanceAndChromaAsColors) {
    const glm::dvec3 weights = luminance_weights(color_spaces().front());
    const glm::vec3 color(0.5f, 0.25f, 0.125f);
    const auto y = static_cast<float>(dot(glm::dvec3(color), weights));
    give({{(color[0] - y) / y, 0}, {y, 0.25f}, {(color[2] - y) / y, 0}});
    EXPECT_EQ(codes(LayerKind::chroma), (Codes{code(color), code(glm::vec3(0.25f))}));
}

TEST_F(Show, IdsInTheirColors) {
    give({{0, 1, 2, 1, 0.5f}});
    EXPECT_EQ(codes(LayerKind::ids), (Codes{{0, 0, 0},
                                            code(id_color(1)),
                                            code(id_color(2)),
                                            code(id_color(1)),
                                            code(id_color(std::bit_cast<uint32_t>(0.5f)))}));
    channels_[0].numbers = {(1u << 24) + 1, 1u << 24, 0, 5, 6};  // two that floats do not tell apart
    for (size_t i = 0; i < 5; ++i) channels_[0].values[i] = static_cast<float>(channels_[0].numbers[i]);
    const Codes exact = codes(LayerKind::ids);
    EXPECT_NE(exact[0], exact[1]);
    EXPECT_EQ(exact[0], code(id_color((1u << 24) + 1)));
}

TEST_F(Show, MattesAsTheColorsOfTheirIdsByCoverage) {
    const float a = 1.5f, b = -3e-5f;
    give({{a, a, a, 0}, {1, 0.25f, 2, 0}, {b, b, 0, 0}, {0, 0.75f, 0, 0}});
    const glm::vec3 color_a = id_color(id_of(a)), color_b = id_color(id_of(b));
    EXPECT_EQ(codes(LayerKind::mattes),
              (Codes{code(color_a), code(0.25f * color_a + 0.75f * color_b), code(color_a), {0, 0, 0}}));
}

TEST_F(Show, NearDepthsBrightFarOnesDarkAndNothingBlack) {
    give({{2, 4, 3, 1e10f, infinity, 2e10f, nan, -infinity}});
    EXPECT_EQ(codes(LayerKind::depth), (Codes{{255, 255, 255},
                                              {32, 32, 32},
                                              {143, 143, 143},
                                              {0, 0, 0},
                                              {0, 0, 0},
                                              {0, 0, 0},
                                              {255, 0, 255},
                                              {0, 255, 255}}));
    EXPECT_EQ(shown_.values, "2 bright to 4 dark");
    EXPECT_EQ(shown_.nans, 1u);
    EXPECT_EQ(shown_.infinities, 1u);
    part_.attributes["cistula:zFar"] = 4.0;
    EXPECT_EQ(codes(LayerKind::depth)[1], (std::array<int, 3>{0, 0, 0}));
    EXPECT_EQ(shown_.values, "2 bright to 3 dark");
    part_.attributes.clear();
    give({{5, 5}});
    EXPECT_EQ(codes(LayerKind::depth), (Codes{{255, 255, 255}, {255, 255, 255}}));
    give({{infinity, 1e10f}});
    EXPECT_EQ(codes(LayerKind::depth), (Codes{{0, 0, 0}, {0, 0, 0}}));
    EXPECT_EQ(shown_.values, "nothing");
}

TEST_F(Show, NormalsAndPlacesAndTextureCoordinates) {
    give({{0, 1, -1, 0, 7}, {0, 0, 0, -1, 0}, {1, 0, 0, 0, 0}});
    EXPECT_EQ(codes(LayerKind::normals),
              (Codes{{128, 128, 255}, {255, 128, 128}, {0, 128, 128}, {128, 0, 128}, {255, 128, 128}}));
    give({{0}, {0}, {0}});
    EXPECT_EQ(codes(LayerKind::normals), (Codes{{0, 0, 0}}));
    give({{-10, 10, 0, 1e10f}, {3, 3, 3, 3}, {0, 5, 1, 0}});
    EXPECT_EQ(codes(LayerKind::vectors), (Codes{{0, 0, 0}, {255, 0, 255}, {128, 0, 51}, {0, 0, 0}}));
    EXPECT_EQ(shown_.values, "X -10 to 10, Y 3 to 3, Z 0 to 5");
    give({{0.2f, 3.2f, -0.8f}, {0.6f, 0, 1.4f}});
    EXPECT_EQ(codes(LayerKind::texture), (Codes{{51, 153, 0}, {51, 0, 0}, {51, 102, 0}}));
}

TEST_F(Show, ScalarsByTheirLargestOrByTheExposure) {
    give({{0, 50, 100, -3}});
    EXPECT_EQ(codes(LayerKind::scalar), (Codes{{0, 0, 0}, {188, 188, 188}, {255, 255, 255}, {0, 0, 0}}));
    EXPECT_EQ(shown_.values, "-3 to 100");
    exposed_ = true;
    view_.exposure = -8;
    EXPECT_EQ(codes(LayerKind::scalar)[2], code(glm::vec3(100 / 256.0f)));
    exposed_ = false;
    give({{0, -2}});
    EXPECT_EQ(codes(LayerKind::scalar), (Codes{{0, 0, 0}, {0, 0, 0}}));
}

/// In every kind, and what is beside stays as it is without them.
TEST_F(Show, WhatIsNotFiniteIsVisibleAndHarmless) {
    for (const LayerKind kind :
         {LayerKind::color, LayerKind::luminance, LayerKind::ids, LayerKind::mattes, LayerKind::depth,
          LayerKind::normals, LayerKind::vectors, LayerKind::texture, LayerKind::scalar}) {
        const bool of_one = kind == LayerKind::luminance || kind == LayerKind::ids || kind == LayerKind::depth ||
                            kind == LayerKind::scalar;
        const size_t count = of_one ? 1 : kind == LayerKind::texture ? 2 : kind == LayerKind::mattes ? 4 : 3;
        view_ = {0, ViewCurve::filmic, 1};
        give(std::vector<std::vector<float>>(count, {0.25f, 0.75f, 0.5f, 0.5f}));
        const Codes finite = codes(kind);
        channels_.back().values = {0.25f, 0.75f, nan, -infinity};
        const Codes marked = codes(kind);
        EXPECT_EQ(marked[0], finite[0]) << kind_name(kind);
        EXPECT_EQ(marked[1], finite[1]) << kind_name(kind);
        EXPECT_EQ(marked[2], (std::array<int, 3>{255, 0, 255})) << kind_name(kind);
        EXPECT_EQ(marked[3], (std::array<int, 3>{0, 255, 255})) << kind_name(kind);
        EXPECT_EQ(shown_.nans, 1u);
        EXPECT_EQ(shown_.infinities, 1u);
    }
}

}  // namespace
}  // namespace cistula
