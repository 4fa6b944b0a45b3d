// The CPU backend renders every golden image bit for bit, in both precisions, by the intersector that it picks (a plain
// loop where there are few primitives) and by Embree's tree; and the files say what the hashes say.
#include <gtest/gtest.h>

#include "golden.h"
#include "scene/exr.h"

using namespace cistula;

namespace {

const std::string source = CISTULA_SOURCE_DIR;

class Golden : public ::testing::TestWithParam<std::string> {
  protected:
    std::string folder() const { return source + "/golden/" + GetParam(); }
    SceneDescription scene() const { return read_scene(source + "/scenes/" + GetParam() + ".json"); }
    nlohmann::json record() const { return nlohmann::json::parse(std::ifstream(folder() + "/golden.json")); }

    template <class Real>
    void check(const char* name, bool always_tree) const {
        EmbreeOptions options;
        options.always_tree = always_tree;
        const Film film = golden::render_embree<Real>(scene(), options);
        EXPECT_EQ(film.flags, 0u);
        EXPECT_EQ(film_hash(film), record()[name]["hash"]) << "the integer sums differ";
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

TEST_P(Golden, StatesTheWorstDifferenceOfThePrecisions) {
    const auto stated = record()["float_against_double"];
    const golden::Difference d =
        golden::compare(read_exr(folder() + "/float.exr"), read_exr(folder() + "/double.exr"), true);
    EXPECT_EQ(d.worst, stated["worst"].get<double>());
    EXPECT_EQ(d.x, stated["x"].get<int>());
    EXPECT_EQ(d.y, stated["y"].get<int>());
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden, ::testing::ValuesIn(golden::scene_names(source + "/scenes")),
                         [](const auto& scene) { return scene.param; });

}  // namespace
