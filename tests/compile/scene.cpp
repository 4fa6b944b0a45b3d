#include "scene/compile/compiled_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "base/error.h"
#include "cistula/model/scene_access.h"
#include "cistula/numerics/transmittance.h"
#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

using samples::add_light;
using samples::add_object;
using samples::empty_scene;
using samples::expect_error;
using samples::solid;
using samples::square;

template <class Real>
class CompileScene : public ::testing::Test {};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(CompileScene, Precisions);

/// Solids, a floor, a closed mesh, lights of every kind.
SceneDescription varied_scene() {
    SceneDescription scene = empty_scene();
    scene.materials.push_back(samples::material("glass", 0.1, 0.6));
    scene.materials[1].tint = {0.5, 1, 0};
    scene.materials[1].absorption = {0.25, 0, 0.125};
    scene.materials[1].index = 1.5;
    scene.materials[1].specular = 0.5;
    scene.materials.push_back(samples::material("floor", 0.2));
    TextureDescription checker;
    checker.checker = {glm::dvec3{0.8}, glm::dvec3{0.3}};
    scene.textures.push_back(checker);
    scene.materials[2].texture = 0;
    SolidObject icosahedron = solid(PlatonicSolid::icosahedron, {1, 2, 3}, 0.75);
    icosahedron.rotation = {10, 20, 30};
    icosahedron.edge_lights.count = 2;
    icosahedron.edge_lights.radius = 0.0625;
    add_object(scene, icosahedron, 1);
    add_object(scene, square(4, -1), 2);
    add_object(scene, torus(1, 0.25, 24, 12), 1);
    add_object(scene, solid(PlatonicSolid::tetrahedron, {-2, 0, 1}), 0);
    add_light(scene, {0, 0, 8});
    LightDescription& bulb = add_light(scene, {3, 3, 3}, {2, 1, 0.5});
    bulb.radius = 0.25;
    bulb.falloff = true;
    add_light(scene, {-3, 1, 2}, glm::dvec3{0}).radius = 0.125;
    scene.lights.back().glow = glm::dvec3{3, 2, 1};
    return scene;
}

/// The scene with all lengths multiplied by 2^k.
SceneDescription scaled_scene(SceneDescription scene, int k) {
    const double s = std::ldexp(1.0, k);
    for (auto& object : scene.objects) {
        if (auto* platonic = std::get_if<SolidObject>(&object.shape)) {
            platonic->center *= s;
            platonic->radius *= s;
            platonic->edge_lights.radius *= s;
        } else if (auto* triangles = std::get_if<TrianglesObject>(&object.shape)) {
            for (auto& vertex : triangles->vertices) vertex *= s;
        }
    }
    for (auto& light : scene.lights) {
        light.position *= s;
        light.radius *= s;
        if (light.falloff) light.color *= s * s;
    }
    for (auto& material : scene.materials) material.absorption /= s;
    return scene;
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// Slabs have room behind their five numbers that means nothing.
template <class Real>
bool same_slabs(const std::vector<Slab<Real>>& a, const std::vector<Slab<Real>>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Slab<Real>& x, const Slab<Real>& y) {
        return std::memcmp(&x.normal, &y.normal, sizeof x.normal) == 0 &&
               std::memcmp(&x.low, &y.low, sizeof x.low) == 0 && std::memcmp(&x.high, &y.high, sizeof x.high) == 0;
    });
}

TYPED_TEST(CompileScene, ScenesScaledByAPowerOfTwoCompileToTheSameBits) {
    using Real = TypeParam;
    const auto reference = compile_scene<Real>(varied_scene());
    for (const int k : {-40, -7, 3, 40}) {
        // A point light's own radiance follows its intensity unless given.
        SceneDescription description = varied_scene();
        description.lights[1].glow = description.lights[1].color;
        const auto scaled = compile_scene<Real>(scaled_scene(description, k));
        EXPECT_EQ(scaled->scale, reference->scale - k);
        EXPECT_EQ(scaled->radiance_exponent, reference->radiance_exponent);
        EXPECT_TRUE(same_slabs(scaled->slabs, reference->slabs));
        EXPECT_TRUE(same_bits(scaled->clusters, reference->clusters));
        EXPECT_TRUE(same_bits(scaled->lights, reference->lights));
        EXPECT_TRUE(same_bits(scaled->visible_lights, reference->visible_lights));
        EXPECT_TRUE(same_bits(scaled->incidents, reference->incidents));
        EXPECT_EQ(scaled->bound, reference->bound);
        EXPECT_EQ(scaled->extent, reference->extent);
        for (size_t i = 0; i < reference->materials.size(); ++i)
            EXPECT_EQ(scaled->materials[i].absorption, reference->materials[i].absorption);
    }
}

TYPED_TEST(CompileScene, TheFrameHoldsEverythingUnderTwo) {
    using Real = TypeParam;
    const auto scene = compile_scene<Real>(varied_scene());
    EXPECT_GE(scene->extent, Real(1));
    EXPECT_LT(scene->extent, Real(2));
    double largest = 0;
    for (const auto& cluster : scene->clusters)
        for (const auto& corner : cluster.corner)
            for (const auto& axis : corner)
                for (const Real x : axis) largest = std::max(largest, std::abs(double(x)));
    EXPECT_LE(largest, double(scene->extent));
    EXPECT_GT(largest, 0.5);
}

TYPED_TEST(CompileScene, AnExtentJustUnderTwoStaysUnderTwoInThatPrecision) {
    SceneDescription scene = empty_scene();
    add_object(scene, square(1 - 0x1p-50));
    EXPECT_LT(compile_scene<TypeParam>(scene)->extent, TypeParam(2));
}

TYPED_TEST(CompileScene, APinnedFrameIsTaken) {
    SceneDescription scene = empty_scene();
    add_object(scene, square(4));
    scene.frame = FrameOfReference{{1, 0, 0}, -2, {}};
    const auto compiled = compile_scene<TypeParam>(scene);
    EXPECT_EQ(compiled->scale, -2);
    EXPECT_EQ(compiled->center, glm::dvec3(1, 0, 0));
    EXPECT_EQ(compiled->extent, TypeParam(1.25));
    scene.frame->scale = -1;
    expect_error([&] { compile_scene<TypeParam>(scene); }, ExitCode::usage, "largest coordinate");
}

TYPED_TEST(CompileScene, AnEmptySceneIsItsBackground) {
    SceneDescription scene = empty_scene();
    scene.background = {0.25, 3, 1};
    const auto compiled = compile_scene<TypeParam>(scene);
    EXPECT_TRUE(compiled->solids.empty());
    EXPECT_EQ(compiled->radiance_exponent, 2);
    EXPECT_EQ(compiled->background, Vec3<TypeParam>(0.0625, 0.75, 0.25));
    EXPECT_EQ(compiled->effects, 0u);
    SceneDescription black = empty_scene();
    black.ambient = glm::dvec3{0};
    EXPECT_EQ(compile_scene<TypeParam>(black)->radiance_exponent, 0);
    EXPECT_EQ(compile_scene<TypeParam>(black)->bound, Vec3<TypeParam>(0));
}

TYPED_TEST(CompileScene, TouchingSolidsShareTheirPlanesExactly) {
    using Real = TypeParam;
    SceneDescription scene = empty_scene();
    const double side = 2 / std::sqrt(3.0);
    // Cubes in a row, one of them turned by a right angle, one by an odd angle and back.
    for (int i = 0; i < 4; ++i) {
        SolidObject cube = solid(PlatonicSolid::cube, {i * side + 0.1, 0.3, 0.7});
        if (i == 1) cube.rotation = {90, 180, -90};
        if (i == 2) cube.rotation = {0, 0, 450};
        add_object(scene, cube);
    }
    const auto compiled = compile_scene<Real>(scene);
    for (int i = 0; i + 1 < 4; ++i) {
        int shared = 0;
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) {
                const auto &s = compiled->slabs[3 * i + a], &t = compiled->slabs[3 * (i + 1) + b];
                shared += (s.normal == t.normal && s.high == t.low) || (s.normal == -t.normal && s.high == -t.high) ||
                          (s.normal == -t.normal && s.low == -t.low) || (s.normal == t.normal && s.low == t.high);
            }
        EXPECT_EQ(shared, 1) << "between cubes " << i << " and " << i + 1;
    }
}

TYPED_TEST(CompileScene, ATetrahedronStandsOnACubeWithOnePlaneRecord) {
    SceneDescription scene = empty_scene();
    add_object(scene, solid(PlatonicSolid::octahedron));
    // The face across (1, 1, 1) / sqrt 3 of the octahedron is that across the negative of the tetrahedron's.
    const double d = (1 / std::sqrt(3.0) + 1.0 / 3) / std::sqrt(3.0);
    SolidObject tetrahedron = solid(PlatonicSolid::tetrahedron, glm::dvec3{d});
    add_object(scene, tetrahedron);
    const auto compiled = compile_scene<TypeParam>(scene);
    int shared = 0;
    for (int a = 0; a < 4; ++a) {
        for (int b = 4; b < 8; ++b) {
            const auto &s = compiled->slabs[a], &t = compiled->slabs[b];
            EXPECT_EQ(t.low, -RealTraits<TypeParam>::infinity);
            shared += (s.normal == -t.normal && s.high == -t.high) || (s.normal == t.normal && s.low == t.high);
        }
    }
    EXPECT_EQ(shared, 1);
}

TYPED_TEST(CompileScene, TheBoundByHand) {
    SceneDescription scene = empty_scene();
    scene.ambient = {0.5, 0.25, 0};
    auto& m = scene.materials[0];
    m.color = {1, 0.5, 2};
    m.ambient = 0.5;
    m.diffuse = 0.75;
    m.specular = 0.25;
    m.specular_color = {1, 1, 0};
    scene.materials.push_back(samples::material("mirror", 1));
    scene.materials.back().color = glm::dvec3{1000};
    scene.materials.push_back(samples::material("unused"));
    scene.materials.back().color = glm::dvec3{1000};
    add_object(scene, square());
    add_object(scene, square(1, 1), 1);
    add_light(scene, {0, 0, 3}, {2, 2, 2});
    add_light(scene, {0, 0, 3}, {1, 0, 2});
    // C (ka A + kd sum I) + ks S sum I
    const double r = 1 * (0.25 + 0.75 * 3) + 0.25 * 3, g = 0.5 * (0.125 + 0.75 * 2) + 0.25 * 2, b = 2 * (0.75 * 4);
    const auto compiled = compile_scene<TypeParam>(scene);
    EXPECT_EQ(compiled->radiance_exponent, 3);  // 6 (1 + 2^-10) in (4, 8]
    const double slack = (1 + 0x1p-10) / 8;
    EXPECT_DOUBLE_EQ(double(compiled->bound.x), double(TypeParam(r * slack)));
    EXPECT_DOUBLE_EQ(double(compiled->bound.y), double(TypeParam(g * slack)));
    EXPECT_DOUBLE_EQ(double(compiled->bound.z), double(TypeParam(b * slack)));
    EXPECT_EQ(compiled->lights[0].intensity, Vec3<TypeParam>(0.25));
    EXPECT_EQ(compiled->materials[0].ambient, Vec3<TypeParam>(0.03125, 0.015625, 0));
    EXPECT_EQ(compiled->materials[0].color, Vec3<TypeParam>(1, 0.5, 2));
}

TYPED_TEST(CompileScene, FalloffIsBoundedByDistanceAndRadius) {
    SceneDescription scene = empty_scene();
    scene.ambient = glm::dvec3{0};
    scene.materials[0].color = glm::dvec3{1};
    add_object(scene, square());
    LightDescription& light = add_light(scene, {0, 0, 4}, glm::dvec3{32});
    light.radius = 0.5;
    light.falloff = true;
    light.glow = glm::dvec3{0};
    double bound = std::ldexp(double(compile_scene<TypeParam>(scene)->bound.x),
                              compile_scene<TypeParam>(scene)->radiance_exponent);
    EXPECT_NEAR(bound, 2 * (1 + 0x1p-10), 1e-4);
    scene.lights[0].position.z = 0.25;  // nearer than its radius
    bound = std::ldexp(double(compile_scene<TypeParam>(scene)->bound.x),
                       compile_scene<TypeParam>(scene)->radiance_exponent);
    EXPECT_NEAR(bound, 32 / 0.25 * (1 + 0x1p-10), 1e-3);
}

TYPED_TEST(CompileScene, APinnedBoundIsTakenUnlessTooSmall) {
    SceneDescription scene = empty_scene();
    scene.background = glm::dvec3{1};
    scene.frame = FrameOfReference{{0, 0, 0}, 0, 16.0};
    const auto compiled = compile_scene<TypeParam>(scene);
    EXPECT_EQ(compiled->radiance_exponent, 5);
    EXPECT_EQ(compiled->bound, Vec3<TypeParam>(TypeParam(0.5 * (1 + 0x1p-10))));
    scene.frame->bound = 0.5;
    expect_error([&] { compile_scene<TypeParam>(scene); }, ExitCode::usage, "/frame/bound");
}

TEST(CompileScenePrecision, BoundsBeyondFloatAreRefusedThere) {
    SceneDescription scene = empty_scene();
    scene.background = glm::dvec3{0x1p101};
    expect_error([&] { compile_scene<float>(scene); }, ExitCode::usage, "radiance bound");
    EXPECT_EQ(compile_scene<double>(scene)->radiance_exponent, 102);
}

/// A material is opaque if no ray passes its faces, as compiled; it then absorbs nothing.
TYPED_TEST(CompileScene, OpaqueMaterialsLetNoRayPass) {
    const struct {
        double reflection, transmission;
        glm::dvec3 tint;
        bool fresnel, opaque;
    } all[] = {{0, 0, {1, 1, 1}, false, true},    {0.5, 0, {1, 1, 1}, false, true},
               {0, 0.5, {0, 0, 0}, false, true},  {0, 0.5, {0, 1e-3, 0}, false, false},
               {0, 0, {1, 1, 1}, true, true},     {0.5, 0, {1, 1, 1}, true, false},
               {0.5, 0.5, {0, 0, 0}, true, true}, {0, 1e-30, {1e-30, 0, 0}, false, sizeof(TypeParam) == 4}};
    for (const auto& one : all) {
        SceneDescription scene = empty_scene();
        MaterialDescription& m = scene.materials[0];
        m.reflection = one.reflection;
        m.transmission = one.transmission;
        m.tint = one.tint;
        m.fresnel = one.fresnel;
        m.absorption = {1, 1, 1};
        add_object(scene, solid(PlatonicSolid::cube));
        const auto compiled = compile_scene<TypeParam>(scene);
        EXPECT_EQ(compiled->materials[0].transparency == Transparency::opaque, one.opaque);
        EXPECT_EQ(compiled->materials[0].absorption.x == 0, one.opaque);
    }
}

TYPED_TEST(CompileScene, GlassThatSplitsAllLightIsWhole) {
    const struct {
        double reflection, transmission, tint;
        bool fresnel;
        Transparency expected;
    } all[] = {{0.1, 0.9, 1, true, Transparency::whole},       {0.3, 0.7, 1, true, Transparency::whole},
               {1, 0, 1, true, Transparency::whole},           {0.3, 0.7000005, 1, true, Transparency::whole},
               {0.1, 0.9, 0.999, true, Transparency::partial}, {0.1, 0.89, 1, true, Transparency::partial},
               {0.1, 0.9, 1, false, Transparency::partial},    {0, 1, 1, true, Transparency::clear}};
    for (const auto& one : all) {
        SceneDescription scene = empty_scene();
        scene.materials[0] = samples::material("glass", one.reflection, one.transmission);
        scene.materials[0].tint = glm::dvec3(one.tint);
        scene.materials[0].fresnel = one.fresnel;
        add_object(scene, solid(PlatonicSolid::cube));
        add_object(scene, square(1, 3));
        const auto compiled = compile_scene<TypeParam>(scene);
        const SceneView<TypeParam> view = compiled->view();
        EXPECT_EQ(compiled->materials[0].transparency, one.expected);
        EXPECT_EQ(is_clear(view, 0), one.expected >= Transparency::whole);
        EXPECT_EQ(is_clear(view, 1), one.expected == Transparency::clear) << "sheets take no Fresnel's terms";
    }
}

TYPED_TEST(CompileScene, MaterialsByHand) {
    using Real = TypeParam;
    SceneDescription scene = empty_scene();
    auto& m = scene.materials[0];
    m.reflection = 0.1;
    m.transmission = 0.6;
    m.tint = {0.5, 0, 1};
    m.absorption = {1, 0, 2};
    m.exponent = 50;
    m.specular = 0.5;
    m.specular_color = {1, 0.5, 0};
    scene.materials.push_back(samples::material("clear", 0, 1));
    scene.materials.push_back(samples::material("full", 0.9, 0.1));
    scene.materials[2].exponent = 2.5;
    scene.materials[2].specular = 0.1;
    add_object(scene, solid(PlatonicSolid::cube, glm::dvec3{0}, 8));
    add_object(scene, solid(PlatonicSolid::cube, glm::dvec3{0}, 4), 1);
    add_object(scene, solid(PlatonicSolid::cube, glm::dvec3{0}, 2), 2);
    const auto compiled = compile_scene<Real>(scene);
    const auto& glass = compiled->materials[0];
    EXPECT_LE(__float128(glass.local) + glass.reflection + glass.transmission, __float128(1));
    EXPECT_NEAR(double(glass.local), 0.3, 1e-7);
    EXPECT_EQ(glass.filter, Vec3<Real>(Real(0.6 * 0.5), 0, Real(0.6)));
    EXPECT_EQ(glass.opaque, 2u);
    EXPECT_EQ(glass.filter_loss[0], loss_of(0.3));
    EXPECT_EQ(glass.filter_loss[1], 0u);
    EXPECT_EQ(glass.integer_exponent, 50);
    EXPECT_EQ(glass.specular, Vec3<Real>(0.5, 0.25, 0));
    EXPECT_EQ(glass.transparency, Transparency::partial);
    EXPECT_EQ(glass.absorption, Vec3<Real>(1, 0, 2) * Real(std::ldexp(1.0, -compiled->scale)));
    EXPECT_EQ(compiled->materials[1].transparency, Transparency::clear);
    EXPECT_EQ(compiled->materials[1].filter_loss[2], 0u);
    EXPECT_EQ(compiled->materials[2].local, Real(0));
    EXPECT_EQ(compiled->materials[1].integer_exponent, 0) << "there is no highlight";
    EXPECT_EQ(compiled->materials[2].integer_exponent, -1);
    EXPECT_EQ(compiled->materials[2].exponent, Real(2.5));
}

TYPED_TEST(CompileScene, TexturesByHand) {
    SceneDescription scene = empty_scene();
    scene.textures.resize(2);
    scene.textures[1].checker = {glm::dvec3{0.75}, glm::dvec3{0.25, 0.5, 0}};
    scene.textures[1].repeat = {8, 4};
    scene.materials[0].texture = 1;
    add_object(scene, square());
    const auto compiled = compile_scene<TypeParam>(scene);
    ASSERT_EQ(compiled->textures.size(), 1u);  // the other is not used
    EXPECT_EQ(compiled->materials[0].texture, 0);
    const Texture& texture = compiled->textures[0];
    EXPECT_EQ(texture.width, 2u);
    EXPECT_EQ(texture.filter, TextureFilter::nearest);
    EXPECT_EQ(texture.repeat[0], 8);
    EXPECT_EQ(compiled->texels[0], glm::vec3(0.75f));
    EXPECT_EQ(compiled->texels[1], glm::vec3(0.25f, 0.5f, 0));
    EXPECT_EQ(compiled->texels[3], glm::vec3(0.75f));
    ASSERT_EQ(compiled->uvs.size(), 6u);
    EXPECT_EQ(compiled->uvs[5], Vec2<TypeParam>(0, 1));
}

/// Objects in one place have as many pairs of faces as the square of their number.
TYPED_TEST(CompileScene, ManyObjectsMayBeInOnePlace) {
    SceneDescription scene = empty_scene();
    for (int i = 0; i < 200; ++i) add_object(scene, square());
    EXPECT_NO_THROW(compile_scene<TypeParam>(scene));
}

// Contacts are found in double, whatever the precision.
TEST(CompileScenes, TooManyObjectsInOnePlaceAreRefused) {
    SceneDescription scene = empty_scene();
    for (int i = 0; i < 6000; ++i) add_object(scene, square());
    expect_error([&] { compile_scene<float>(scene); }, ExitCode::usage,
                 ": more than 16 million pairs of faces touch or nearly touch");
}

/// Absorption is refused by the size of the solids of the material, whatever else the scene has.
TYPED_TEST(CompileScene, AbsorptionIsMeasuredByItsSolids) {
    SceneDescription scene = empty_scene();
    add_object(scene, square(1e9));
    scene.materials.push_back(samples::material("unused"));
    scene.materials[1].absorption.x = 1e30;
    scene.materials.push_back(samples::material("amber", 0, 1));
    scene.materials[2].absorption = {0.1, 0.5, 1};
    add_object(scene, solid(PlatonicSolid::cube), 2);
    EXPECT_NO_THROW(compile_scene<TypeParam>(scene));
    scene.materials[2].absorption.z = 1e7;
    expect_error([&] { compile_scene<TypeParam>(scene); }, ExitCode::usage,
                 "material amber has an absorption above 2^20");
}

/// Hundreds of bodies of every kind in contact, some given with few digits, and a mesh of many groups.
SceneDescription crowded_scene() {
    SceneDescription scene = varied_scene();
    for (int i = 0; i < 600; ++i) {
        const glm::dvec3 place{10 + 0.1 * (i % 10), 0.1 * (i / 10 % 10), 0.1 * (i / 100)};
        SolidObject cube = solid(PlatonicSolid::cube, place, 0.05 * std::sqrt(3.0));
        cube.radius += i % 7 == 0 ? 1e-7 : 0;
        if (i % 3 == 0) {
            add_object(scene, cube, 1);
            continue;
        }
        TrianglesObject mesh = triangulated_solid(cube);
        if (i % 3 == 1)
            mesh.keep_triangles = true;
        else
            mesh.triangles.pop_back();
        add_object(scene, mesh, 1);
    }
    add_object(scene, bumpy_sphere(20'000, 0.9), 1);
    return scene;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

TYPED_TEST(CompileScene, ThreadsChangeNothing) {
    const SceneDescription description = crowded_scene();
    const auto compiled_on = [&](int threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, size_t(threads));
        return tbb::task_arena(threads).execute([&] { return compile_scene<TypeParam>(description); });
    };
    const auto expected = compiled_on(1);
    EXPECT_GT(expected->shared_planes.size(), 20u);
    EXPECT_GT(expected->clusters.size(), 2000u);
    EXPECT_FALSE(expected->warnings.empty());
    for (const int threads : {2, 5}) {
        const auto scene = compiled_on(threads);
        EXPECT_EQ(scene->hashes.of(0), expected->hashes.of(0));
        EXPECT_EQ(scene->warnings, expected->warnings);
        EXPECT_TRUE(same_bytes(scene->solids, expected->solids));
        EXPECT_TRUE(std::equal(
            scene->slabs.begin(), scene->slabs.end(), expected->slabs.begin(), expected->slabs.end(),
            [](const auto& a, const auto& b) { return a.normal == b.normal && a.low == b.low && a.high == b.high; }));
        EXPECT_TRUE(same_bytes(scene->slab_planes, expected->slab_planes));
        EXPECT_TRUE(same_bytes(scene->triangle_planes, expected->triangle_planes));
        EXPECT_TRUE(same_bytes(scene->near_planes, expected->near_planes));
        EXPECT_TRUE(same_bytes(scene->plane_solids, expected->plane_solids));
        EXPECT_TRUE(same_bytes(scene->incidents, expected->incidents));
        ASSERT_EQ(scene->shared_planes.size(), expected->shared_planes.size());
        for (size_t i = 0; i < scene->shared_planes.size(); ++i) {
            const auto &plane = scene->shared_planes[i], &other = expected->shared_planes[i];
            EXPECT_TRUE(plane.normal == other.normal && plane.offset == other.offset && plane.slack == other.slack);
        }
        ASSERT_EQ(scene->clusters.size(), expected->clusters.size());
        for (size_t i = 0; i < scene->clusters.size(); ++i) {
            const auto &cluster = scene->clusters[i], &other = expected->clusters[i];
            EXPECT_EQ(std::memcmp(cluster.corner, other.corner, sizeof cluster.corner), 0);
            EXPECT_EQ(std::memcmp(cluster.height, other.height, sizeof cluster.height), 0);
            EXPECT_EQ(std::memcmp(cluster.triangle, other.triangle, sizeof cluster.triangle), 0);
        }
    }
}

TYPED_TEST(CompileScene, WrongScenesNameThePlace) {
    const auto refused = [](const auto& change, const std::string& text) {
        SceneDescription scene = empty_scene();
        scene.textures.resize(1);
        add_object(scene, solid(PlatonicSolid::cube));
        add_object(scene, square());
        add_light(scene, {0, 0, 2});
        change(scene);
        expect_error([&] { compile_scene<TypeParam>(scene); }, ExitCode::usage, text);
    };
    refused([](auto& s) { s.materials[0].texture = 0; }, "test.json: /objects/0: the material plain has a texture");
    refused(
        [](auto& s) {
            s.materials.push_back(samples::material("floor"));
            s.materials[1].texture = 0;
            s.objects[1].material = 1;
            std::get<TrianglesObject>(s.objects[1].shape).uvs.clear();
        },
        "test.json: /objects/1: the material floor has a texture, but the triangles have no texture coordinates");
    refused([](auto& s) { s.materials[0].reflection = 0.7, s.materials[0].transmission = 0.4; },
            "plain: reflection + transmission is 1.1; expected");
    refused([](auto& s) { s.lights[0].falloff = true; }, "/lights/0");
    refused([](auto& s) { s.lights[0].color.y = -1; }, "/lights/0");
    refused([](auto& s) { std::get<TrianglesObject>(s.objects[1].shape).triangles[0][0] = 9; }, "vertex 9");
    refused([](auto& s) { std::get<TrianglesObject>(s.objects[1].shape).uvs.pop_back(); }, "3 uvs for 4 vertices");
    refused([](auto& s) { std::get<TrianglesObject>(s.objects[1].shape).triangles.clear(); }, "no triangles");
    refused([](auto& s) { std::get<SolidObject>(s.objects[0].shape).radius = 0; },
            "/objects/0: radius: expected a number from 1e-30 to 1e30");
    refused([](auto& s) { s.materials[0].transmission = 1, s.materials[0].absorption.x = 1e9; }, "absorption above");
    refused([](auto& s) { s.objects[0].material = -1; }, "/objects/0: has no material");
    refused([](auto& s) { s.materials[0].tint.x = 1.5; },
            "/materials/0: material plain: tint: expected a color: a number or [red, green, blue], each from 0 to 1");
}

TEST(SceneHash, IsThatOfTheContentInBothPrecisions) {
    const SceneDescription scene = varied_scene();
    const std::string hash = compile_scene<float>(scene)->hashes.of(0);
    EXPECT_EQ(hash.size(), 32u);
    EXPECT_EQ(compile_scene<double>(scene)->hashes.of(0), hash);
    EXPECT_EQ(compile_scene<float>(scene)->hashes.of(0), hash);
    std::set<std::string> hashes = {hash};
    const auto differs = [&](const auto& change) {
        SceneDescription other = scene;
        change(other);
        return hashes.insert(compile_scene<float>(other)->hashes.of(0)).second;
    };
    EXPECT_TRUE(differs([](auto& s) { s.materials[1].index = 1.25; }));
    EXPECT_TRUE(differs([](auto& s) { s.materials[1].tint.x = 0.25; }));
    EXPECT_TRUE(differs([](auto& s) { s.ambient.x += 0.001; }));
    EXPECT_TRUE(differs([](auto& s) { s.background.x += 0.001; }));
    EXPECT_TRUE(differs([](auto& s) { s.lights[0].position.x += 1e-9; }));
    EXPECT_TRUE(differs([](auto& s) { s.textures[0].checker[0].x = 0.7; }));
    EXPECT_TRUE(differs([](auto& s) { std::get<TrianglesObject>(s.objects[2].shape).vertices[5].x += 1e-9; }));
    EXPECT_TRUE(differs([](auto& s) { std::swap(s.objects[0], s.objects[3]); }));
    EXPECT_TRUE(differs([](auto& s) { std::get<SolidObject>(s.objects[0].shape).rotation.z = 31; }));
    EXPECT_FALSE(differs([](auto& s) { s.camera.position.x = 4; }));
    EXPECT_FALSE(differs([](auto& s) { s.depth = 9, s.cutoff = 1, s.film.width = 17; }));
    EXPECT_FALSE(differs([](auto& s) { s.materials[1].name = "other"; }));
}

}  // namespace
}  // namespace cistula
