// Planes without end and disks of compiled scenes: size, shared planes, textures, lights, effects and limits.
#include <gtest/gtest.h>

#include "cistula/traversal/brute.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/materials/required_effects.h"
#include "scene/compile/solids/compile_disks.h"
#include "scene/compile/solids/smallest_part.h"
#include "scene/description/without_effect.h"
#include "testing/support/expect_error.h"
#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

using samples::add_light;
using samples::add_object;
using samples::empty_scene;
using samples::solid;
using samples::square;

DiskObject disk(const glm::dvec3& center, const glm::dvec3& normal, double radius) {
    return {center, normal, radius};
}

template <class Real>
class Planes : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Planes, Precisions);

TYPED_TEST(Planes, DoNotCountForTheExtent) {
    using Real = TypeParam;
    SceneDescription scene = empty_scene();
    add_object(scene, DiskObject::plane({0, 0, 2}, 20));
    add_object(scene, disk({3, 2, 1}, {0, 0, 1}, 0.5));
    const auto compiled = compile_scene<Real>(scene);
    EXPECT_EQ(compiled->center, Vec3<double>(3, 2, 1));
    EXPECT_EQ(compiled->extent, Real(1));
    EXPECT_EQ(compiled->scale, 1);
    ASSERT_EQ(compiled->disks.size(), 2u);
    const Disk<Real>& plane = compiled->disks[0];
    EXPECT_EQ(compiled->shared_planes[plane.plane].normal, Vec3<Real>(0, 0, 1));
    EXPECT_EQ(compiled->shared_planes[plane.plane].offset, Real(18));
    EXPECT_EQ(plane.center, Vec3<Real>(0, 0, 18));
    EXPECT_EQ(plane.square, Real(0x1p24));
    EXPECT_EQ(plane.least_slope, horizon<Real>);
    EXPECT_GT(compiled->disks[1].least_slope, Real(1)) << "a disk ends";
    EXPECT_EQ(compiled->disks[1].square, Real(1));
    EXPECT_TRUE(compiled->convex.empty() && compiled->clusters.empty());
    EXPECT_NEAR(smallest_part(scene).share, std::sqrt(0.5), 1e-12) << "half the width of the disk's square";
}

TYPED_TEST(Planes, AloneHaveTheExtentOfLightsAndOffsets) {
    SceneDescription scene = empty_scene();
    add_object(scene, DiskObject::plane({0, 0, 1}, 0));
    EXPECT_EQ(compile_scene<TypeParam>(scene)->extent, TypeParam(1));
    add_light(scene, {0, 0, 8000});
    const auto compiled = compile_scene<TypeParam>(scene);
    EXPECT_EQ(compiled->center, Vec3<double>(0, 0, 4000));
    EXPECT_EQ(compiled->scale, -11);
}

TYPED_TEST(Planes, ShareTheirPlaneWithWhatTouches) {
    using Real = TypeParam;
    SceneDescription scene = empty_scene();
    add_object(scene, DiskObject::plane({0, 0, 1}, 0));
    add_object(scene, solid(PlatonicSolid::cube, {0, 0, 1 / std::sqrt(3.0)}));
    add_object(scene, square(0.5));
    add_object(scene, disk({1, 0, 0}, {0, 0, -1}, 0.5));
    add_object(scene, DiskObject::plane({1, 0, 0}, 3));
    const auto compiled = compile_scene<Real>(scene);
    EXPECT_EQ(compiled->shared_planes.size(), 2u);
    const SceneView<Real> view = compiled->view();
    const uint32_t floor = compiled->disks[0].plane;
    EXPECT_EQ(compiled->disks[1].plane, floor);
    EXPECT_NE(compiled->disks[2].plane, floor);
    EXPECT_NE(face_on(view, view.solids[1], floor), no_face);
    EXPECT_EQ(plane_of_face(view, 2, view.solids[2].first_triangle), floor);
    for (const Disk<Real>& each : compiled->disks) EXPECT_EQ(plane_of_face(view, each.solid, each.face), each.plane);
    EXPECT_EQ(compiled->solids[0].near_count, 2u) << "planes cross, if only far away";
}

TYPED_TEST(Planes, HaveTextureCoordinates) {
    using Real = TypeParam;
    SceneDescription scene = empty_scene();
    add_object(scene, DiskObject::plane({0, 0, 1}, 0));
    add_object(scene, disk({2, 0, 1}, {-2, 0, 0}, 0.5));
    const auto compiled = compile_scene<Real>(scene);
    const SceneView<Real> view = compiled->view();
    const double factor = std::ldexp(1.0, compiled->scale);
    const auto uv = [&](const glm::dvec3& from, const glm::dvec3& toward) {
        Ray<Real> ray;
        ray.origin = Vec3<Real>((from - compiled->center) * factor);
        ray.direction = Vec3<Real>(normalized(toward));
        const Hit<Real> hit = BruteIntersector<Real>{view}.closest(ray);
        EXPECT_TRUE(hit.found());
        return texture_uv(view, hit, Vec3<Real>());
    };
    const double close = sizeof(Real) == 4 ? 1e-5 : 1e-14;
    const Vec2<Real> on_plane = uv({1.25, 0.5, 0.5}, {0, 0, -1});
    EXPECT_NEAR(on_plane.x, 1.25, close);
    EXPECT_NEAR(on_plane.y, 0.5, close);
    const Vec2<Real> on_disk = uv({1.5, 0.25, 1.125}, {1, 0, 0});  // u is y, v is -x cross y
    EXPECT_NEAR(on_disk.x, 0.75, close);
    EXPECT_NEAR(on_disk.y, 0.375, close);
}

TYPED_TEST(Planes, AreMetFromBeyondTheScene) {
    using Real = TypeParam;
    SceneDescription scene = empty_scene();
    add_object(scene, DiskObject::plane({0, 0, 1}, 0));
    add_object(scene, DiskObject::plane({0, 0, 1}, 100));
    add_object(scene, solid(PlatonicSolid::cube, {0, 0, 0}));
    const auto compiled = compile_scene<Real>(scene);
    const SceneView<Real> view = compiled->view();
    const auto hits = [&](const Vec3<Real>& from, const Vec3<Real>& toward) {
        Ray<Real> ray;
        ray.origin = from;
        ray.direction = toward;
        const Real moved = start_near<Effects<all_effects>>(view, ray);
        std::vector<std::pair<uint32_t, double>> found;
        for (;;) {
            const Hit<Real> hit = BruteIntersector<Real>{view}.closest(ray);
            if (!hit.found()) return found;
            found.push_back({key_solid(hit.key), double(hit.t + moved)});
            if (media_change(key_kind(hit.key)) != 0)
                ray.media.add(key_solid(hit.key), media_change(key_kind(hit.key)));
            ray.after = {hit.t, hit.key};
        }
    };
    const double side = double(compiled->extent);
    const double high = 100 * std::ldexp(1.0, compiled->scale);
    const auto down = hits({Real(0.1), 0, Real(2 * high)}, {0, 0, -1});
    ASSERT_EQ(down.size(), 4u);
    const uint32_t order[] = {1, 2, 0, 2};
    const double at[] = {high, 2 * high - side, 2 * high, 2 * high + side};
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(down[i].first, order[i]);
        EXPECT_NEAR(down[i].second, at[i], 1e-4);
    }
    EXPECT_EQ(hits({50, 0, Real(2 * high)}, {0, 0, -1}).size(), 2u);
    for (const double aside : {4e3, 5e3, 1e9}) EXPECT_EQ(hits({Real(aside), 0, 1}, {0, 0, -1}).size(), 1u);
    const Real flat = horizon<Real>;
    EXPECT_EQ(hits({0, 3, 1}, {1, 0, -flat}).size(), 1u);
    EXPECT_EQ(hits({0, 3, 1}, {1, 0, -flat / 2}).size(), 0u) << "too flat for so far away";
    EXPECT_EQ(hits({0, 3, flat}, {1, 0, -flat / 2}).size(), 1u) << "near, any line meets it";
}

TYPED_TEST(Planes, HoldLights) {
    SceneDescription scene = empty_scene();
    add_object(scene, DiskObject::plane({0, 0, 1}, 0));
    add_object(scene, disk({0, 0, 1}, {1, 0, 0}, 0.5));
    add_light(scene, {3, 4, 0});
    add_light(scene, {0, 0.25, 1.25});
    add_light(scene, {0, 2, 1});
    const auto compiled = compile_scene<TypeParam>(scene);
    ASSERT_EQ(compiled->lights.size(), 3u);
    for (size_t i = 0; i < 2; ++i) {
        ASSERT_EQ(compiled->lights[i].incident_count, 1u) << i;
        EXPECT_EQ(compiled->incidents[compiled->lights[i].first_incident].solid, i);
    }
    EXPECT_EQ(compiled->lights[2].incident_count, 0u) << "beside the disk";
}

TEST(PlanesOfScenes, AreAnEffect) {
    SceneDescription scene = empty_scene();
    add_object(scene, DiskObject::plane({0, 0, 1}, 0));
    const uint32_t effects = required_effects(scene);
    EXPECT_EQ(effects & (effect_planes | effect_contacts | effect_triangles | effect_solids),
              effect_planes | effect_contacts);
    EXPECT_FALSE(without_effect(scene, effect_planes).has_value()) << "nothing is left";
    add_object(scene, solid(PlatonicSolid::cube));
    EXPECT_EQ(without_effect(scene, effect_planes).value().objects.size(), 1u);
}

TEST(PlanesOfScenes, AreAtMostAFew) {
    SceneDescription scene = empty_scene();
    const auto add = [&] {
        const auto i = double(scene.objects.size());
        add_object(scene,
                   scene.objects.size() % 2 == 0 ? DiskObject::plane({0, 0, 1}, i) : disk({1, 2, i}, {1, 1, 1}, 1));
    };
    while (scene.objects.size() < most_disks) add();
    EXPECT_EQ(compile_scene<float>(scene)->disks.size(), most_disks);
    add();
    EXPECT_ERROR(compile_scene<float>(scene), ExitCode::usage,
                 "test.json: /objects/64: more than 64 planes and disks; make some of them quads or triangles");
}

TEST(PlanesOfScenes, NumbersOfProgramsAreChecked) {
    SceneDescription scene = empty_scene();
    add_object(scene, disk({0, 0, 0}, {0, 0, 0}, 1));
    EXPECT_ERROR(compile_scene<float>(scene), ExitCode::usage, "test.json: /objects/0: the normal is 0");
    scene.objects[0].shape = disk({0, 0, 0}, {0, 0, 1}, -1);
    EXPECT_ERROR(compile_scene<float>(scene), ExitCode::usage,
                 "test.json: /objects/0: radius: expected a number from 1e-30 to 1e30");
    scene.objects[0].shape = disk({0, NAN, 0}, {0, 0, 1}, 1);
    EXPECT_ERROR(compile_scene<float>(scene), ExitCode::usage,
                 "test.json: /objects/0: center: expected [x, y, z], each from -1e30 to 1e30");
}

}  // namespace
}  // namespace cistula
