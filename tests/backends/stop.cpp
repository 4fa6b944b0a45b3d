// A render that is stopped ends soon, however large the trees of its pixels, and the next one is not touched by it.
#include <gtest/gtest.h>

#include "backend_embree/embree/embree_renderer.h"
#include "render/record/film_difference.h"
#include "scene/compile/compiled_scene.h"
#include "testing/support/endless_scene.h"
#include "testing/support/stopping.h"
#include "verify/reference_renderers.h"

namespace cistula {
namespace {

constexpr double soon = 2;  // seconds, on a machine that has other things to do

template <class Real>
class Stop : public testing::Test {
  protected:
    const SceneDescription scene = test::room_of_mirrors();
    const CameraFrame camera = camera_at(scene.camera, 0);
    const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(scene);

    void check(Renderer& renderer, const FrameSettings& settings) {
        const test::Stopped stopped = test::render_stopped(renderer, camera, settings, 0.1);
        EXPECT_FALSE(stopped.whole) << renderer.intersector();
        EXPECT_GT(stopped.seconds, -0.05) << renderer.intersector() << ": the frame is not endless";
        EXPECT_LT(stopped.seconds, soon) << renderer.intersector();
        FrameSettings short_settings = test::endless_settings(16, 9);
        short_settings.depth = 2;
        Film film, other;
        RenderProgress progress;
        EXPECT_TRUE(renderer.render(camera, short_settings, film, progress));
        EXPECT_TRUE(make_host_renderer<Real>(compiled, HostIntersector::brute)
                        ->render(camera, short_settings, other, progress));
        EXPECT_EQ(record_hash(film), record_hash(other)) << renderer.intersector();
    }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Stop, Reals);

TYPED_TEST(Stop, WithinAPixel) {
    FrameSettings settings = test::endless_settings(96, 54);
    settings.crop = {40, 25, 1, 1};
    this->check(*make_host_renderer<TypeParam>(this->compiled, HostIntersector::brute), settings);
    EmbreeOptions tree;
    tree.always_tree = true;
    this->check(*make_embree_renderer<TypeParam>(this->compiled, tree), settings);
}

TYPED_TEST(Stop, WithinATileOfManySamples) {
    FrameSettings settings = test::endless_settings(96, 54);
    settings.supersample = 16;
    this->check(*make_embree_renderer<TypeParam>(this->compiled), settings);
}

TYPED_TEST(Stop, WithinAnAdaptivePixel) {
    FrameSettings settings = test::endless_settings(96, 54);
    settings.target_error = 1e-6;
    settings.crop = {40, 25, 3, 3};
    this->check(*make_embree_renderer<TypeParam>(this->compiled), settings);
}

}  // namespace
}  // namespace cistula
