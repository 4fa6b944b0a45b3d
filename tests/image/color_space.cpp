// Matrices between color spaces, against those that standards print.
#include "image/color/color_space.h"
#include "testing/support/special_values.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace cistula {
namespace {

using glm::dmat3;
using glm::dvec3;

const ColorSpace& space(const char* id) {
    return *find_color_space(id);
}

/// `rows` as printed.
void expect_rows(const dmat3& matrix, const double (&rows)[3][3], double within) {
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            EXPECT_NEAR(matrix[column][row], rows[row][column], within) << row << ' ' << column;
}

TEST(ColorSpaces, AreFoundByTheirNames) {
    ASSERT_EQ(color_spaces().size(), 6u);
    EXPECT_EQ(color_spaces().front().id, "lin_rec709_scene");
    for (const ColorSpace& each : color_spaces()) EXPECT_EQ(find_color_space(each.id), &each);
    EXPECT_EQ(find_color_space("lin_rec709"), nullptr);
    EXPECT_EQ(find_color_space(""), nullptr);
}

TEST(ColorSpaces, MatricesAreThePublishedOnes) {
    // ITU-R BT.2087-0, table 2; ACES S-2014-004 (ACEScg), AP0 to AP1.
    expect_rows(color_matrix(space("lin_rec709_scene"), space("lin_rec2020_scene")),
                {{0.6274, 0.3293, 0.0433}, {0.0691, 0.9195, 0.0114}, {0.0164, 0.0880, 0.8956}}, 5e-5);
    expect_rows(color_matrix(space("lin_ap0_scene"), space("lin_ap1_scene")),
                {{1.4514393161, -0.2365107469, -0.2149285693},
                 {-0.0765537734, 1.1762296998, -0.0996759264},
                 {0.0083161484, -0.0060324498, 0.9977163014}},
                5e-10);
    // Bradford's adaptation from D65 to the white of ACES.
    expect_rows(color_matrix(space("lin_rec709_scene"), space("lin_ap1_scene")),
                {{0.613097, 0.339523, 0.047379}, {0.070194, 0.916354, 0.013452}, {0.020616, 0.109570, 0.869815}}, 2e-6);
}

TEST(ColorSpaces, AcescgBecomesTheKnownRec709) {
    expect_rows(color_matrix(space("lin_ap1_scene"), space("lin_rec709_scene")),
                {{1.705051, -0.621792, -0.083259}, {-0.130256, 1.140805, -0.010548}, {-0.024003, -0.128969, 1.152972}},
                2e-6);
    // SMPTE RP 431-2's primaries with D65.
    expect_rows(color_matrix(space("lin_p3d65_scene"), space("lin_rec709_scene")),
                {{1.224940, -0.224940, 0}, {-0.042057, 1.042057, 0}, {-0.019638, -0.078636, 1.098274}}, 2e-6);
}

/// The chromaticities of a space as files hold them.
Chromaticities stored(const ColorSpace& space) {
    Chromaticities c;
    for (size_t i = 0; i < 8; ++i) {
        const auto* xy = i < 2 ? space.red : i < 4 ? space.green : i < 6 ? space.blue : space.white;
        c[i] = static_cast<float>(xy[i % 2]);
    }
    return c;
}

TEST(ColorSpaces, ChromaticitiesAreThoseOfAKnownSpaceOrAnother) {
    for (const ColorSpace& space : color_spaces())
        for (size_t i = 0; i < 8; ++i)
            for (const float off : {-0.0009f, 0.0f, 0.0009f, -0.0011f, 0.0011f}) {
                Chromaticities c = stored(space);
                c[i] += off;
                const bool is_near = off * off < 1e-6f;
                const ColorSpace found = color_space_of(c);
                EXPECT_EQ(found.id, is_near ? space.id : "") << space.id << ' ' << i << ' ' << off;
                const auto* xy = i < 2 ? found.red : i < 4 ? found.green : i < 6 ? found.blue : found.white;
                if (!is_near) {
                    EXPECT_EQ(xy[i % 2], static_cast<double>(c[i]));
                }
            }
}

TEST(ColorSpaces, NonsenseIsNoSpace) {
    const Chromaticities good = stored(space("lin_rec709_scene"));
    using test::infinity, test::nan;
    for (const float wrong : {nan, infinity, -infinity, 1e30f, -20.0f})
        for (size_t i = 0; i < 8; ++i) {
            Chromaticities c = good;
            c[i] = wrong;
            EXPECT_THROW(color_space_of(c), std::runtime_error) << i << ' ' << wrong;
        }
    const Chromaticities others[] = {
        {},
        {0.3127f, 0.329f, 0.3127f, 0.329f, 0.3127f, 0.329f, 0.3127f, 0.329f},  // all one point
        {0.1f, 0.1f, 0.3f, 0.3f, 0.5f, 0.5f, 0.3127f, 0.329f},                 // on a line
        {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.6f, 0.6f},                  // white outside
        {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3f, 0},
    };
    for (const Chromaticities& c : others) EXPECT_THROW(color_space_of(c), std::runtime_error) << c[0];
}

TEST(ColorSpaces, LuminanceIsThatOfTheStandard) {
    const auto expect = [](const char* id, const double(&weights)[3], double within) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(luminance_weights(space(id))[c], weights[c], within) << id << c;
    };
    expect("lin_rec709_scene", {0.2126, 0.7152, 0.0722}, 5e-5);         // ITU-R BT.709
    expect("lin_rec2020_scene", {0.2627, 0.6780, 0.0593}, 5e-5);        // ITU-R BT.2020
    expect("lin_ap1_scene", {0.2722287, 0.6740818, 0.0536895}, 5e-8);   // ACES S-2014-004
    expect("lin_ap0_scene", {0.3439664, 0.7281661, -0.0721325}, 5e-8);  // SMPTE ST 2065-1
    expect("lin_adobergb_scene", {0.29734, 0.62736, 0.07529}, 1e-5);    // Adobe RGB (1998), 4.3.5.3
}

TEST(ColorSpaces, WhiteStaysWhiteAndWaysBackLeadBack) {
    for (const ColorSpace& from : color_spaces())
        for (const ColorSpace& to : color_spaces()) {
            const dvec3 white = color_matrix(from, to) * dvec3(1);
            const dmat3 back = color_matrix(to, from) * color_matrix(from, to);
            for (int i = 0; i < 3; ++i) {
                EXPECT_NEAR(white[i], 1, 1e-14) << from.id << ' ' << to.id;
                for (int k = 0; k < 3; ++k) EXPECT_NEAR(back[i][k], i == k, 1e-14) << from.id << ' ' << to.id;
            }
        }
}

}  // namespace
}  // namespace cistula
