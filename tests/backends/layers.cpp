// Layers of films: they add up to the pixels in integers, are the same by every traversal, and change nothing.
#include <gtest/gtest.h>

#include "backend_embree/embree/embree_renderer.h"
#include "scene/description/camera_path.h"
#include "testing/support/golden.h"
#include "testing/support/pictures/film_layers.h"
#include "testing/support/scene.h"
#include "testing/support/shipped_scenes.h"
#include "verify/reference_renderers.h"
#include "verify/scenes/generated_scene.h"

using namespace cistula;

namespace {

Film rendered(Renderer& renderer, const SceneDescription& scene, const FrameSettings& settings) {
    Film film;
    RenderProgress progress;
    EXPECT_TRUE(renderer.render(camera_at(scene.camera, 0), settings, film, progress));
    return film;
}

template <class Real>
class Layers : public ::testing::Test {
  protected:
    /// Renders a scene with and without layers, on Embree and on the GPU's traversal.
    static void check(const SceneDescription& scene, FrameSettings settings) {
        const std::shared_ptr<CompiledScene<Real>> compiled = compile_scene<Real>(scene);
        build_primitive_tree(*compiled);
        const auto embree = make_embree_renderer<Real>(compiled);
        const Film plain = rendered(*embree, scene, settings);
        settings.layers = test::all_layers();
        settings.layers.object_entries = 256;
        const Film film = rendered(*embree, scene, settings);
        EXPECT_EQ(record_hash(film), record_hash(plain)) << scene.source;
        EXPECT_EQ(film.rays.total(), plain.rays.total()) << scene.source;
        EXPECT_EQ(film.flags, plain.flags) << scene.source;
        EXPECT_EQ(test::first_fault_of_layers(film), "") << scene.source;
        const Film other = rendered(*make_host_renderer<Real>(compiled, HostIntersector::bvh), scene, settings);
        EXPECT_EQ(film_hash(other), film_hash(film)) << scene.source;
        EXPECT_EQ(other.rays.total(), film.rays.total()) << scene.source;
        EXPECT_EQ(other.flags, film.flags) << scene.source;
        EXPECT_EQ(test::first_fault_of_layers(other), "") << scene.source;
        EXPECT_TRUE(test::ordered_words(other) == test::ordered_words(film)) << scene.source;
    }
};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Layers, Reals);

TYPED_TEST(Layers, OfAllScenesAddUp) {
    for (const std::string& name : golden::scene_names(test::scene_folder)) {
        const SceneDescription scene = test::shipped_scene(name);
        FrameSettings settings = golden::settings_for(scene);
        settings.set_size(64, 40);
        this->check(scene, settings);
    }
}

TYPED_TEST(Layers, OfGeneratedScenesAddUp) {
    for (uint64_t seed = 7; seed < generated_scene_count; seed += generated_scene_count / 50) {
        const SceneDescription scene = generated_scene(seed, test::scene_folder);
        this->check(scene, generated_settings(scene));
    }
}

TYPED_TEST(Layers, OfAdaptiveFramesAddUp) {
    std::vector<SceneDescription> all = {test::shipped_scene("glass"), test::shipped_scene("platonic")};
    for (uint64_t seed = 4; seed < generated_scene_count; seed += generated_scene_count / 6)
        all.push_back(generated_scene(seed, test::scene_folder));
    for (const SceneDescription& scene : all) {
        FrameSettings settings = golden::settings_for(scene);
        settings.set_size(24, 14);
        settings.depth = std::min(scene.depth, 8);
        settings.target_error = 0.05;
        this->check(scene, settings);
    }
}

/// Twice as much light of a group adds what its layer holds.
TYPED_TEST(Layers, OfALightAreWhatMoreOfItAdds) {
    SceneDescription scene = test::shipped_scene("platonic");
    FrameSettings settings = golden::settings_for(scene);
    settings.set_size(64, 36);
    settings.layers.light = true;
    const Film film = rendered(*make_embree_renderer<TypeParam>(compile_scene<TypeParam>(scene)), scene, settings);
    const std::vector<std::string>& groups = film.layers.names->light_groups;
    ASSERT_GE(groups.size(), 3u);
    for (size_t group = 0; group < groups.size(); ++group) {
        ASSERT_EQ(groups[group], "light" + std::to_string(group));
        SceneDescription brighter = scene;
        brighter.lights[group].color *= 2;
        brighter.lights[group].glow = scene.lights[group].glow.value_or(scene.lights[group].color);
        const Film more =
            rendered(*make_embree_renderer<TypeParam>(compile_scene<TypeParam>(brighter)), brighter, settings);
        double added = 0, off = 0;
        for (size_t i = 0; i < film.pixels.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const size_t word = i * size_t(film.layers.plan.words) + size_t(film.layers.plan.light) +
                                    3 * (common_light_layers + group) + size_t(c);
                const double layer = double(film.layers.words[word]) * film.unit();
                added = std::max(added, layer);
                off = std::max(off, std::abs(double(more.pixels[i].radiance[c]) * more.unit() -
                                             double(film.pixels[i].radiance[c]) * film.unit() - layer));
            }
        EXPECT_GT(added, 0.01) << groups[group];
        EXPECT_LT(off, 1e-5 * added) << groups[group];
    }
}

/// A tree that is dropped and traced again with a larger budget enters its layers once.
TYPED_TEST(Layers, OfTreesWithoutEndAddUp) {
    const SceneDescription scene = test::shipped_scene("hard/furnace");
    FrameSettings settings = golden::settings_for(scene);
    settings.set_size(12, 8);
    settings.depth = 1024;
    settings.target_error = 0.02;
    this->check(scene, settings);
}

}  // namespace
