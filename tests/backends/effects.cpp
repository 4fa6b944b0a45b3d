// What the scene does not call for is left out of the code that runs, and no bit of the image tells.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "cistula/transport/pixel.h"
#include "cistula/traversal/brute.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/materials/required_effects.h"
#include "scene/description/without_effect.h"
#include "testing/support/golden.h"
#include "testing/support/lanes.h"
#include "testing/support/scene.h"
#include "testing/support/shipped_scenes.h"
#include "verify/scenes/generated_scene.h"

using namespace cistula;

namespace {

const std::string source = CISTULA_SOURCE_DIR;

template <class Real>
class EffectTest : public ::testing::Test {
  public:
    /// Renders with the effects that the scene calls for and with all of them, without a cutoff: frames with one run
    /// all effects. The mask that ran.
    static uint32_t compare(const SceneDescription& scene, FrameSettings settings, const std::string& name) {
        settings.cutoff = 0;
        const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(scene);
        const auto renderer = make_embree_renderer<Real>(compiled, EmbreeOptions());
        const std::string chosen = record_hash(golden::render_with(*renderer, scene, settings));
        const uint32_t ran = renderer->effects();
        const int lanes = test::expected_lanes<Real>(test::least_lanes(*compiled, scene.camera, settings), 0);
        EXPECT_EQ(renderer->lanes(), lanes) << name;
        EXPECT_EQ(ran, lanes > 1 ? lane_effects(*compiled, scene, settings) : all_effects) << name;
        settings.effects = all_effects;
        EXPECT_EQ(record_hash(golden::render_with(*renderer, scene, settings)), chosen) << name;
        EXPECT_EQ(renderer->effects(), all_effects);
        return ran;
    }

    /// The effects that lanes run for a scene.
    static uint32_t lane_effects(const CompiledScene<Real>& compiled, const SceneDescription& scene,
                                 const FrameSettings& settings) {
        FrameView frame = frame_view(compiled, camera_at(scene.camera, 0), settings);
        const SceneView<Real> view = compiled.view();
        find_camera_solids(view, BruteIntersector<Real>{view}, frame);
        return effect_masks[lane_masks[least_lane_mask(mask_to_run(compiled.effects, settings, frame))]];
    }
};

FrameSettings shallow_frame(const SceneDescription& scene) {
    FrameSettings settings = golden::settings_for(scene);
    settings.set_size(160, 90);
    settings.depth = std::min(scene.depth, 8);
    return settings;
}

using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(EffectTest, Reals);

TYPED_TEST(EffectTest, NoSceneTellsAllEffectsFromThoseItNeeds) {
    int scenes = 0;
    for (const char* folder : {"/scenes", "/scenes/hard"})
        for (const auto& entry : std::filesystem::directory_iterator(source + folder)) {
            if (entry.path().extension() != ".json") continue;
            const SceneDescription scene = read_scene(entry.path().string());
            this->compare(scene, shallow_frame(scene), entry.path().filename().string());
            ++scenes;
        }
    EXPECT_GE(scenes, 20);
}

TYPED_TEST(EffectTest, NoGeneratedSceneDoes) {
    std::set<uint32_t> ran;
    for (uint64_t seed = 0; seed < generated_scene_count; ++seed) {
        const SceneDescription scene = generated_scene(seed, test::scene_folder);
        ran.insert(this->compare(scene, generated_settings(scene), "generated scene " + std::to_string(seed)));
    }
    EXPECT_EQ(ran.size(), size_t(lane_mask_count));
}

/// Most generated scenes call for much: here less is left of them, so that they can do with less than all effects.
/// Contacts cannot be taken out, so scenes that have some run the largest.
TYPED_TEST(EffectTest, NorDoGeneratedScenesOfFewerEffects) {
    int least = 0;  // scenes that run the least mask where lanes are wide enough
    for (uint64_t seed = 0; seed < generated_scene_count; ++seed) {
        const uint32_t mask = effect_masks[seed % uint64_t(effect_mask_count - 1)];
        SceneDescription scene = generated_scene(seed, test::scene_folder);
        for (int bit = 0; bit < effect_count; ++bit) {
            if ((mask >> bit & 1u) != 0) continue;
            if (const auto less = without_effect(scene, 1u << bit)) scene = *less;
        }
        FrameSettings settings = generated_settings(scene);
        this->compare(scene, settings, "generated scene " + std::to_string(seed) + " with less");
        settings.cutoff = 0;
        const auto compiled = compile_scene<TypeParam>(scene);
        least += test::least_lanes(*compiled, scene.camera, settings).value_or(64) <= int(64 / sizeof(TypeParam)) &&
                 this->lane_effects(*compiled, scene, settings) == effect_masks[lane_masks[0]];
    }
    EXPECT_GE(least, 32);
}

/// The benchmark's scene, less and less of it, then more: each mask of the table has one that calls for it.
TYPED_TEST(EffectTest, EveryMaskIsCalledFor) {
    const SceneDescription benchmark = test::shipped_scene("benchmark");
    const SceneDescription reflecting = without_effect(benchmark, effect_transmission).value();
    const SceneDescription lit = without_effect(reflecting, effect_reflection).value();
    const std::vector<SceneDescription> scenes = {lit,
                                                  reflecting,
                                                  benchmark,
                                                  test::shipped_scene("platonic"),
                                                  test::shipped_scene("glass"),
                                                  test::shipped_scene("spheres"),
                                                  test::shipped_scene("hard/planes")};
    ASSERT_EQ(scenes.size(), size_t(effect_mask_count));
    for (size_t i = 0; i < scenes.size(); ++i) {
        EXPECT_EQ(least_mask(required_effects(scenes[i])), int(i));
        EXPECT_EQ(this->compare(scenes[i], shallow_frame(scenes[i]), "scene " + std::to_string(i)),
                  effect_masks[lane_masks[least_lane_mask(int(i))]])
            << i;
    }
}

/// Where no ray bends a line is searched for lights once; with all effects, anew from every face that it passes.
TYPED_TEST(EffectTest, LightsAreSeenThroughManyFaces) {
    SceneDescription scene = test::shipped_scene("benchmark");
    const int glass = test::add_material(scene, 0.1, 0.8);
    for (const double y : {-1.0, 0.5, 1.0}) {
        TrianglesObject window;
        window.vertices = {{-4, y, 0.5}, {4, y, 0.5}, {4, y, 4}, {-4, y, 4}};
        window.triangles = {{0, 1, 2}, {0, 2, 3}};
        test::add_object(scene, window, glass);
    }
    const FrameSettings settings = shallow_frame(scene);
    const auto hash = [&] {
        const auto renderer = make_embree_renderer<TypeParam>(compile_scene<TypeParam>(scene), EmbreeOptions());
        return record_hash(golden::render_with(*renderer, scene, settings));
    };
    const std::string dark = hash();
    test::add_edge_lights(scene, 4);
    test::add_visible_lights(scene, 40);
    EXPECT_EQ(this->compare(scene, settings, "lights"), effect_masks[3]);
    EXPECT_NE(hash(), dark);
}

TYPED_TEST(EffectTest, ACameraInASolidCallsForInsides) {
    SceneDescription scene = without_effect(test::shipped_scene("benchmark"), effect_transmission).value();
    scene.camera.position_path.reset();
    scene.camera.target_path.reset();
    scene.camera.target = {0, 0, 0};
    scene.camera.position = {-2.5, 2.5, 2};  // the octahedron's center
    EXPECT_FALSE(compile_scene<TypeParam>(scene)->effects & effect_insides);
    EXPECT_TRUE(this->compare(scene, shallow_frame(scene), "inside") & effect_insides);
}

TEST(WithoutEffect, TheSceneNoLongerCallsForIt) {
    for (const char* name : {"benchmark", "platonic", "glass", "mesh", "seed", "infinity"}) {
        const SceneDescription scene = test::shipped_scene(name);
        for (const EffectReason& reason : explain_effects(scene)) {
            if (!reason.needed) continue;
            const auto less = without_effect(scene, reason.effect);
            const uint32_t shadows = effect_opaque_shadows | effect_transparent_shadows;
            if ((reason.effect & shadows) != 0) {
                EXPECT_FALSE(less);
                continue;
            }
            if (!less) continue;
            const uint32_t left = required_effects(*less);
            // Glass still reflects totally where nothing else does.
            if (reason.effect == effect_reflection && (left & effect_refraction) != 0) continue;
            EXPECT_FALSE(left & reason.effect) << name << ": " << names_of_effects(reason.effect)[0];
        }
    }
}

TEST(WithoutEffect, LeavesNoEmptyScene) {
    SceneDescription scene = test::shipped_scene("benchmark");
    scene.objects.pop_back();
    EXPECT_FALSE(without_effect(scene, effect_solids));
    EXPECT_TRUE(without_effect(scene, effect_triangles));
    EXPECT_FALSE(without_effect(scene, effect_opaque_shadows));
}

}  // namespace
