// Spheres of compiled scenes: families, what is near them, textures, lights and effects.
#include <gtest/gtest.h>

#include "cistula/shading/surface.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/materials/required_effects.h"
#include "scene/compile/scene_source.h"
#include "scene/compile/solids/smallest_part.h"
#include "scene/description/without_effect.h"
#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

using samples::add_light;
using samples::add_object;
using samples::empty_scene;
using samples::solid;
using samples::square;

SphereObject sphere(const glm::dvec3& center, double radius) {
    SphereObject object;
    object.center = center;
    object.radius = radius;
    return object;
}

template <class Real>
class Spheres : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Spheres, Precisions);

TYPED_TEST(Spheres, CountForTheExtent) {
    SceneDescription scene = empty_scene();
    add_object(scene, sphere({1, 2, 3}, 4));
    const auto compiled = compile_scene<TypeParam>(scene);
    EXPECT_EQ(compiled->center, Vec3<double>(1, 2, 3));
    EXPECT_EQ(compiled->extent, TypeParam(1));
    ASSERT_EQ(compiled->balls.size(), 1u);
    EXPECT_EQ(compiled->balls[0].radius, TypeParam(1));
    EXPECT_EQ(compiled->convex, std::vector<uint32_t>{0});
    EXPECT_TRUE(is_ball(compiled->solids[0]));
    EXPECT_EQ(compiled->hulls[0].reach, 1.0);
    const PaddedBox box = primitive_box(compiled->view(), 0);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(box.low[axis], -1);
        EXPECT_GT(box.low[axis], -1.001);
        EXPECT_GE(box.high[axis], 1);
    }
}

TYPED_TEST(Spheres, ThatCoincideAreOneSurface) {
    using Real = TypeParam;
    SceneDescription scene = empty_scene();
    const double unit = double(RealTraits<Real>::unit);
    add_object(scene, sphere({0, 0, 0}, 1));
    add_object(scene, sphere({0.2, 0, 0}, 0.5));
    add_object(scene, sphere({0.2, 8 * unit, 0}, 0.5 + 4 * unit));
    add_object(scene, sphere({0.2, 0, 0}, 0.5 + 40 * unit));
    const auto compiled = compile_scene<Real>(scene);
    const auto& balls = compiled->balls;
    EXPECT_EQ(balls[1].center, balls[2].center);
    EXPECT_EQ(balls[1].radius, balls[2].radius);
    EXPECT_NE(balls[1].radius, balls[3].radius);
    const std::vector<uint32_t> families = {0, 1, 1, 3}, kin = {0, 1, 1, 0};
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(balls[i].family, families[i]);
        EXPECT_EQ(balls[i].has_kin, kin[i]);
    }
}

TYPED_TEST(Spheres, KnowTheSheetsAndMeshesNearThem) {
    SceneDescription scene = empty_scene();
    add_object(scene, square(2));
    add_object(scene, sphere({0, 0, 0.5}, 0.5));  // on the square
    add_object(scene, sphere({0, 0, 1.5}, 0.4));  // over it
    add_object(scene, square(2, 1.5));            // cuts the second
    TrianglesObject cube = triangulated_solid(solid(PlatonicSolid::cube, {1.5, 0, 1.5}, 1));
    cube.keep_triangles = true;
    add_object(scene, cube);  // its box meets no ball's
    cube = triangulated_solid(solid(PlatonicSolid::cube, {-0.6, 0, 1.5}, 0.5));
    cube.keep_triangles = true;
    add_object(scene, cube);
    const auto compiled = compile_scene<TypeParam>(scene);
    const auto& balls = compiled->balls;
    ASSERT_EQ(compiled->ball_planes.size(), 2u);
    EXPECT_EQ(balls[0].plane_count, 1u);
    EXPECT_EQ(balls[0].near_meshes, 0u);
    EXPECT_EQ(balls[1].plane_count, 1u);
    EXPECT_EQ(balls[1].near_meshes, 1u);
    EXPECT_NE(compiled->near_planes[balls[0].first_plane], compiled->near_planes[balls[1].first_plane]);
    EXPECT_TRUE(is_sheet_near_ball(compiled->solids[0]));
    EXPECT_TRUE(is_sheet_near_ball(compiled->solids[3]));
}

TYPED_TEST(Spheres, HaveLongitudesAndLatitudes) {
    using Real = TypeParam;
    SceneDescription scene = empty_scene();
    add_object(scene, sphere({0, 0, 0}, 1));
    SphereObject turned = sphere({0, 0, 0}, 0.5);
    turned.rotation = {0, 90, 0};  // its pole lies on the x axis
    add_object(scene, turned);
    const auto compiled = compile_scene<Real>(scene);
    const auto uv = [&](size_t ball, Real x, Real y, Real z) { return ball_uv(compiled->balls[ball], {x, y, z}); };
    const auto expect = [](const Vec2<Real>& found, double u, double v) {
        EXPECT_EQ(found.x, Real(u));
        EXPECT_EQ(found.y, Real(v));
    };
    expect(uv(0, 1, 0, 0), 0.5, 0.5);
    expect(uv(0, 0, 1, 0), 0.75, 0.5);
    expect(uv(0, 0, -1, 0), 0.25, 0.5);
    expect(uv(0, -1, 0, 0), 1, 0.5);
    expect(uv(0, 0, 0, 1), 0.5, 0);
    expect(uv(0, 0, 0, -1), 0.5, 1);
    expect(uv(1, 1, 0, 0), 0.5, 0);
    expect(uv(1, 0, 1, 0), 0.75, 0.5);
}

TYPED_TEST(Spheres, HoldNoLightsOnTheirSurface) {
    SceneDescription scene = empty_scene();
    add_object(scene, sphere({0, 0, 0}, 1));
    add_light(scene, {0, 0.6, 0.8});
    samples::expect_error([&] { compile_scene<TypeParam>(scene); }, ExitCode::usage, "/lights/0");
    scene.lights[0].color = glm::dvec3(0);
    compile_scene<TypeParam>(scene);
    scene.lights[0].color = glm::dvec3(1);
    scene.lights[0].position *= 1.001;
    compile_scene<TypeParam>(scene);
}

TEST(SphereScenes, CallForTheirEffect) {
    SceneDescription scene = empty_scene();
    add_object(scene, sphere({0, 0, 0}, 1));
    const uint32_t effects = required_effects(scene);
    EXPECT_TRUE((effects & effect_spheres) != 0);
    EXPECT_TRUE((effects & (effect_solids | effect_triangles)) == 0);
    EXPECT_EQ(least_mask(effects), ball_mask);
    EXPECT_FALSE(without_effect(scene, effect_spheres).has_value()) << "nothing is left";
    add_object(scene, square());
    EXPECT_EQ(without_effect(scene, effect_spheres).value().objects.size(), 1u);
    EXPECT_EQ(without_effect(scene, effect_solids).value().objects.size(), 2u);
}

TEST(SphereScenes, DifferInTheirHashes) {
    SceneDescription scene = empty_scene();
    add_object(scene, sphere({0, 0, 0}, 1));
    add_object(scene, sphere({2, 0, 0}, 1));
    const auto hash = [&] { return compile_scene<float>(scene)->hashes.of(0); };
    const auto first = hash();
    std::get<SphereObject>(scene.objects[0].shape).rotation = {1, 2, 3};
    EXPECT_EQ(hash(), first) << "a turn is not seen without a texture";
    std::get<SphereObject>(scene.objects[0].shape).radius = 0.9;
    EXPECT_NE(hash(), first);
}

TEST(SphereScenes, TakeDoubleWhereTheyAreTiny) {
    SceneDescription scene = empty_scene();
    add_object(scene, sphere({0, 0, 0}, 1));
    add_object(scene, sphere({2, 0, 0}, 1e-5));
    const SmallestPart part = smallest_part(scene);
    EXPECT_LT(part.share, 0x1p-13);
    EXPECT_NE(part.what.find("its radius"), std::string::npos);
}

}  // namespace
}  // namespace cistula
