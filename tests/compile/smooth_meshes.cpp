// Normals of compiled meshes (docs/rules.md, 17): which corners have which, what is flat, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "cistula/model/triangle_sides.h"
#include "cistula/shading/smooth.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/materials/required_effects.h"
#include "scene/compile/scene_source.h"
#include "scene/description/without_effect.h"
#include "testing/support/scene_samples.h"
#include "verify/cases/smooth/round_mesh.h"
#include "verify/scenes/generated_scene.h"

namespace cistula {
namespace {

using glm::dvec3;
using samples::add_light;
using samples::add_object;
using samples::empty_scene;
using samples::expect_error;
using samples::solid;
using samples::square;
using verify::smooth::round_mesh;

TrianglesObject ball(int level = 1) {
    return round_mesh(level, [](const dvec3&) { return 1.0; });
}
TrianglesObject cube() {
    TrianglesObject mesh = triangulated_solid({.solid = PlatonicSolid::cube, .radius = std::sqrt(3.0)});
    mesh.keep_triangles = false;
    return mesh;
}

std::unique_ptr<CompiledScene<double>> compiled(TrianglesObject mesh) {
    SceneDescription scene = empty_scene();
    add_object(scene, std::move(mesh));
    return compile_scene<double>(scene);
}

/// Calls visit(corner, normals of its triangle or null, the corner's number) for all corners.
template <class Visit>
void for_each_corner(const CompiledScene<double>& scene, const Visit& visit) {
    const SceneView<double> view = scene.view();
    for (uint32_t c = 0; c < view.clusters.size; ++c)
        for (uint32_t lane = 0; lane < view.clusters[c].count; ++lane) {
            Vec3<double> corner[3];
            triangle_corners(view, c * cluster_lanes + lane, corner);
            const Vec3<double>* normals = corner_normals(view, c * cluster_lanes + lane);
            for (int k = 0; k < 3; ++k) visit(corner, normals, k);
        }
}

TEST(SmoothMeshes, HaveTheNormalsOfTheirVertices) {
    for (const bool turned : {false, true})
        for (const bool normals_too : {false, true}) {
            TrianglesObject mesh = ball();
            if (turned)
                for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
            for (dvec3& n : mesh.normals) n *= turned && normals_too ? -3 : 3;
            const auto scene = compiled(std::move(mesh));
            EXPECT_TRUE(scene->warnings.empty());
            size_t corners = 0;
            for_each_corner(*scene, [&](const auto& corner, const Vec3<double>* normals, int k) {
                ASSERT_NE(normals, nullptr);
                EXPECT_LT(length(normals[k] - normalized(corner[k])), 1e-9);
                ++corners;
            });
            EXPECT_EQ(corners, 240u);
            EXPECT_EQ(scene->solids[0].slab_count, 0u) << "nothing is near";
        }
}

TEST(SmoothMeshes, AreSmoothUnderAnAngle) {
    TrianglesObject mesh = cube();
    mesh.smooth = 90.5;
    size_t corners = 0;
    for_each_corner(*compiled(mesh), [&](const auto& corner, const Vec3<double>* normals, int k) {
        ASSERT_NE(normals, nullptr);
        EXPECT_LT(length(normals[k] - normalized(corner[k])), 1e-12) << "by angles, however faces are cut";
        ++corners;
    });
    EXPECT_EQ(corners, 36u);
    mesh.smooth = 89.5;
    EXPECT_TRUE(compiled(mesh)->clusters.empty()) << "flat, so given by planes";
    mesh.vertices[0] *= 1.5;
    mesh.smooth = 50;
    size_t flat = 0;
    for_each_corner(*compiled(mesh), [&](const auto&, const Vec3<double>* normals, int) { flat += !normals; });
    EXPECT_EQ(flat, 18u) << "edges of 90 degrees are none to be smooth over";
}

TEST(SmoothMeshes, TakeTheFacesOwnNormalsForThoseOfNoUse) {
    TrianglesObject mesh = ball();
    mesh.normals[0] = dvec3(0);
    mesh.normals[1] = {NAN, 0, 0};
    mesh.normals[2] *= -1;
    mesh.normals[3] *= 1e100;
    const auto scene = compiled(mesh);
    ASSERT_EQ(scene->warnings.size(), 1u);
    EXPECT_EQ(scene->warnings[0],
              "/objects/0: object 0: at 15 of 240 corners of triangles the normals are missing, zero, not finite or "
              "turned away from the face; its own are used there");
    for_each_corner(*scene, [&](const auto& corner, const Vec3<double>* normals, int k) {
        EXPECT_GE(dot(normals[k], triangle_normal(corner[1] - corner[0], corner[2] - corner[0])), 0.125);
        EXPECT_NEAR(length(normals[k]), 1, 1e-12);
    });
    for (dvec3& n : mesh.normals) n = -n;
    expect_error([&] { compiled(mesh); }, ExitCode::usage, "/objects/0: object 0: at 235 of 240 corners");
    mesh.smooth = 0;
    EXPECT_TRUE(compiled(mesh)->normals.empty());
    mesh.smooth = 60;
    EXPECT_TRUE(compiled(mesh)->warnings.empty());
    mesh.smooth = NAN;
    expect_error([&] { compiled(mesh); }, ExitCode::usage, "/objects/0: smooth: expected an angle");
    mesh.normals.pop_back();
    expect_error([&] { compiled(mesh); }, ExitCode::usage, "41 normals for 42 vertices");
}

/// A sheet of four by four bent squares, with normals that look up, wound as they look.
TrianglesObject sheet() {
    TrianglesObject mesh;
    for (int i = 0; i < 25; ++i) {
        const double x = i % 5, y = int(i / 5);
        mesh.vertices.push_back({x, y, 0.05 * (x * x - y * y)});
        mesh.normals.push_back({-0.1 * x, 0.1 * y, 1});
    }
    for (uint32_t i = 0; i < 20; ++i) {
        if (i % 5 == 4) continue;
        mesh.triangles.push_back({i, i + 1, i + 6});
        mesh.triangles.push_back({i, i + 6, i + 5});
    }
    return mesh;
}
void turn(TrianglesObject& mesh, size_t first, size_t end) {
    for (size_t t = first; t < end; ++t) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
}

TEST(SmoothMeshes, ThatAreOpenAreWoundAsTheirNormalsLook) {
    const auto right = compiled(sheet());
    EXPECT_TRUE(right->warnings.empty());
    TrianglesObject mesh = sheet();
    turn(mesh, 0, 32);
    const auto turned = compiled(mesh);
    EXPECT_EQ(turned->hashes.of(0), right->hashes.of(0));
    EXPECT_EQ(turned->warnings, std::vector<std::string>{"/objects/0: object 0: turned 32 triangles that were wound "
                                                         "against the normals of the corners"});
    mesh.normals[0] = dvec3(0);
    mesh.normals[1] = {NAN, 0, 0};
    mesh.normals[24] = {1, 0, 0.35};
    const auto some = compiled(mesh);
    ASSERT_EQ(some->warnings.size(), 2u) << "those of no use do not count";
    EXPECT_EQ(some->warnings[0], turned->warnings[0]);

    mesh = sheet();
    turn(mesh, 16, 32);
    const auto half = compiled(mesh);
    EXPECT_EQ(half->hashes.of(0), right->hashes.of(0)) << "what is wound alike is turned by itself";
    ASSERT_EQ(half->warnings.size(), 1u);
    EXPECT_NE(half->warnings[0].find("turned 16 triangles"), std::string::npos);

    mesh = sheet();
    turn(mesh, 0, 32);
    mesh.smooth = 0;
    EXPECT_TRUE(compiled(mesh)->warnings.empty()) << "normals that are not used turn nothing";
}

TEST(SmoothMeshes, ThatAreOpenAreNotTurnedWhereNormalsDisagree) {
    TrianglesObject mesh = sheet();
    for (size_t i = 0; i < 10; ++i) mesh.normals[i] = -mesh.normals[i];
    const auto mixed = compiled(mesh);
    ASSERT_EQ(mixed->warnings.size(), 1u);
    EXPECT_NE(mixed->warnings[0].find("of 96 corners"), std::string::npos);
    for (dvec3& n : mesh.normals) n = -n;
    expect_error([&] { compiled(mesh); }, ExitCode::usage, "of 96 corners of triangles the normals are missing");
}

TEST(SmoothMeshes, ThatAreOpenAreTurnedOnceDoublesAreGone) {
    TrianglesObject mesh = sheet();
    turn(mesh, 0, 32);
    const std::vector<std::array<uint32_t, 3>> once = mesh.triangles;
    for (auto t : once) {
        std::swap(t[1], t[2]);
        mesh.triangles.push_back(t);
    }
    const auto doubled = compiled(mesh);
    ASSERT_EQ(doubled->warnings.size(), 2u);
    EXPECT_NE(doubled->warnings[0].find("merged 32 faces"), std::string::npos);
    EXPECT_NE(doubled->warnings[1].find("turned 32 triangles"), std::string::npos);
    EXPECT_EQ(doubled->hashes.of(0), compiled(sheet())->hashes.of(0));
}

TEST(SmoothMeshes, OfFlatFacesAreFlat) {
    TrianglesObject mesh = cube();
    std::vector<dvec3> vertices;
    for (auto& t : mesh.triangles) {  // as modelers write them, to four digits
        const dvec3 n =
            normalized(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]));
        for (uint32_t& corner : t) {
            vertices.push_back(mesh.vertices[corner]);
            mesh.normals.push_back(n + dvec3(5e-5, -5e-5, 5e-5));
            corner = uint32_t(vertices.size() - 1);
        }
    }
    mesh.vertices = vertices;
    const auto scene = compiled(mesh);
    EXPECT_EQ(scene->convex.size(), 1u);
    EXPECT_TRUE(scene->normals.empty());
}

TEST(SmoothMeshes, AreFlatOnSharedPlanes) {
    SceneDescription scene = empty_scene();
    TrianglesObject mesh = cube();
    mesh.smooth = 100;
    add_object(scene, std::move(mesh));
    add_object(scene, square(3, -1));
    const auto compiled = compile_scene<double>(scene);
    EXPECT_FALSE(compiled->shared_planes.empty());
    size_t flat = 0;
    for_each_corner(*compiled, [&](const auto& corner, const Vec3<double>* normals, int) {
        const bool below = corner[0].z == corner[1].z && corner[0].z == corner[2].z && corner[0].z < 0;
        EXPECT_EQ(normals == nullptr, below);
        flat += below;
    });
    EXPECT_EQ(flat, 12u) << "of the cube's and of the square's triangles";
    EXPECT_EQ(compiled->solids[0].slab_count, 1u) << "the square is near";
}

TEST(SmoothMeshes, AskForTheirShadowsWhereAnythingIsNear) {
    const auto asks = [](double away) {
        SceneDescription scene = empty_scene();
        add_object(scene, ball());
        add_object(scene, square(3, -1 - away));
        return compile_scene<double>(scene)->solids[0].slab_count != 0;
    };
    EXPECT_TRUE(asks(0.01));
    EXPECT_FALSE(asks(1));
    TrianglesObject two = ball();
    const TrianglesObject one = two;
    for (const auto& t : one.triangles) two.triangles.push_back({t[0] + 42, t[1] + 42, t[2] + 42});
    for (size_t i = 0; i < 42; ++i) {
        two.vertices.push_back(one.vertices[i] + dvec3(3, 0, 0));
        two.normals.push_back(one.normals[i]);
    }
    EXPECT_EQ(compiled(two)->solids[0].slab_count, 1u) << "a part may lie near another";
}

TEST(SmoothMeshes, CallForTheirEffect) {
    SceneDescription scene = empty_scene();
    add_object(scene, ball());
    EXPECT_TRUE((required_effects(scene) & effect_smooth) != 0);
    EXPECT_EQ(least_mask(required_effects(scene)), effect_mask_count - 1);
    const auto hash = [&] { return compile_scene<float>(scene)->hashes.of(0); };
    const auto first = hash();
    auto& mesh = std::get<TrianglesObject>(scene.objects[0].shape);
    mesh.normals[5] = normalized(mesh.normals[5] + dvec3(0.1, 0, 0));
    EXPECT_NE(hash(), first);
    const SceneDescription flat = without_effect(scene, effect_smooth).value();
    EXPECT_TRUE((required_effects(flat) & effect_smooth) == 0);
    mesh.normals.clear();
    EXPECT_EQ(hash(), compile_scene<float>(flat)->hashes.of(0)) << "normals that are not used do not count";
}

/// A ball of glass with a hole, and what fills that: its corners in another order, and moved by so much at random.
SceneDescription filled_cup(const std::function<void(TrianglesObject&)>& change, double off = 0) {
    const TrianglesObject filling = ball();
    TrianglesObject cup = ball();
    for (dvec3& p : cup.vertices) p *= 1.2;
    const auto first = uint32_t(cup.vertices.size());
    for (size_t i = 0; i < filling.vertices.size(); ++i) {
        cup.vertices.push_back(filling.vertices[i] + off * std::sin(double(i)) * dvec3(1, 0.3, -0.7));
        cup.normals.push_back(-filling.normals[i]);
    }
    for (const auto& t : filling.triangles) cup.triangles.push_back({first + t[1], first + t[0], first + t[2]});
    SceneDescription scene = empty_scene();
    scene.materials.push_back(samples::material("glass", 0, 1));
    add_object(scene, cup, 1);
    TrianglesObject changed = filling;
    change(changed);
    add_object(scene, changed, 1);
    return scene;
}
size_t flat_corners(const CompiledScene<double>& scene) {
    size_t flat = 0;
    for_each_corner(scene, [&](const auto&, const Vec3<double>* normals, int) { flat += normals == nullptr; });
    return flat;
}

TEST(SmoothMeshes, KeepNormalsWhereEqualFacesTouch) {
    const auto scene = compile_scene<double>(filled_cup([](TrianglesObject&) {}));
    EXPECT_GE(scene->shared_planes.size(), 80u);
    EXPECT_EQ(flat_corners(*scene), 0u);
    EXPECT_TRUE(scene->warnings.empty());
    const auto turned = compile_scene<double>(filled_cup([](TrianglesObject& mesh) {
        std::reverse(mesh.triangles.begin(), mesh.triangles.end());
        for (auto& t : mesh.triangles) t = {t[1], t[2], t[0]};
        for (dvec3& n : mesh.normals) n = normalized(n + 0x1p-10 * dvec3(0.6, 0.8, 0));
    }));
    EXPECT_EQ(flat_corners(*turned), 0u) << "as far as normals agree";
}

TEST(SmoothMeshes, AreFlatAndSaySoWhereFacesThatTouchDiffer) {
    const auto expect_flat = [](const SceneDescription& scene, size_t corners, const std::string& warning) {
        const auto compiled = compile_scene<double>(scene);
        EXPECT_EQ(flat_corners(*compiled), corners);
        ASSERT_EQ(compiled->warnings.size(), 1u);
        EXPECT_NE(compiled->warnings[0].find(warning), std::string::npos) << compiled->warnings[0];
    };
    expect_flat(filled_cup([](TrianglesObject& mesh) {
                    for (dvec3& n : mesh.normals) n = normalized(n + 0x1p-6 * dvec3(0.6, 0.8, 0));
                }),
                480, "160 smooth triangles where bodies touch are made flat, first against /objects/1");
    expect_flat(filled_cup([](TrianglesObject& mesh) { mesh.smooth = 0, mesh.keep_triangles = true; }), 480,
                "/objects/0: object 0: 80 smooth triangles where bodies touch are made flat, first against /objects/1");
    SceneDescription decal = filled_cup([](TrianglesObject&) {});
    const TrianglesObject round = ball();
    TrianglesObject part;
    for (const uint32_t v : round.triangles[7]) part.vertices.push_back(round.vertices[v]);
    part.vertices[2] = 0.5 * (part.vertices[0] + part.vertices[2]);
    part.triangles = {{0, 1, 2}};
    add_object(decal, part);
    expect_flat(decal, 9, "2 smooth triangles where bodies touch are made flat, first against /objects/2");
}

/// What bodies with digits of their own cannot share is said, whatever else they share.
TEST(SmoothMeshes, SayWhereTheyTouchButShareNoPlane) {
    const auto scene = compile_scene<double>(filled_cup([](TrianglesObject&) {}, 1e-7));
    ASSERT_FALSE(scene->warnings.empty());
    EXPECT_NE(scene->warnings[0].find("touch but cannot be moved into one plane"), std::string::npos);
}

/// A light close to a coarse mesh, in the plane of a face, lights what stands out of it.
TEST(SmoothMeshes, CountTheirBulgesForTheBound) {
    SceneDescription scene = empty_scene();
    add_object(scene, ball(0));
    auto& light = add_light(scene, {0, 0, 1.05});
    light.falloff = true;
    light.radius = 0.01;
    const double bulging = double(compile_scene<double>(scene)->bound.x) *
                           std::ldexp(1.0, compile_scene<double>(scene)->radiance_exponent);
    std::get<TrianglesObject>(scene.objects[0].shape).smooth = 0;
    const double flat = double(compile_scene<double>(scene)->bound.x) *
                        std::ldexp(1.0, compile_scene<double>(scene)->radiance_exponent);
    EXPECT_GT(bulging, 1.1 * flat);
}

}  // namespace
}  // namespace cistula
