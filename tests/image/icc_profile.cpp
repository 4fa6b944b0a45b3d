// ICC profiles: the encodings that they mean, and names of what is none of them.
#include "image/color/stated_colors.h"

#include <gtest/gtest.h>

#include "testing/support/pictures/icc_profiles.h"

namespace cistula {
namespace {

using test::ProfileTags;

const std::string srgb_parameters = test::parametric_curve(3, {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045});

std::string id_of(const std::string& profile) {
    const FileColors colors = colors_of_profile(profile);
    EXPECT_EQ(colors.id.empty(), !colors.profile.empty());
    return colors.id;
}
std::string name_of_unknown(const std::string& profile) {
    const FileColors colors = colors_of_profile(profile);
    EXPECT_EQ(colors.id, "");
    return colors.profile;
}
ProfileTags tags_of(const char* space, const std::string& curve) {
    return test::matrix_tags(*find_color_space(space), curve, "made up");
}

TEST(IccProfile, EveryEncodingIsFound) {
    for (const ColorEncoding& encoding : color_encodings) {
        const ColorSpace& space = *find_color_space(encoding.space);
        const ColorEncoding* const found = find_color_encoding(
            id_of(test::icc_profile("RGB ", test::matrix_tags(space, test::sampled_curve(encoding.curve, 1024), "x"))));
        ASSERT_TRUE(found) << encoding.name;
        EXPECT_EQ(found->space, encoding.space) << encoding.name;
        EXPECT_EQ(found->curve, encoding.curve) << encoding.name;
    }
}

/// Colorants of published profiles: sRGB IEC61966-2.1, Display P3 and Adobe RGB (1998).
TEST(IccProfile, ColorantsAreThoseOfPublishedProfiles) {
    const struct {
        const char* space;
        double rows[3][3];
    } published[] = {
        {"lin_rec709_scene", {{0.43607, 0.22249, 0.01392}, {0.38515, 0.71687, 0.09708}, {0.14307, 0.06061, 0.71410}}},
        {"lin_p3d65_scene", {{0.51512, 0.24120, -0.00105}, {0.29198, 0.69225, 0.04189}, {0.15710, 0.06657, 0.78407}}},
        {"lin_adobergb_scene", {{0.60974, 0.31111, 0.01947}, {0.20528, 0.62567, 0.06087}, {0.14919, 0.06322, 0.74457}}},
    };
    for (const auto& one : published) {
        const glm::dmat3 colorants = profile_colorants(*find_color_space(one.space));
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(colorants[i][k], one.rows[i][k], 4e-4) << one.space << i << k;
    }
}

TEST(IccProfile, CurvesOfEveryKind) {
    const auto found = [](const char* space, const std::string& curve) {
        return id_of(test::icc_profile("RGB ", tags_of(space, curve)));
    };
    EXPECT_EQ(found("lin_rec709_scene", srgb_parameters), "srgb");
    EXPECT_EQ(found("lin_p3d65_scene", srgb_parameters), "srgb_p3d65_scene");
    EXPECT_EQ(
        found("lin_p3d65_scene", test::parametric_curve(4, {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045, 0, 0})),
        "srgb_p3d65_scene");
    EXPECT_EQ(found("lin_adobergb_scene", test::gamma_curve(563)), "g22_adobergb_scene");
    EXPECT_EQ(found("lin_rec709_scene", test::gamma_curve(461)), "g18_rec709_scene");
    EXPECT_EQ(found("lin_rec709_scene", test::parametric_curve(0, {2.4})), "g24_rec709_scene");
    EXPECT_EQ(found("lin_rec709_scene", test::parametric_curve(1, {2.2, 1, 0})), "g22_rec709_scene");
    EXPECT_EQ(found("lin_rec709_scene", test::parametric_curve(2, {2.2, 1, 0, 0})), "g22_rec709_scene");
    EXPECT_EQ(found("lin_ap0_scene", "curv" + test::big_endian(0, 8)), "lin_ap0_scene");
}

TEST(IccProfile, OfGrayPicturesTheCurveCounts) {
    EXPECT_EQ(id_of(test::icc_profile("GRAY", {{"kTRC", srgb_parameters}})), "srgb");
    EXPECT_EQ(id_of(test::icc_profile("GRAY", {{"kTRC", test::gamma_curve(256)}})), "linear");
    EXPECT_EQ(name_of_unknown(test::icc_profile(
                  "GRAY", {{"desc", test::description_4("Dot Gain 20%")}, {"kTRC", test::gamma_curve(400)}})),
              "Dot Gain 20%");
}

TEST(IccProfile, WhatIsNoneOfThemIsNamed) {
    const auto named = [](const char* space, const std::string& curve) {
        return name_of_unknown(test::icc_profile("RGB ", tags_of(space, curve)));
    };
    EXPECT_EQ(named("lin_p3d65_scene", test::gamma_curve(666)), "made up");
    EXPECT_EQ(named("lin_rec2020_scene", srgb_parameters), "made up");
    EXPECT_EQ(named("lin_rec709_scene", test::gamma_curve(512)), "made up");
    ProfileTags tags = tags_of("lin_rec709_scene", srgb_parameters);
    EXPECT_EQ(name_of_unknown(test::icc_profile("CMYK", tags)), "made up");
    for (auto& [signature, element] : tags)
        if (signature == "gTRC") element = test::gamma_curve(563);
    EXPECT_EQ(name_of_unknown(test::icc_profile("RGB ", tags)), "made up");
    tags = tags_of("lin_rec709_scene", srgb_parameters);
    tags.push_back({"A2B0", "mft2"});
    EXPECT_EQ(name_of_unknown(test::icc_profile("RGB ", tags)), "made up");
    tags[0].second = test::description_4("Na\x01me");
    EXPECT_EQ(name_of_unknown(test::icc_profile("RGB ", tags)), "Na\x01me");  // messages show it escaped
    EXPECT_EQ(name_of_unknown(""), "without a name");
    EXPECT_EQ(name_of_unknown(std::string(1000, '\xff')), "without a name");
}

/// However a profile is cut or a byte of it changed, it is an encoding or has a name, and a cut curve is no curve.
TEST(IccProfile, DamageIsNamed) {
    const std::string whole = test::icc_profile("RGB ", tags_of("lin_p3d65_scene", srgb_parameters));
    ASSERT_EQ(id_of(whole), "srgb_p3d65_scene");
    for (size_t size = 0; size < whole.size(); ++size)
        EXPECT_NE(colors_of_profile(std::string_view(whole).substr(0, size)).profile, "") << size;
    for (size_t i = 128; i < whole.size(); ++i)
        for (const char byte : {'\0', '\x7f', '\xff'}) {
            std::string changed = whole;
            changed[i] = byte;
            const FileColors colors = colors_of_profile(changed);
            EXPECT_TRUE(colors.id.empty() != colors.profile.empty()) << i;
            EXPECT_LE(colors.profile.size(), 80u);
        }
}

}  // namespace
}  // namespace cistula
