// What a frame leaves out shows background, whatever the camera; and it leaves out much of what does.
#include <gtest/gtest.h>

#include <algorithm>

#include "cistula/adaptive/adaptive_pixel.h"
#include "cistula/traversal/bvh.h"
#include "render/frame/frame_hints.h"
#include "render/frame/frame_view.h"
#include "testing/support/camera.h"
#include "testing/support/golden.h"
#include "testing/support/scene.h"
#include "testing/support/shipped_scenes.h"
#include "verify/scenes/generated_scene.h"

using namespace cistula;

namespace {

struct Share {
    size_t left_out = 0, background = 0, all = 0;
};

/// Renders every pixel, covered or not, and expects those that are left out to be background.
template <class Real>
void expect_sound(const CompiledScene<Real>& scene, const SceneView<Real>& view, const CameraFrame& camera,
                  const FrameSettings& settings, const std::string& what, Share& share) {
    const BvhIntersector<Real> intersector{view};
    FrameView frame = frame_view(scene, camera, settings);
    find_camera_solids(view, intersector, frame);
    const PixelRect& rect = settings.crop;
    const FrameHints hints = frame_hints(scene, frame, settings);
    const bool gradual = shades_gradually(view);
    size_t wrong = 0;
    for (int y = 0; y < rect.height; ++y)
        hints.cover.for_each_part(y, 0, rect.width, [&](int begin, int end, bool covered) {
            for (int x = begin; x < end; ++x) {
                PixelRecord record;
                PixelWork work;
                using E = Effects<effect_masks[limited_mask]>;
                using Stack = StackOf<Real, E, InteriorList>;
                typename Stack::Storage storage;
                Stack stack(storage);
                const PixelTask<E, BvhIntersector<Real>, Stack> task{view,       frame, intersector, rect.x + x,
                                                                     rect.y + y, work,  stack};
                if (settings.adaptive())
                    render_adaptive_pixel(task, gradual, record);
                else
                    render_pixel(task, SampleRange(), record);
                const bool checked = settings.adaptive() && is_checked(task.x, task.y);
                const BackgroundPixel& background = checked ? hints.checked : hints.background;
                const bool is_background = test::same_bytes(record, background.record);
                share.all += 1;
                share.background += is_background;
                share.left_out += !covered;
                if (!covered) wrong += !is_background || work.rays.total() != background.work.rays.total();
            }
        });
    EXPECT_EQ(wrong, 0u) << what;
}

/// The cover of a frame of 40 x 30 pixels.
template <class Real>
FrameCover cover_of(const SceneDescription& description) {
    const auto scene = compile_scene<Real>(description);
    FrameSettings settings;
    settings.set_size(40, 30);
    return frame_hints(*scene, frame_view(*scene, camera_at(description.camera, 0), settings), settings).cover;
}

template <class Real>
class Cover : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Cover, Reals);

TYPED_TEST(Cover, LeavesOutBackgroundOnly) {
    test::Random random(19);
    Share share;
    const auto check = [&](const SceneDescription& description, const std::string& what) {
        const auto scene = compile_scene<TypeParam>(description);
        build_primitive_tree(*scene);
        const SceneView<TypeParam> view = scene->view();
        FrameSettings settings;
        settings.set_size(64, 36);
        settings.depth = 1;
        expect_sound(*scene, view, camera_at(description.camera, 0), settings, what, share);
        settings.crop = {5, 3, 51, 30};
        for (int i = 0; i < 6; ++i) {
            settings.supersample = i % 2 + 1;
            const CameraDescription camera = test::random_camera(random, description.camera);
            expect_sound(*scene, view, camera_at(camera, 0), settings, what + ", camera " + std::to_string(i), share);
        }
        settings.supersample = 1;
        settings.target_error = 0.01;
        settings.max_samples = 32;
        expect_sound(*scene, view, camera_at(description.camera, 0), settings, what + ", adaptive", share);
    };
    for (const std::string& name : golden::scene_names(test::scene_folder)) check(test::shipped_scene(name), name);
    for (uint64_t seed = 0; seed < generated_scene_count; seed += 4)
        check(generated_scene(seed, test::scene_folder), "seed " + std::to_string(seed));
    SceneDescription with_lights = test::shipped_scene("benchmark");
    for (const int more : {10, 90}) {  // with an outline each, then one for all
        test::add_visible_lights(with_lights, more);
        check(with_lights, std::to_string(with_lights.lights.size()) + " lights");
    }
    // All in all little background is rendered.
    EXPECT_GT(share.left_out, share.background / 2);
}

TYPED_TEST(Cover, IsTightAroundConvexThings) {
    const SceneDescription description = test::shipped_scene("benchmark");
    const auto scene = compile_scene<TypeParam>(description);
    build_primitive_tree(*scene);
    FrameSettings settings;
    settings.set_size(640, 360);
    settings.depth = 1;
    Share share;
    expect_sound(*scene, scene->view(), camera_at(description.camera, 0), settings, "benchmark", share);
    EXPECT_GT(share.background, share.all / 2);
    EXPECT_GT(share.left_out, share.background - share.all / 20);
}

TYPED_TEST(Cover, ManyHullsHaveOneOutline) {
    SceneDescription description = test::shipped_scene("benchmark");
    for (const int light_count : {10, 100}) {
        description.lights.clear();
        test::add_visible_lights(description, light_count);
        const auto outlines = cover_of<TypeParam>(description).outlines();
        ASSERT_EQ(outlines.size(), light_count == 10 ? 14u : 1u);
        EXPECT_EQ(outlines.back().hull, light_count == 10 ? size_t{13} : FrameCover::Outline::all);
    }
}

TYPED_TEST(Cover, CoversAllAroundACameraWithinAHull) {
    SceneDescription description = test::shipped_scene("benchmark");
    description.camera = CameraDescription();
    description.camera.position = {-2.5, 2.5, 2};
    description.camera.target = {1, 2, 3};
    const FrameCover cover = cover_of<TypeParam>(description);
    const std::vector<PixelRun> all = {{0, 40}};
    for (int y = 0; y < 30; ++y) EXPECT_TRUE(std::ranges::equal(cover.runs(y), all)) << y;
}

TYPED_TEST(Cover, IsEmptyWhereAllIsBehindTheCamera) {
    SceneDescription description = test::shipped_scene("benchmark");
    description.camera = CameraDescription();
    description.camera.position = {30, 0, 0};
    description.camera.target = {60, 0, 0};
    const FrameCover cover = cover_of<TypeParam>(description);
    for (int y = 0; y < 30; ++y) EXPECT_TRUE(cover.runs(y).empty()) << y;
}

TEST(FrameCover, PartsOfARowAreInOrderAndWhole) {
    Hull left, right;
    left.points = {{-0.5, -0.1, 0}, {-0.4, 0.1, 0}, {-0.4, -0.1, 0}};
    right.points = {{0.4, -0.1, 0}, {0.5, 0.1, 0}, {0.5, -0.1, 0}};
    const FrameView frame = test::frame_from({0, 0, 2}, 0.5, 100, 50);
    FrameCover cover({0, 0, 100, 50});
    cover.add(0, right, 1, frame);
    cover.add(1, left, 1, frame);
    ASSERT_EQ(cover.runs(25).size(), 2u);
    EXPECT_LT(cover.runs(25)[0].end, cover.runs(25)[1].begin);
    EXPECT_TRUE(cover.runs(2).empty());
    std::string row(100, '?');
    cover.for_each_part(25, 10, 90, [&](int begin, int end, bool covered) {
        for (int x = begin; x < end; ++x) row[size_t(x)] = covered ? '#' : '.';
    });
    EXPECT_EQ(row.substr(0, 10), std::string(10, '?'));
    EXPECT_EQ(row.substr(10, 80).find('?'), std::string::npos);
    EXPECT_EQ(row[27], '#');  // where x / z is -0.225
    EXPECT_EQ(row[50], '.');
    EXPECT_EQ(row[72], '#');
}

}  // namespace
