// The GPU's path on the host: the intersectors and forms of media that its kernels use, through render_pixel. The
// integers are those of the CPU backend.
#include <gtest/gtest.h>

#include <type_traits>
#include <utility>

#include "cistula/model/constant_scene.h"
#include "cistula/traversal/ball_loop.h"
#include "cistula/traversal/bvh.h"
#include "render/frame/frame_view.h"
#include "scene/compile/constant_scene.h"
#include "scene/description/without_effect.h"
#include "testing/support/contacts/contact_search.h"
#include "testing/support/golden.h"
#include "testing/support/shipped_scenes.h"
#include "verify/scenes/generated_scene.h"

using namespace cistula;

namespace {

/// A frame as a device renders it: where pixels have several samples, threads share them.
template <class Real, class E, class Scene, class Intersector>
void render_shared(const Scene& scene, const FrameView& frame, const Intersector& intersector, Film& film) {
    using Stack = StackOf<Real, E, typename Intersector::Media>;
    const int width = film.rect.width, threads = frame.supersample > 1 ? 4 : 1;
    for (int i = 0; i < int(film.pixels.size()); ++i)
        for (int thread = 0; thread < threads; ++thread) {
            typename Stack::Storage storage;
            Stack stack(storage);
            PixelRecord part;
            PixelWork work;
            const PixelTask<E, Intersector, Stack> task{
                scene, frame, intersector, film.rect.x + i % width, film.rect.y + i / width, work, stack};
            render_pixel(task, SampleRange{thread, threads}, part);
            film.rays.add(work.rays);
            film.flags |= work.flags;
            if (thread == 0)
                film.pixels.set(size_t(i), part);
            else
                film.pixels.change(size_t(i), [&](PixelRecord& pixel) { pixel.add(part); });
        }
}

template <class Real, class Intersector>
Film render_as_device(const CompiledScene<Real>& compiled, const typename Intersector::Scene& scene,
                      const SceneDescription& description, const FrameSettings& settings) {
    const SceneView<Real> view = compiled.view();
    const CameraFrame camera = camera_at(description.camera, 0);
    FrameView frame = frame_view(compiled, camera, settings);
    Film film;
    prepare_film(film, settings, compiled, camera);
    if (!find_camera_solids(view, BruteIntersector<Real>{view}, frame)) film.flags |= flag_media_overflow;
    const Intersector intersector{scene};
    // Few masks stand for all, which spares the compiler half of its work; tests of their own compare masks.
    constexpr int opaque = 0, middle = 2;
    const int least = mask_to_run(compiled.effects, settings, frame);
    if constexpr (requires { Intersector::few_are_lit; })
        render_shared<Real, Effects<effect_masks[ball_mask]>>(scene, frame, intersector, film);
    else if (least <= opaque)
        render_shared<Real, Effects<effect_masks[opaque]>>(scene, frame, intersector, film);
    else if (least <= middle)
        render_shared<Real, Effects<effect_masks[middle]>>(scene, frame, intersector, film);
    else
        render_shared<Real, Effects<effect_masks[limited_mask]>>(scene, frame, intersector, film);
    return film;
}

/// The loops that a scene takes as well as the tree, as bits.
enum Loops : uint32_t { plain_loop = 1, ball_loop = 2 };

/// Expects what the CPU backend gives, and returns the scene's loops.
template <class Real>
uint32_t check(const std::string& name, const SceneDescription& description, const FrameSettings& settings) {
    const std::shared_ptr<CompiledScene<Real>> compiled = compile_scene<Real>(description);
    const auto embree = make_embree_renderer<Real>(compiled, {.always_tree = true});
    const Film expected = golden::render_with(*embree, description, settings);
    EXPECT_EQ(expected.flags, 0u) << name;
    const auto expect_same = [&](const Film& film, const char* path) {
        const std::string where = name + ", " + path;
        EXPECT_EQ(film.flags, 0u) << where;
        EXPECT_EQ(record_hash(film), record_hash(expected)) << where;
        EXPECT_EQ(film.rays.primary, expected.rays.primary) << where;
        EXPECT_EQ(film.rays.reflected, expected.rays.reflected) << where;
        EXPECT_EQ(film.rays.transmitted, expected.rays.transmitted) << where;
        EXPECT_EQ(film.rays.shadow, expected.rays.shadow) << where;
    };
    using Tree = BvhIntersector<Real, InteriorList>;
    using PlainLoop = BruteIntersector<Real, SingleInterior, ConstantScene<Real>>;
    const FacetTree<Real> tree = facet_tree(compiled->view());
    SceneView<Real> view = compiled->view();
    tree.put_into(view);
    expect_same(render_as_device<Real, Tree>(*compiled, view, description, settings), "tree");
    const auto small = constant_scene(view);
    if (small) expect_same(render_as_device<Real, PlainLoop>(*compiled, *small, description, settings), "plain loop");
    const auto balls = ball_scene(view, view);
    const FrameView frame = frame_view(*compiled, camera_at(description.camera, 0), settings);
    const bool loops_over_balls = balls && mask_to_run(compiled->effects, settings, frame) == ball_mask;
    if (loops_over_balls)
        expect_same(render_as_device<Real, BallIntersector<Real>>(*compiled, *balls, description, settings),
                    "loop over balls");
    return (small ? plain_loop : 0u) | (loops_over_balls ? ball_loop : 0u);
}

template <class Real>
class DevicePathOnHost : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(DevicePathOnHost, Reals);

TYPED_TEST(DevicePathOnHost, GivesTheIntegersOfEveryGoldenScene) {
    uint32_t loops = 0;
    for (const std::string& name : golden::scene_names(test::scene_folder)) {
        const SceneDescription scene = test::shipped_scene(name);
        FrameSettings settings = golden::settings_for(scene);
        settings.set_size(64, 36);
        settings.cutoff = 0;
        settings.depth = std::min(settings.depth, 8);
        loops |= check<TypeParam>(name, scene, settings);
        settings.crop = {25, 15, 9, 7};
        settings.depth = scene.depth;
        settings.cutoff = 0.01;
        check<TypeParam>(name + " with a cutoff", scene, settings);
    }
    // The camera in a solid, whose rays begin in a medium.
    SceneDescription scene = test::shipped_scene("benchmark");
    scene.camera = CameraDescription();
    for (const ObjectDescription& object : scene.objects)
        if (const auto* solid = std::get_if<SolidObject>(&object.shape)) scene.camera.position = solid->center;
    FrameSettings settings = golden::settings_for(scene);
    settings.set_size(32, 32);
    check<TypeParam>("benchmark from within", scene, settings);
    EXPECT_TRUE(loops & plain_loop);
    // Nothing that a ledger would be for.
    scene = test::shipped_scene("benchmark");
    for (const Effect effect : {effect_transmission, effect_reflection}) scene = without_effect(scene, effect).value();
    settings = golden::settings_for(scene);
    settings.set_size(64, 36);
    ASSERT_EQ(compile_scene<TypeParam>(scene)->effects & (effect_reflection | effect_transmission), 0u);
    EXPECT_TRUE(check<TypeParam>("benchmark, opaque and dull", scene, settings));
    std::erase_if(scene.objects,
                  [](const ObjectDescription& object) { return !std::holds_alternative<SolidObject>(object.shape); });
    EXPECT_TRUE(check<TypeParam>("its solids", scene, settings));
}

TYPED_TEST(DevicePathOnHost, GivesTheIntegersOfGeneratedScenes) {
    uint32_t loops = 0;
    for (uint64_t seed = 2; seed < generated_scene_count; seed += 6) {
        const SceneDescription scene = generated_scene(seed, test::scene_folder);
        loops |= check<TypeParam>("seed " + std::to_string(seed), scene, generated_settings(scene));
    }
    EXPECT_EQ(loops, plain_loop | ball_loop);
}

/// Balls of glass, and mirrors, that touch one another, a floor and a wall, or stand apart from them. They take the
/// loop over balls, unless one is cut or inside another.
TYPED_TEST(DevicePathOnHost, GivesTheIntegersOfBalls) {
    SceneDescription plain = test::shipped_scene("spheres");
    plain.depth = 7;
    plain.objects.resize(1);  // the floor, at z = 0
    TrianglesObject wall;
    wall.vertices = {{-3, 2, 0}, {3, 2, 0}, {3, 2, 4}, {-3, 2, 4}};
    wall.triangles = {{0, 1, 2}, {0, 2, 3}};
    plain.objects.push_back({"wall", 1, wall, ""});
    const auto ball = [&](SceneDescription& scene, const glm::dvec3& center, double radius) {
        SphereObject sphere;
        sphere.center = center;
        sphere.radius = radius;
        scene.objects.push_back({"", 1 + int(scene.objects.size() % 3), sphere, ""});
    };
    const auto check_here = [&](const SceneDescription& scene, const char* name) {
        FrameSettings settings = golden::settings_for(scene);
        settings.set_size(64, 36);
        return check<TypeParam>(name, scene, settings);
    };
    SceneDescription scene = plain;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 2; ++k) ball(scene, {i - 1.0, 1.5, k + 0.5}, 0.5);
    ball(scene, {0.3, -1, 0.25}, 0.25);
    ball(scene, {-0.7, -1.2, 1.1}, 0.3);
    EXPECT_TRUE(check_here(scene, "touching"));
    SolidObject cube;
    cube.solid = PlatonicSolid::cube;
    cube.center = {2.2, -0.5, 0.8};
    cube.radius = 0.7;
    scene.objects.push_back({"", 2, cube, ""});
    EXPECT_TRUE(check_here(scene, "beside a cube"));
    scene.camera.position = {-0.65, -1.25, 1.1};
    EXPECT_TRUE(check_here(scene, "from within"));
    scene = plain;
    ball(scene, {0, 0, 0.3}, 0.5);
    EXPECT_FALSE(check_here(scene, "cut by the floor"));
    scene = plain;
    ball(scene, {0, 0, 1}, 0.5);
    ball(scene, {0, 0.1, 1}, 0.2);
    EXPECT_FALSE(check_here(scene, "nested"));
    scene = plain;
    for (int i = 0; i < 32; ++i) ball(scene, {0.2 * (i % 8) - 0.6, 0.2 * (i / 8), 0.1}, 0.1);
    EXPECT_TRUE(check_here(scene, "as many as fit"));
    ball(scene, {0, -1, 0.1}, 0.1);
    EXPECT_FALSE(check_here(scene, "one more"));
}

TYPED_TEST(DevicePathOnHost, GivesTheIntegersOfScenesWithContacts) {
    for (uint64_t seed = 0; seed < test::contact_scene_count; ++seed) {
        const SceneDescription scene = test::ContactSearch(seed).scene();
        check<TypeParam>("contacts, seed " + std::to_string(seed), scene, generated_settings(scene));
    }
}

}  // namespace
