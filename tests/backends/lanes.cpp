// However many rays the host traces at once, every integer of the film is the same, and so is the count of rays.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "backend_embree/embree/embree_renderer.h"
#include "testing/generated_scene.h"
#include "testing/support/golden.h"
#include "testing/support/shipped_scenes.h"

using namespace cistula;

namespace {

template <class Real>
class LaneTest : public ::testing::Test {
  public:
    /// Renders with at most so many lanes, and compares with one.
    void compare(const SceneDescription& scene, FrameSettings settings, const std::string& name) {
        const auto renderer = make_embree_renderer<Real>(compile_scene<Real>(scene), EmbreeOptions());
        settings.lanes = 1;
        const Film expected = golden::render_with(*renderer, scene, settings);
        EXPECT_EQ(renderer->lanes(), 1) << name;
        for (const int lanes : {4, 8, 16}) {
            settings.lanes = lanes;
            const Film film = golden::render_with(*renderer, scene, settings);
            if (renderer->lanes() > 1) in_lanes_.insert(name);
            EXPECT_LE(renderer->lanes(), lanes);
            EXPECT_EQ(film_hash(film), film_hash(expected)) << name << ", " << lanes << " lanes";
            EXPECT_EQ(film.flags, expected.flags) << name;
            for (const auto kind :
                 {&RayCounts::primary, &RayCounts::reflected, &RayCounts::transmitted, &RayCounts::shadow})
                EXPECT_EQ(film.rays.*kind, expected.rays.*kind) << name << ", " << lanes << " lanes";
        }
    }

    /// The number of scenes that were traced in lanes.
    size_t in_lanes() const { return in_lanes_.size(); }

  private:
    std::set<std::string> in_lanes_;
};

using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(LaneTest, Reals);

TYPED_TEST(LaneTest, ShippedScenesAreEqual) {
    for (const char* name : {"benchmark", "platonic", "infinity", "seed", "hard/critical-angle", "hard/furnace",
                             "hard/lights-on-edges", "hard/mirrors", "hard/index-one", "hard/far-camera"}) {
        const SceneDescription scene = test::shipped_scene(name);
        FrameSettings settings = golden::settings_for(scene);
        settings.set_size(97, 61);  // no multiple of a tile, nor of a register
        settings.supersample = 2;
        settings.depth = std::min(settings.depth, 12);
        settings.cutoff = 0;
        this->compare(scene, settings, name);
    }
    EXPECT_GE(this->in_lanes(), 5u);
}

TYPED_TEST(LaneTest, GeneratedScenesAreEqual) {
    for (uint64_t seed = 0; seed < generated_scene_count; ++seed) {
        const SceneDescription scene = generated_scene(seed);
        FrameSettings settings = generated_settings(scene);
        settings.cutoff = seed % 8 == 0 ? settings.cutoff : 0;
        settings.target_error = 0;
        settings.depth = std::min(settings.depth, 10);
        this->compare(scene, settings, "scene " + std::to_string(seed));
    }
    EXPECT_GE(this->in_lanes(), 15u);
}

TYPED_TEST(LaneTest, ACutoffIsSpentByOneRayAfterTheOther) {
    const SceneDescription scene = test::shipped_scene("benchmark");
    FrameSettings settings = golden::settings_for(scene);
    settings.set_size(32, 20);
    const auto renderer = make_embree_renderer<TypeParam>(compile_scene<TypeParam>(scene), EmbreeOptions());
    golden::render_with(*renderer, scene, settings);
    EXPECT_GT(renderer->lanes(), 1);
    settings.cutoff = 0.01;
    golden::render_with(*renderer, scene, settings);
    EXPECT_EQ(renderer->lanes(), 1);
}

}  // namespace
