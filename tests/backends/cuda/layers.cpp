// Layers that a GPU fills: those of the CPU, word by word, however a frame is divided.
#include <gtest/gtest.h>

#include "backend_cuda/host/cuda_renderer.h"
#include "backend_embree/embree/embree_renderer.h"
#include "scene/description/camera_path.h"
#include "testing/support/golden.h"
#include "testing/support/gpu.h"
#include "testing/support/pictures/film_layers.h"
#include "testing/support/shipped_scenes.h"
#include "verify/scenes/generated_scene.h"

using namespace cistula;

namespace {

template <class Real>
class CudaLayers : public ::testing::Test {
  protected:
    static Film rendered(Renderer& renderer, const SceneDescription& scene, const FrameSettings& settings) {
        Film film;
        RenderProgress progress;
        EXPECT_TRUE(renderer.render(camera_at(scene.camera, 0), settings, film, progress));
        return film;
    }

    static void check(const SceneDescription& scene, FrameSettings settings, const CudaOptions& options = {}) {
        settings.layers = test::all_layers();
        settings.layers.object_entries = 256;
        const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(scene);
        const Film expected = rendered(*make_embree_renderer<Real>(compiled), scene, settings);
        const auto gpu = make_cuda_renderer<Real>(compiled, options);
        const Film film = rendered(*gpu, scene, settings);
        EXPECT_EQ(record_hash(film), record_hash(expected)) << scene.source;
        EXPECT_EQ(test::first_fault_of_layers(film), "") << scene.source;
        EXPECT_TRUE(test::ordered_words(film) == test::ordered_words(expected)) << scene.source;
        settings.layers = {};  // and without them again
        EXPECT_EQ(record_hash(rendered(*gpu, scene, settings)), record_hash(expected)) << scene.source;
    }
};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(CudaLayers, Reals);

TYPED_TEST(CudaLayers, OfAllScenesAreThoseOfTheCpu) {
    CISTULA_NEEDS_GPU();
    for (const std::string& name : golden::scene_names(test::scene_folder)) {
        const SceneDescription scene = test::shipped_scene(name);
        this->check(scene, golden::settings_for(scene));
    }
}

TYPED_TEST(CudaLayers, OfGeneratedScenesAreThoseOfTheCpu) {
    CISTULA_NEEDS_GPU();
    for (uint64_t seed = 0; seed < generated_scene_count; seed += 2) {
        const SceneDescription scene = generated_scene(seed, test::scene_folder);
        this->check(scene, generated_settings(scene));
    }
}

TYPED_TEST(CudaLayers, OfAdaptiveFramesAreThoseOfTheCpu) {
    CISTULA_NEEDS_GPU();
    std::vector<SceneDescription> all = {test::shipped_scene("glass"), test::shipped_scene("platonic"),
                                         test::shipped_scene("hard/furnace")};
    for (uint64_t seed = 1; seed < generated_scene_count; seed += 20)
        all.push_back(generated_scene(seed, test::scene_folder));
    for (const SceneDescription& scene : all) {
        FrameSettings settings = golden::settings_for(scene);
        settings.set_size(70, 41);  // no multiple of a tile
        settings.depth = std::min(scene.depth, 8);
        settings.target_error = 0.03;
        this->check(scene, settings);
    }
}

TYPED_TEST(CudaLayers, OfFramesInPartsAreThoseOfTheCpu) {
    CISTULA_NEEDS_GPU();
    const SceneDescription scene = test::shipped_scene("platonic");
    FrameSettings settings = golden::settings_for(scene);
    settings.set_size(203, 151);
    settings.crop = {3, 5, 190, 140};
    CudaOptions options;
    options.memory_limit = size_t{64} << 20;  // 5 KB a pixel, tables of 256 objects among them
    this->check(scene, settings, options);
}

}  // namespace
