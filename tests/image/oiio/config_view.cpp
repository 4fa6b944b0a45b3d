// Views of OpenColorIO configs: found by name, fed with what the config calls linear Rec. 709, shown as the display's
// codes.
#include "image/view/config_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "image/color/srgb_codes.h"
#include "testing/support/expect_error.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

/// A config with these roles and spaces beside `raw`, whose values are the reference's, and `root`, their square roots.
std::string config_of(const std::string& roles, const std::string& spaces) {
    return "ocio_profile_version: 1\nroles:\n  default: raw\n" + roles +
           "displays:\n  screen:\n    - !<View> {name: Plain, colorspace: raw}\n    - !<View> {name: Root, colorspace: "
           "root}\n  wall:\n    - !<View> {name: Plain, colorspace: root}\nactive_displays: [screen, wall]\n"
           "active_views: [Plain, Root]\ncolorspaces:\n  - !<ColorSpace> {name: raw}\n  - !<ColorSpace>\n    name: "
           "root\n"
           "    from_reference: !<ExponentTransform> {value: [0.5, 0.5, 0.5, 1]}\n" +
           spaces;
}

class ConfigViews : public testing::Test {
  protected:
    ConfigViews() {
        if (const char* const set = std::getenv("OCIO")) before_ = set;
    }
    ~ConfigViews() override {
        if (before_.empty())
            unsetenv("OCIO");
        else
            setenv("OCIO", before_.c_str(), 1);
    }

    void use(const std::string& config) {
        put_bytes(path_, config);
        setenv("OCIO", path_.c_str(), 1);
    }

    /// The codes of one color as that view shows it.
    static std::vector<int> codes(const std::string& name, const glm::vec3& color) {
        ColorPicture picture{1, 1, {color}};
        ConfigView(name, {}).apply(picture);
        const glm::vec3 shown = picture.texels[0];
        return {srgb8_from_linear(shown[0]), srgb8_from_linear(shown[1]), srgb8_from_linear(shown[2])};
    }

    const ScratchDirectory scratch_;
    const std::string path_ = scratch_.file("c.ocio");

  private:
    std::string before_;
};

TEST_F(ConfigViews, ShowTheCodesOfTheDisplay) {
    use(config_of("  scene_linear: raw\n", ""));
    EXPECT_EQ(codes("Root", {0.25f, 0.04f, 1}), (std::vector<int>{128, 51, 255}));
    EXPECT_EQ(codes("Plain", {0.25f, 0.04f, 3}), (std::vector<int>{64, 10, 255}));
    EXPECT_EQ(codes("Plain (wall)", {0.25f, 0.04f, 0}), (std::vector<int>{128, 51, 0}));
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(codes("Plain", {nan, infinity, -1}), (std::vector<int>{0, 255, 0}));
}

TEST_F(ConfigViews, TakeEachTexelOfLargePictures) {
    use(config_of("  scene_linear: raw\n", ""));
    ColorPicture picture{300, 400, {}};
    for (int i = 0; i < 300 * 400; ++i) picture.texels.push_back(glm::vec3(static_cast<float>(i % 256) / 255));
    ConfigView("Plain", {}).apply(picture);
    for (size_t i = 0; i < picture.texels.size(); ++i) ASSERT_EQ(srgb8_from_linear(picture.texels[i][1]), i % 256) << i;
}

/// By name; else by the role whose meaning is fixed, in which Rec. 709's red is that color; else by a guess that is
/// said.
TEST_F(ConfigViews, FindLinearRec709) {
    const std::string half =
        "    to_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}\n";
    use(config_of("  scene_linear: raw\n  aces_interchange: raw\n",
                  "  - !<ColorSpace>\n    name: lin_rec709\n" + half));
    EXPECT_EQ(codes("Plain", {1, 1, 1}), (std::vector<int>{128, 128, 128}));
    EXPECT_EQ(ConfigView("Plain", {}).warning(), "");

    use(config_of("  scene_linear: other\n  aces_interchange: raw\n", "  - !<ColorSpace>\n    name: other\n" + half));
    EXPECT_EQ(codes("Plain", {1, 0, 0}), (std::vector<int>{112, 23, 4}));  // 0.4396, 0.0898, 0.0174
    EXPECT_EQ(ConfigView("Plain", {}).warning(), "");

    use(config_of("  scene_linear: other\n", "  - !<ColorSpace>\n    name: other\n" + half));
    EXPECT_EQ(codes("Plain", {1, 0, 0}), (std::vector<int>{128, 0, 0}));
    EXPECT_EQ(
        ConfigView("Plain", {}).warning(),
        "`view`: the config of $OCIO has neither a space of the name lin_rec709_scene nor the role aces_interchange; "
        "linear Rec. 709 is taken for its scene_linear, other");
}

TEST_F(ConfigViews, OfOtherNamesAreRefused) {
    use(config_of("  scene_linear: raw\n", ""));
    EXPECT_ERROR(ConfigView("Rout", {"srgb", "filmic"}), ExitCode::usage,
                 "--view Rout: there is no such view; the views are: Root, srgb, filmic, Plain, Plain (wall)");
    use("no config");
    try {
        ConfigView("Root", {"srgb"});
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::file);
        EXPECT_EQ(std::string(error.what()).rfind("`view` Root: $OCIO, " + path_ + ": ", 0), 0u) << error.what();
    }
}

}  // namespace
}  // namespace cistula
