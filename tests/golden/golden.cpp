// The CPU backend renders every golden image bit for bit, in both precisions, by the intersector that it picks (a plain
// loop where there are few primitives) and by Embree's tree, the hard ones by our own tree too
// (tests/backends/device_path.cpp has it for all); and the files say what the hashes say.
#include <gtest/gtest.h>

#include "scene/image/exr.h"
#include "testing/reference_renderers.h"
#include "testing/support/golden.h"
#include "testing/support/shipped_scenes.h"

using namespace cistula;

namespace {

const std::string source = CISTULA_SOURCE_DIR;

class Golden : public ::testing::TestWithParam<std::string> {
  protected:
    std::string folder() const { return source + "/golden/" + GetParam(); }
    SceneDescription scene() const { return test::shipped_scene(GetParam()); }
    nlohmann::json record() const { return nlohmann::json::parse(std::ifstream(folder() + "/golden.json")); }

    template <class Real>
    void check(const char* name, bool always_tree) const {
        EmbreeOptions options;
        options.always_tree = always_tree;
        expect_golden(name, golden::render_embree<Real>(scene(), options));
    }
    template <class Real>
    void check_own_tree(const char* name) const {
        auto compiled = compile_scene<Real>(scene());
        build_primitive_tree(*compiled, 1);
        const auto renderer = make_host_renderer<Real>(std::move(compiled), HostIntersector::bvh);
        expect_golden(name, golden::render_with(*renderer, scene(), golden::settings_for(scene())));
    }

  private:
    void expect_golden(const char* name, const Film& film) const {
        EXPECT_EQ(film.flags, 0u);
        EXPECT_EQ(film_hash(film), record()[name]["hash"].get<std::string>()) << "the integer sums differ";
        const LayeredPicture expected = read_exr(folder() + "/" + name + ".exr");
        const golden::Difference d = golden::compare(expected, to_layers(film, golden::channels()), false);
        EXPECT_EQ(d.differing, 0u) << "worst: " << d.channel << " at " << d.x << ", " << d.y << " by " << d.worst;
    }
};

TEST_P(Golden, FloatIsEqualBitForBit) {
    check<float>("float", false);
}

TEST_P(Golden, DoubleIsEqualBitForBit) {
    check<double>("double", false);
}

TEST_P(Golden, FloatThroughEmbreesTreeIsEqualBitForBit) {
    check<float>("float", true);
}

TEST_P(Golden, DoubleThroughEmbreesTreeIsEqualBitForBit) {
    check<double>("double", true);
}

class HardGolden : public Golden {};

TEST_P(HardGolden, FloatThroughOurTreeIsEqualBitForBit) {
    check_own_tree<float>("float");
}

TEST_P(HardGolden, DoubleThroughOurTreeIsEqualBitForBit) {
    check_own_tree<double>("double");
}

TEST_P(Golden, StatesTheWorstDifferenceOfThePrecisions) {
    const auto stated = record()["float_against_double"];
    const golden::Difference d =
        golden::compare(read_exr(folder() + "/float.exr"), read_exr(folder() + "/double.exr"), true);
    EXPECT_EQ(d.worst, stated["worst"].get<double>());
    EXPECT_EQ(d.x, stated["x"].get<int>());
    EXPECT_EQ(d.y, stated["y"].get<int>());
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
