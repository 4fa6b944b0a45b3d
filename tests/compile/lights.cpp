// Lights of compiled scenes, and the faces that they lie on.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "cistula/model/effects.h"
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

TYPED_TEST(CompileLights, HiddenOnesLightTheSameAndAreNoSphere) {
    SceneDescription scene = empty_scene();
    add_object(scene, square());
    LightDescription& light = add_light(scene, {0, 0, 9}, {4, 5, 6});
    light.radius = 2;
    light.falloff = true;
    light.glow = glm::dvec3{1e6};
    const auto seen = compile_scene<TypeParam>(scene);
    scene.lights[0].visible = false;
    const auto hidden = compile_scene<TypeParam>(scene);
    EXPECT_EQ(seen->visible_lights.size(), 1u);
    EXPECT_TRUE(hidden->visible_lights.empty());
    EXPECT_TRUE(hidden->layer_names->visible_lights.empty());
    EXPECT_EQ(hidden->effects & effect_visible_lights, 0u);
    EXPECT_EQ(seen->effects & ~hidden->effects, effect_visible_lights);
    EXPECT_EQ(hidden->scale, 0);  // the square alone is in the scene
    EXPECT_LT(seen->scale, 0);
    EXPECT_LT(hidden->radiance_exponent, 4);  // no glow is in the bound
    EXPECT_NE(seen->hashes.of(0), hidden->hashes.of(0));
    // In one frame, they light alike.
    scene.frame = FrameOfReference{{0, 0, 0}, -4, 1e7};
    const auto hidden_there = compile_scene<TypeParam>(scene);
    scene.lights[0].visible = true;
    const auto seen_there = compile_scene<TypeParam>(scene);
    ASSERT_EQ(hidden_there->lights.size(), 1u);
    EXPECT_EQ(hidden_there->lights[0].position, seen_there->lights[0].position);
    EXPECT_EQ(hidden_there->lights[0].intensity, seen_there->lights[0].intensity);
    EXPECT_EQ(hidden_there->lights[0].clamp_distance, seen_there->lights[0].clamp_distance);
    EXPECT_EQ(hidden_there->lights[0].clamp_distance, TypeParam(0.125));
}

/// The radiance bound of a scene that a lamp lights by 1 at distance 1.
template <class Real>
double bound_by(SceneDescription scene, const glm::dvec3& position, double radius) {
    scene.ambient = glm::dvec3{0};
    scene.materials[0].color = glm::dvec3{1};
    LightDescription& light = add_light(scene, position);
    light.radius = radius;
    light.falloff = true;
    light.visible = false;
    const auto compiled = compile_scene<Real>(scene);
    return std::ldexp(double(compiled->bound.x), compiled->radiance_exponent);
}

TYPED_TEST(CompileLights, TinyLampsAreBoundedByTheirDistanceFromFaces) {
    SceneDescription room = empty_scene();
    add_object(room, solid(PlatonicSolid::cube, {0, 0, 0}, 4 * std::sqrt(3.0)));  // half edge 4
    const double slack = 1.001;
    EXPECT_NEAR(bound_by<TypeParam>(room, {1, 0, 0}, 1e-8), 1.0 / 9 * slack, 1e-3);
    EXPECT_NEAR(bound_by<TypeParam>(room, {0, -3.75, 1}, 1e-8), 16 * slack, 0.1);
    EXPECT_NEAR(bound_by<TypeParam>(room, {0, -3.75, 1}, 0.5), 4 * slack, 1e-2);  // by the radius, as ever
    // On a face, it lights the others; the whole of its own plane is dark.
    EXPECT_LT(bound_by<TypeParam>(room, {0, -4, 0}, 1e-8), 100);
    SceneDescription floor = empty_scene();
    add_object(floor, square(4));
    add_object(floor, square(4, 3));
    EXPECT_LT(bound_by<TypeParam>(floor, {1, 1, 0}, 1e-8), 100);
    EXPECT_NEAR(bound_by<TypeParam>(floor, {1, 1, 0.5}, 1e-8), 4 * slack, 0.2);
}

/// The bound holds at every point of a mesh, and is not more than four times what it must be.
TYPED_TEST(CompileLights, DistancesFromMeshesAreBoundsAndNearTheTruth) {
    SceneDescription scene = empty_scene();
    const TrianglesObject ring = torus(1, 0.25, 48, 24);
    add_object(scene, ring);
    std::mt19937_64 random(4);
    const auto between = [&](double low, double high) {
        return low + (high - low) * std::uniform_real_distribution<double>()(random);
    };
    int near = 0;
    for (int i = 0; i < 60; ++i) {
        const glm::dvec3 p{between(-0.7, 0.7), between(-0.7, 0.7), between(-0.2, 0.2)};
        double square = INFINITY, edge = 0;
        for (const auto& corners : ring.triangles) {
            const glm::dvec3 &a = ring.vertices[corners[0]], &b = ring.vertices[corners[1]],
                             &c = ring.vertices[corners[2]];
            edge = std::max(edge, length(b - a));
            for (const glm::dvec3& on : {a, b, c, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0, (a + b + c) / 3.0})
                square = std::min(square, dot(on - p, on - p));
        }
        const double bound = bound_by<TypeParam>(scene, p, 1e-6);
        EXPECT_GE(bound, 1 / square);
        if (std::sqrt(square) < 1.5 * edge) continue;
        ++near;
        const double least = std::sqrt(square) - edge / 2;
        EXPECT_LE(bound, 1.01 * 4 / (least * least)) << i;
    }
    EXPECT_GT(near, 10);
}

TYPED_TEST(CompileLights, WhatSumsAreTooCoarseForIsRefusedWithTheLight) {
    SceneDescription scene = empty_scene();
    add_object(scene, square(4));
    add_light(scene, {0, 0, 2});
    LightDescription lamp = scene.lights[0];
    lamp.place = "/lights/1";
    lamp.position = {0, 0, 2e-6};
    lamp.radius = 1e-9;
    lamp.falloff = true;
    lamp.glow = glm::dvec3{1};
    scene.lights.push_back(lamp);
    const auto compile = [&] { return compile_scene<double>(scene); };
    samples::expect_error(compile, ExitCode::usage, "test.json: /lights/1: its radius of 1e-09 lets /objects/0 be lit");
    samples::expect_error(compile, ExitCode::usage, "; give a radius of 1.5e-05 or more");
    scene.lights[1].radius = 1.5e-5;  // as it says
    EXPECT_NO_THROW(compile());
    scene.lights[1] = scene.lights[0];
    scene.lights[1].place = "/lights/1";
    scene.lights[1].radius = 0.5;
    scene.lights[1].glow = glm::dvec3{0, 1e20, 0};
    samples::expect_error([&] { compile_scene<TypeParam>(scene); }, ExitCode::usage,
                          "test.json: /lights/1: its glow of 1e+20 is so much brighter");
    scene.lights[1].visible = false;
    EXPECT_TRUE(compile_scene<TypeParam>(scene)->warnings.empty());
    scene.lights[1].glow = glm::dvec3{1e8};
    scene.lights[1].visible = true;
    EXPECT_NO_THROW(compile_scene<TypeParam>(scene));
}

TYPED_TEST(CompileLights, ASunThatIsAsBrightAsItsIntensityIsShownAsBrightAsSumsHold) {
    SceneDescription scene = empty_scene();
    add_object(scene, square(4));
    LightDescription& sun = add_light(scene, {0, 0, 1e4}, {1e8, 1e8, 5e7});
    sun.radius = 10;
    sun.falloff = true;
    const auto compiled = compile_scene<TypeParam>(scene);
    EXPECT_TRUE(compiled->warnings.empty());
    scene.lights[0].position.z = 1e11;
    scene.lights[0].radius = 1e8;
    scene.lights[0].color *= 1e14;
    const auto far = compile_scene<double>(scene);
    ASSERT_EQ(far->warnings.size(), 1u);
    EXPECT_EQ(far->warnings[0].find("/lights/0: it is shown with a glow of "), 0u) << far->warnings[0];
    EXPECT_LT(far->radiance_exponent, 34);
    ASSERT_EQ(far->visible_lights.size(), 1u);
    EXPECT_EQ(far->visible_lights[0].radiance.x, 2 * far->visible_lights[0].radiance.z);
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
