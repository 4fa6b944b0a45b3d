// What a file's attributes and a texture's key make of its numbers.
#include "image/color/file_colors.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace cistula {
namespace {

constexpr Chromaticities rec709 = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
constexpr Chromaticities ap1_chromaticities = {0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
constexpr Chromaticities pal = {0.64f, 0.33f, 0.29f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};  // ITU-R BT.470
constexpr Chromaticities nonsense = {};

std::string error_of(const FileColors& colors, std::string_view name = "") {
    try {
        file_encoding(name, colors, true);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "no error";
}

/// The id of the space, and the light of 0.5, of floating-point numbers.
std::pair<std::string, double> found(const FileColors& colors, std::string_view name = "") {
    const FileEncoding encoding = file_encoding(name, colors, true);
    return {std::string(encoding.space.id), encoding.curve(0.5)};
}

using Found = std::pair<std::string, double>;
const Found own = {"lin_rec709_scene", 0.5}, acescg = {"lin_ap1_scene", 0.5};

TEST(FileColors, AFileThatSaysNothingIsLinearOrSrgb) {
    EXPECT_EQ(found({}), own);
    EXPECT_EQ(found({.id = "unknown"}), own);
    const FileEncoding codes = file_encoding("", {}, false);
    EXPECT_EQ(codes.space.id, "lin_rec709_scene");
    EXPECT_EQ(codes.curve(0.5), elementary::srgb_to_linear(0.5));
}

TEST(FileColors, IdsAndChromaticitiesSayTheSpace) {
    EXPECT_EQ(found({.id = "lin_ap1_scene"}), acescg);
    EXPECT_EQ(found({.chromaticities = ap1_chromaticities}), acescg);
    EXPECT_EQ(found({.id = "lin_ap1_scene", .chromaticities = ap1_chromaticities}), acescg);
    EXPECT_EQ(found({.id = "unknown", .chromaticities = ap1_chromaticities}), acescg);
    EXPECT_EQ(found({.id = "lin_rec709_scene", .chromaticities = rec709}), own);
    EXPECT_EQ(found({.chromaticities = pal}), Found("", 0.5));
    EXPECT_EQ(file_encoding("", {.chromaticities = pal}, true).space.green[0], static_cast<double>(0.29f));
    EXPECT_EQ(found({.id = "srgb_ap1_scene", .chromaticities = ap1_chromaticities}),
              Found("lin_ap1_scene", elementary::srgb_to_linear(0.5)));
    EXPECT_EQ(found({.is_aces = true}).first, "lin_ap0_scene");
    EXPECT_EQ(found({.id = "lin_ap0_scene", .is_aces = true}).first, "lin_ap0_scene");
    // Numbers that are no color are converted in no way.
    EXPECT_EQ(found({.id = "data", .chromaticities = ap1_chromaticities}), own);
}

TEST(FileColors, WhatIsNotKnownOrContradictsItselfIsRefused) {
    const std::string remedy =
        "; the key \"colorspace\" of a scene's texture overrides what the file says: it is one of srgb, linear, "
        "lin_rec709_scene, "
        "lin_ap1_scene, lin_ap0_scene, lin_rec2020_scene, lin_p3d65_scene, lin_adobergb_scene, srgb_rec709_scene, "
        "srgb_ap1_scene, srgb_p3d65_scene, g18_rec709_scene, g22_rec709_scene, g24_rec709_scene, g22_ap1_scene, "
        "g22_adobergb_scene, data";
    EXPECT_EQ(error_of({.id = "ocio:foo"}), "its colorInteropID 'ocio:foo' is not known" + remedy);
    EXPECT_EQ(error_of({.id = "ocio:foo", .chromaticities = rec709}),
              "its colorInteropID 'ocio:foo' is not known" + remedy);
    EXPECT_EQ(error_of({.id = "a\nb"}), "its colorInteropID 'a\\nb' is not known" + remedy);
    EXPECT_EQ(error_of({.id = "lin_ap1_scene", .chromaticities = rec709}),
              "its colorInteropID is lin_ap1_scene, but its chromaticities are those of lin_rec709_scene" + remedy);
    EXPECT_EQ(error_of({.id = "lin_rec709_scene", .chromaticities = pal}),
              "its colorInteropID is lin_rec709_scene, but its chromaticities are red (0.64, 0.33), green (0.29, 0.6), "
              "blue (0.15, 0.06), white (0.3127, 0.329)" +
                  remedy);
    EXPECT_EQ(
        error_of({.chromaticities = rec709, .is_aces = true}),
        "its acesImageContainerFlag says lin_ap0_scene, but its chromaticities are those of lin_rec709_scene" + remedy);
    EXPECT_EQ(error_of({.id = "lin_ap1_scene", .is_aces = true}),
              "its colorInteropID is 'lin_ap1_scene', but its acesImageContainerFlag says lin_ap0_scene" + remedy);
    EXPECT_EQ(
        error_of({.chromaticities = nonsense}),
        "its chromaticities are no color space: white must lie inside the triangle of red, green and blue" + remedy);
}

TEST(FileColors, TheKeyOverridesWhateverTheFileSays) {
    const FileColors files[] = {{},
                                {.id = "ocio:foo"},
                                {.id = "lin_ap0_scene", .chromaticities = rec709},
                                {.chromaticities = nonsense},
                                {.is_aces = true}};
    for (const FileColors& file : files)
        for (const ColorEncoding& encoding : color_encodings)
            EXPECT_EQ(found(file, encoding.name), Found(encoding.space, encoding.curve(0.5))) << encoding.name;
    EXPECT_EQ(found({}, "srgb"), found({}, "srgb_rec709_scene"));
    EXPECT_EQ(found({}, "linear"), own);
    EXPECT_EQ(error_of({}, "lin_ap1"), "its colorspace 'lin_ap1' is not known; did you mean 'lin_ap1_scene'?");
}

TEST(ColorEncodings, CurvesAreThoseOfTheForum) {
    const auto light = [](const char* name, double number) { return find_color_encoding(name)->curve(number); };
    EXPECT_NEAR(light("srgb_p3d65_scene", 0.5), 0.2140411, 1e-7);
    EXPECT_NEAR(light("g22_rec709_scene", 0.5), 0.2176376, 1e-7);
    EXPECT_NEAR(light("g22_ap1_scene", 0.5), 0.2176376, 1e-7);
    EXPECT_NEAR(light("g24_rec709_scene", 0.5), 0.1894646, 1e-7);
    EXPECT_NEAR(light("g18_rec709_scene", 0.5), 0.2871746, 1e-7);
    EXPECT_NEAR(light("g22_adobergb_scene", 0.5), 0.2177556, 1e-7);  // 563 / 256
    for (const ColorEncoding& encoding : color_encodings) {
        EXPECT_NE(find_color_space(encoding.space), nullptr) << encoding.name;
        EXPECT_EQ(encoding.curve(0), 0) << encoding.name;
        EXPECT_EQ(encoding.curve(1), 1) << encoding.name;
        EXPECT_GT(encoding.curve(3), 2.9) << encoding.name;
        EXPECT_LT(encoding.curve(-0.5), 0) << encoding.name;
    }
    EXPECT_EQ(light("g22_rec709_scene", -0.5), -0.5);
    EXPECT_EQ(find_color_encoding("unknown"), nullptr);
}

}  // namespace
}  // namespace cistula
