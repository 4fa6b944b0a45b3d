// Matrices between color spaces, against those that standards print.
#include "scene/film/color_space.h"

#include <gtest/gtest.h>

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
    ASSERT_EQ(color_spaces().size(), 4u);
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
