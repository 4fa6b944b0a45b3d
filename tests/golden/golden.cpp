// The CPU backend renders every golden image bit for bit, in both precisions, by Embree's tree, the hard ones by our
// own tree too (tests/backends/device_path.cpp has it for all), and the middle of each by the plain loop. By the
// intersector that it picks, tests of ctest do that are named after the cases of golden/suite.json.
#include <gtest/gtest.h>

#include "image/exr/exr.h"
#include "testing/support/golden.h"
#include "testing/support/golden_suite.h"
#include "testing/support/shipped_scenes.h"
#include "verify/reference_renderers.h"

using namespace cistula;

namespace {

const std::string source = CISTULA_SOURCE_DIR;

class Golden : public ::testing::TestWithParam<std::string> {
  protected:
    SceneDescription scene() const { return test::shipped_scene(GetParam()); }
    golden::Expected expected(const char* precision) const { return golden::expected(source, GetParam(), precision); }

    template <class Real>
    void check_embrees_tree(const char* name) const {
        expect_golden(name, golden::render_embree<Real>(scene(), {.always_tree = true}));
    }
    /// By the plain loop, which shares nothing with trees, the middle of the frame.
    template <class Real>
    void check_plain_loop(const char* name) const {
        FrameSettings settings = golden::settings_for(scene());
        settings.crop = {settings.full_width / 2 - 16, settings.full_height / 2 - 9, 32, 18};
        const auto renderer = make_host_renderer<Real>(compile_scene<Real>(scene()), HostIntersector::brute);
        const LayeredPicture middle = to_layers(golden::render_with(*renderer, scene(), settings), golden::channels());
        const golden::Difference d = golden::compare(part_of(read_exr(expected(name).image), settings.crop), middle);
        EXPECT_EQ(d.differing, 0u) << "worst: " << d.channel << " at " << d.x << ", " << d.y << " by " << d.worst;
    }
    template <class Real>
    void check_own_tree(const char* name) const {
        auto compiled = compile_scene<Real>(scene());
        build_primitive_tree(*compiled, 1);
        const auto renderer = make_host_renderer<Real>(std::move(compiled), HostIntersector::bvh);
        expect_golden(name, golden::render_with(*renderer, scene(), golden::settings_for(scene())));
    }

  private:
    static LayeredPicture part_of(const LayeredPicture& picture, const PixelRect& crop) {
        LayeredPicture part;
        part.width = crop.width;
        part.height = crop.height;
        for (const LayeredPicture::Channel& channel : picture.channels) {
            part.channels.push_back({channel.name, channel.half, {}});
            for (int y = crop.y; y < crop.y + crop.height; ++y) {
                const auto row = channel.values.begin() + ptrdiff_t{y} * picture.width + crop.x;
                part.channels.back().values.insert(part.channels.back().values.end(), row, row + crop.width);
            }
        }
        return part;
    }

    void expect_golden(const char* name, const Film& film) const {
        EXPECT_EQ(film.flags, 0u);
        const golden::Expected wanted = expected(name);
        EXPECT_EQ(film.full_width, wanted.width);
        EXPECT_EQ(film.full_height, wanted.height);
        EXPECT_EQ(film_hash(film), wanted.film_hash) << "the integer sums differ";
        const golden::Difference d = golden::compare(read_exr(wanted.image), to_layers(film, golden::channels()));
        EXPECT_EQ(d.differing, 0u) << "worst: " << d.channel << " at " << d.x << ", " << d.y << " by " << d.worst;
    }
};

TEST_P(Golden, FloatThroughEmbreesTreeIsEqualBitForBit) {
    check_embrees_tree<float>("float");
}

TEST_P(Golden, DoubleThroughEmbreesTreeIsEqualBitForBit) {
    check_embrees_tree<double>("double");
}

TEST_P(Golden, FloatByThePlainLoopIsEqualBitForBit) {
    check_plain_loop<float>("float");
}

TEST_P(Golden, DoubleByThePlainLoopIsEqualBitForBit) {
    check_plain_loop<double>("double");
}

TEST(GoldenSuite, HasEverySceneInBothPrecisions) {
    const auto suite = nlohmann::json::parse(std::ifstream(source + "/golden/suite.json"));
    const std::vector<std::string> scenes = golden::scene_names(test::scene_folder);
    EXPECT_EQ(suite.at("cases").size(), 2 * scenes.size());
    for (const std::string& scene : scenes)
        for (const char* precision : {"float", "double"}) {
            const auto& cases = suite.at("cases");
            const auto one = std::find_if(cases.begin(), cases.end(),
                                          [&](const auto& c) { return c.at("name") == scene + "/" + precision; });
            ASSERT_NE(one, cases.end()) << scene << "/" << precision;
            EXPECT_EQ(one->at("scene"), "../scenes/" + scene + ".json");
            EXPECT_EQ(one->at("precision"), precision);
        }
}

class HardGolden : public Golden {};

TEST_P(HardGolden, FloatThroughOurTreeIsEqualBitForBit) {
    check_own_tree<float>("float");
}

TEST_P(HardGolden, DoubleThroughOurTreeIsEqualBitForBit) {
    check_own_tree<double>("double");
}

/// Names of tests are letters, digits and underscores.
std::string test_name(const ::testing::TestParamInfo<std::string>& scene) {
    std::string name = scene.param;
    for (char& letter : name)
        if (letter == '/' || letter == '-') letter = '_';
    return name;
}

/// Only those that begin with this.
std::vector<std::string> names(const std::string& beginning) {
    std::vector<std::string> names = golden::scene_names(test::scene_folder);
    std::erase_if(names, [&](const std::string& name) { return name.rfind(beginning, 0) != 0; });
    return names;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden, ::testing::ValuesIn(names("")), test_name);
INSTANTIATE_TEST_SUITE_P(Scenes, HardGolden, ::testing::ValuesIn(names("hard/")), test_name);

}  // namespace
