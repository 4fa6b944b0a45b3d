// Lights of compiled scenes, and the faces that they lie on.
#include <cmath>

#include <gtest/gtest.h>

#include "scene/compile/compiled_scene.h"
#include "scene/compile/scene_source.h"
#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

using samples::add_light;
using samples::add_object;
using samples::empty_scene;
using samples::solid;
using samples::square;

template <class Real>
class CompileLights : public ::testing::Test {};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(CompileLights, Precisions);

TYPED_TEST(CompileLights, LightsOnEdgesLieOnTheTwoFacesOfTheirEdge) {
    using Real = TypeParam;
    for (int kind = 0; kind < 5; ++kind) {
        SceneDescription scene = empty_scene();
        SolidObject object = solid(static_cast<PlatonicSolid>(kind), {0.3, -0.7, 1.9}, 1.3);
        object.rotation = {17, 31, -77};
        object.edge_lights.count = 3;
        add_object(scene, object);
        const auto compiled = compile_scene<Real>(scene);
        const size_t edges[] = {6, 12, 12, 30, 30};
        ASSERT_EQ(compiled->lights.size(), 3 * edges[kind]);
        for (const auto& light : compiled->lights) {
            ASSERT_EQ(light.incident_count, 2u);
            for (uint32_t i = 0; i < 2; ++i) {
                const Incident& incident = compiled->incidents[light.first_incident + i];
                const auto& slab = compiled->slabs[incident.face / 2];
                const Real h = incident.face % 2 ? slab.high : slab.low;
                const double tolerance = 16 * double(RealTraits<Real>::unit) * double(compiled->extent);
                EXPECT_NEAR(double(dot(slab.normal, light.position)), double(h), tolerance);
            }
        }
    }
}

TYPED_TEST(CompileLights, LightsAtVerticesOnFacesAndOnTriangles) {
    SceneDescription scene = empty_scene();
    add_object(scene, solid(PlatonicSolid::octahedron));
    add_object(scene, square(1, 1));             // touches the upper vertex in the middle of its diagonal
    add_light(scene, {0, 0, 1});                 // vertex: 4 faces, and both triangles
    add_light(scene, {0.25, 0.25, 0.5});         // face center plane: 1 face
    add_light(scene, {2, 2, -3});                // on the plane of a face, far from the face
    add_light(scene, {0.5, -0.25, 1});           // inside one triangle
    add_light(scene, {1, 1, 1}, glm::dvec3{0});  // does not light
    add_light(scene, {0, 0, 0});
    const auto compiled = compile_scene<TypeParam>(scene);
    ASSERT_EQ(compiled->lights.size(), 5u);
    const uint32_t expected[] = {6, 1, 0, 1, 0};
    for (int i = 0; i < 5; ++i) EXPECT_EQ(compiled->lights[i].incident_count, expected[i]) << i;
    const Incident* first = &compiled->incidents[compiled->lights[0].first_incident];
    for (int i = 0; i < 6; ++i) EXPECT_EQ(first[i].solid, i < 4 ? 0u : 1u);
    EXPECT_EQ(first[4].face, 0u);
    EXPECT_EQ(first[5].face, 1u);
}

TYPED_TEST(CompileLights, VisibleLightsAndThoseThatOnlyLight) {
    SceneDescription scene = empty_scene();
    add_light(scene, {0, 0, 2});
    add_light(scene, {1, 0, 0}, glm::dvec3{0}).radius = 0.5;
    scene.lights.back().glow = glm::dvec3{4, 0, 0};
    add_light(scene, {-1, 0, 0}, {1, 0.5, 0}).radius = 0.5;
    const auto compiled = compile_scene<TypeParam>(scene);
    ASSERT_EQ(compiled->lights.size(), 2u);
    ASSERT_EQ(compiled->visible_lights.size(), 2u);
    const auto unit = TypeParam(std::ldexp(1.0, -compiled->radiance_exponent));
    EXPECT_EQ(compiled->visible_lights[0].radiance, Vec3<TypeParam>(4, 0, 0) * unit);
    EXPECT_EQ(compiled->visible_lights[1].radiance, Vec3<TypeParam>(1, 0.5, 0) * unit);
    EXPECT_TRUE(compiled->visible_light_tree.empty());
}

TEST(Lights, OfMoreThanAMillionThereIsALineInPlaceOfMemory) {
    SceneDescription scene = empty_scene();
    SolidObject object = solid(PlatonicSolid::dodecahedron, {0, 0, 0}, 1);
    object.edge_lights.count = 1000;
    for (int i = 0; i < 34; ++i) {
        object.center.x = 3 * i;
        add_object(scene, object);
        scene.objects.back().place = "/objects/" + std::to_string(i);
    }
    samples::expect_error([&] { gather_scene(scene); }, ExitCode::usage,
                          "/objects/33: with the lights on its edges the scene has more than 1000000 lights");
    scene.objects.pop_back();
    EXPECT_EQ(gather_scene(scene).solids.size(), 33u);
}

}  // namespace
}  // namespace cistula
