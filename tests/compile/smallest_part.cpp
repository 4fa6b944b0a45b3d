// What is smallest in a scene, and which object it is (docs/rules.md, 12).
#include "scene/compile/solids/smallest_part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "scene/description/platonic.h"
#include "scene/description/rotation.h"
#include "testing/support/expect_error.h"
#include "testing/support/scene_samples.h"
#include "verify/scenes/generated_scene.h"

namespace cistula {
namespace {

using samples::add_light;
using samples::add_object;
using samples::empty_scene;
using samples::material;
using samples::solid;
using samples::square;

/// A floor of half size 1024, so that M is 1024 in scene units as long as the rest is small.
constexpr double half_size = 1024;
SceneDescription floor_scene() {
    SceneDescription scene = empty_scene();
    scene.materials.push_back(material("mirror", 0.5));
    scene.materials.push_back(material("glass", 0, 0.5));
    add_object(scene, square(half_size));
    return scene;
}

SolidObject cube(const glm::dvec3& center, double half) {
    return solid(PlatonicSolid::cube, center, half * std::numbers::sqrt3);
}

void expect_part(const SceneDescription& scene, double size, const std::string& what) {
    const SmallestPart part = smallest_part(scene);
    EXPECT_NEAR(part.share * half_size, size, 1e-9 * size + 1e-12) << part.what;
    EXPECT_EQ(part.what, what);
}

TEST(SmallestPart, ThresholdsAreMultiplesOfARoundingError) {
    EXPECT_EQ(least_share(Precision::single_), 0x1p11 * 0x1p-24);
    EXPECT_EQ(least_share(Precision::double_), 0x1p11 * 0x1p-53);
}

TEST(SmallestPart, AnEmptySceneHasNone) {
    EXPECT_EQ(smallest_part(empty_scene()).share, INFINITY);
}

TEST(SmallestPart, ASolidHasItsInradius) {
    for (const PlatonicSolid kind : {PlatonicSolid::tetrahedron, PlatonicSolid::cube, PlatonicSolid::dodecahedron}) {
        SceneDescription scene = floor_scene();
        add_object(scene, solid(kind, {0, 0, 4}, 0.75));
        expect_part(scene, 0.75 * platonic_shape(kind).inradius, "/objects/1: object 1: its inradius");
    }
}

TEST(SmallestPart, ASolidThatIsAPointInDoubleIsRefused) {
    for (const double distance : {1e14, 1e16, 1e30}) {
        SceneDescription scene = floor_scene();
        add_object(scene, cube({0, 0, 4}, 1));
        add_object(scene, cube({0, 0, distance}, distance / 4));
        if (distance < 1e15)
            EXPECT_LT(smallest_part(scene).share, least_share(Precision::double_));
        else
            EXPECT_ERROR(
                smallest_part(scene), ExitCode::usage,
                "test.json: /objects/1: so small beside the scene that double precision makes a point of it; give it a "
                "larger radius, or bring what is far away nearer");
    }
}

TEST(SmallestPart, TheSizeOfABodyOfPlanesIsThatOfItsCorners) {
    SolidObject large;
    large.body = std::make_shared<const Polyhedron>(box_body(glm::dvec3(1e17)));  // at a scale of 1
    SceneDescription scene = empty_scene();
    add_object(scene, large);
    EXPECT_GT(smallest_part(scene).share, 0.1);
}

TEST(SmallestPart, TheCameraDoesNotMatter) {
    SceneDescription scene = floor_scene();
    add_object(scene, cube({0, 0, 4}, 1));
    const double share = smallest_part(scene).share;
    scene.camera.position = {1e12, 0, 1e-9};
    EXPECT_EQ(smallest_part(scene).share, share);
}

TEST(SmallestPart, UnitsAndPlaceDoNotMatter) {
    SceneDescription scene = floor_scene();
    add_object(scene, cube({0, 0, 4}, 1));
    const double share = smallest_part(scene).share;
    for (const double scale : {0x1p-300, 0x1p300}) {
        SceneDescription scaled = empty_scene();
        add_object(scaled, square(half_size * scale));
        add_object(scaled, cube({0, 0, 4 * scale}, scale));
        EXPECT_NEAR(smallest_part(scaled).share, share, 1e-12 * share);
    }
    for (ObjectDescription& object : scene.objects) {
        if (auto* one = std::get_if<SolidObject>(&object.shape)) one->center += glm::dvec3(0x1p24, 0, 0);
        if (auto* one = std::get_if<TrianglesObject>(&object.shape))
            for (glm::dvec3& p : one->vertices) p += glm::dvec3(0x1p24, 0, 0);
    }
    EXPECT_NEAR(smallest_part(scene).share, share, 1e-6 * share);
}

TEST(SmallestPart, AClosedMeshHasItsVolumeOverItsArea) {
    SceneDescription scene = floor_scene();
    TrianglesObject box = triangulated_solid(cube({0, 0, 4}, 0.5));
    add_object(scene, box);
    expect_part(scene, 1.0 / 6, "/objects/1: object 1: its thickness");
    for (auto& t : box.triangles) std::swap(t[0], t[1]);  // wound the other way
    scene.objects[1].shape = box;
    expect_part(scene, 1.0 / 6, "/objects/1: object 1: its thickness");
    const Rotation turned({31, 47, 11});
    for (glm::dvec3& p : box.vertices) p = turned(glm::dvec3(p.x, p.y, p.z * 1e-3)) + glm::dvec3(0, 0, 10);
    scene.objects[1].shape = box;  // a plate: 1e-3 thick
    expect_part(scene, 1e-3 / (2 + 4e-3), "/objects/1: object 1: its thickness");
}

/// A box of glass with a vertex more on an edge, near its end, so that two of its triangles are thin.
TEST(SmallestPart, TrianglesOfAMeshThatIsGivenByPlanesDoNotCount) {
    SceneDescription scene = floor_scene();
    TrianglesObject box = triangulated_solid(cube({0, 0, 4}, 0.5));
    const auto [a, b, c] = box.triangles[0];
    for (size_t i = 1; i < 12; ++i)
        for (size_t k = 0; k < 3; ++k) {
            const std::array<uint32_t, 3> t = box.triangles[i];
            if (t[k] != b || t[(k + 1) % 3] != a) continue;  // not the triangle across the edge
            box.triangles[i] = {b, 8, t[(k + 2) % 3]};
            box.triangles.push_back({8, a, t[(k + 2) % 3]});
        }
    box.triangles[0] = {8, b, c};
    box.triangles.push_back({a, 8, c});
    ASSERT_EQ(box.triangles.size(), 14u);
    box.vertices.push_back(box.vertices[a] + (box.vertices[b] - box.vertices[a]) * 1e-3);
    add_object(scene, box, 2);
    EXPECT_EQ(smallest_part(scene).what, "/objects/1: object 1: the least height of its triangles");
    std::get<TrianglesObject>(scene.objects[1].shape).keep_triangles = false;
    expect_part(scene, 1.0 / 6, "/objects/1: object 1: its thickness");
}

TEST(SmallestPart, ASheetHasHalfItsWidth) {
    SceneDescription scene = floor_scene();
    add_object(scene, square(0.5, 4));
    expect_part(scene, 0.5 / std::numbers::sqrt2, "/objects/1: object 1: its half width");
    TrianglesObject doubled = square(0.5, 4);  // both windings: nothing is enclosed
    doubled.triangles.push_back({0, 2, 1});
    doubled.triangles.push_back({0, 3, 2});
    scene.objects[1].shape = doubled;
    expect_part(scene, 0.5 / std::numbers::sqrt2, "/objects/1: object 1: its half width");
}

/// A sheet of half size 1, one of whose triangles has this height.
TrianglesObject sliver(double height) {
    TrianglesObject sheet = square(1, 4);
    sheet.vertices.push_back({0, -1 - height, 4});
    sheet.uvs.push_back({0, 0});
    sheet.triangles.push_back({0, 4, 1});
    return sheet;
}

TEST(SmallestPart, TrianglesCountWhereTheyMirrorOrTransmit) {
    for (const int number : {1, 2}) {
        SceneDescription scene = floor_scene();
        add_object(scene, sliver(1e-3), number);
        expect_part(scene, 1e-3, "/objects/1: object 1: the least height of its triangles");
        scene.objects[1].material = 0;
        EXPECT_GT(smallest_part(scene).share * half_size, 0.5);
    }
}

TEST(SmallestPart, TrianglesWithoutAreaDoNotCount) {
    SceneDescription scene = floor_scene();
    add_object(scene, sliver(0), 1);
    EXPECT_GT(smallest_part(scene).share * half_size, 0.5);
    scene.objects[1].shape = sliver(1e-13);  // double does not tell it from one without
    EXPECT_GT(smallest_part(scene).share * half_size, 0.5);
    TrianglesObject broken = square(1, 4);
    broken.vertices.push_back({NAN, 0, 0});
    broken.uvs.push_back({0, 0});
    broken.triangles.push_back({0, 1, 4});
    scene.objects[1].shape = broken;
    EXPECT_GT(smallest_part(scene).share * half_size, 0.5);
}

TEST(SmallestPart, GapsDoNotCount) {
    for (const double gap : {0.0, 0x1p-11, 0.01, -0.01}) {
        SceneDescription scene = floor_scene();
        add_object(scene, cube({0, 0, 1 + gap}, 1));
        expect_part(scene, 1, "/objects/1: object 1: its inradius");
    }
}

/// A mesh of two, which are turned and moved together.
TrianglesObject united(TrianglesObject mesh, const TrianglesObject& other, const Rotation& turned = Rotation({0, 0, 0}),
                       const glm::dvec3& move = glm::dvec3(0)) {
    const auto first = uint32_t(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const auto& t : other.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    for (glm::dvec3& p : mesh.vertices) p = turned(p) + move;
    mesh.uvs.clear();
    mesh.keep_triangles = true;
    return mesh;
}

/// A box around another, whose top is `wall` below at x < 0 and `wall` + `rise` at x > 0.
TrianglesObject hollow_box(double wall, double rise = 0, const Rotation& turned = Rotation({0, 0, 0})) {
    TrianglesObject inner = triangulated_solid(cube({0, 0, 0}, 2));
    for (glm::dvec3& p : inner.vertices)
        if (p.z > 0) p.z = 4 - wall - (p.x > 0 ? rise : 0);
    return united(triangulated_solid(cube({0, 0, 0}, 4)), inner, turned, {0, 0, 20});
}

TEST(SmallestPart, WallsOfAMeshCountWhereItMirrorsOrTransmits) {
    for (const double wall : {0.2, 1e-2, 1e-4, 1e-8})
        for (const double rise : {0.0, 0.1, 1.0})
            for (const Rotation& turned : {Rotation({0, 0, 0}), Rotation({31, 47, 11})})
                for (const int number : {1, 2}) {
                    SceneDescription scene = floor_scene();
                    add_object(scene, hollow_box(wall, rise, turned), number);
                    expect_part(scene, wall / 2, "/objects/1: object 1: half its thinnest wall");
                    scene.objects[1].material = 0;
                    EXPECT_GT(smallest_part(scene).share * half_size, 0.5);
                }
}

TEST(SmallestPart, ThickWallsAndWhatIsNearerThanDoubleTellsDoNotCount) {
    for (const double wall : {0.3, 1e-10, 0.0}) {
        SceneDescription scene = floor_scene();
        add_object(scene, hollow_box(wall), 2);
        EXPECT_GT(smallest_part(scene).share * half_size, 0.5) << wall;
    }
}

TEST(SmallestPart, LayersOfASheetAreAWallWhicheverWayTheyAreWound) {
    for (const bool turned : {false, true}) {
        TrianglesObject layer = square(2, 10.01);
        for (auto& t : layer.triangles)
            if (turned) std::swap(t[0], t[1]);
        SceneDescription scene = floor_scene();
        add_object(scene, united(square(2, 10), layer), 2);
        expect_part(scene, 0.005, "/objects/1: object 1: half its thinnest wall");
    }
}

/// Two sides of n x n squares that rise by `slope` from an edge, `gap` apart there; 0: joined.
TrianglesObject knife(double slope, double gap, uint32_t n) {
    TrianglesObject mesh;
    mesh.keep_triangles = true;
    for (const double side : {1.0, -1.0}) {
        const auto first = uint32_t(mesh.vertices.size());
        for (uint32_t y = 0; y <= n; ++y)
            for (uint32_t x = 0; x <= n; ++x)
                mesh.vertices.push_back({2.0 * x / n, 2.0 * y / n, 10 + side * (gap / 2 + slope * 2 * y / n)});
        for (uint32_t y = 0; y < n; ++y)
            for (uint32_t x = 0; x < n; ++x) {
                const uint32_t a = first + y * (n + 1) + x, b = a + n + 1;
                for (std::array<uint32_t, 3> t : {std::array{a, a + 1, b + 1}, {a, b + 1, b}}) {
                    if (side < 0) std::swap(t[0], t[1]);
                    mesh.triangles.push_back(t);
                }
            }
    }
    return mesh;
}

TEST(SmallestPart, MeshesAreNoWallsAtTheirEdges) {
    const auto wall_of = [](const TrianglesObject& mesh) {
        SceneDescription scene = empty_scene();
        scene.materials.push_back(material("glass", 0, 0.5));
        add_object(scene, mesh, 1);
        const SmallestPart part = smallest_part(scene);
        return part.what.find("wall") == std::string::npos ? 0 : part.share;
    };
    for (const double slope : {1.0, 0.1, 0.01, 0.001, 0.0001}) {
        for (const uint32_t n : {1u, 8u, 32u}) EXPECT_EQ(wall_of(knife(slope, 0, n)), 0) << slope << " " << n;
        if (slope == 1) continue;
        EXPECT_NEAR(wall_of(knife(slope, 1e-5, 8)), 5e-6, 1e-7) << slope;  // the same sides where nothing joins them
    }
    EXPECT_EQ(wall_of(torus(1, 0.3, 64, 32)), 0);
    EXPECT_EQ(wall_of(bumpy_sphere(5000)), 0);
    EXPECT_EQ(wall_of(star(0.2, 1)), 0);
    for (const double flatness : {0.3, 0.05}) {  // two caps: a lens with a sharp rim
        TrianglesObject lens = bumpy_sphere(20'000, 0);
        for (glm::dvec3& p : lens.vertices) {
            const double square = p.x * p.x + p.y * p.y;
            if (square < 1) p.z = (p.z > 0 ? 1 : -1) * flatness * (1 - square);
            if (p.z * p.z < 1e-20) p.z = 0;
        }
        EXPECT_EQ(wall_of(lens), 0) << flatness;
    }
}

TEST(SmallestPart, AWallIsAsThinAsTheCornersOfWhatIsInsideTellIt) {
    std::mt19937 random(7);
    const auto uniform = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
    const PlatonicSolid kinds[] = {PlatonicSolid::tetrahedron, PlatonicSolid::cube, PlatonicSolid::octahedron,
                                   PlatonicSolid::dodecahedron, PlatonicSolid::icosahedron};
    int found = 0;
    for (int round = 0; round < 500; ++round) {
        SolidObject outer = solid(kinds[random() % 5]);
        SolidObject inner = solid(kinds[random() % 5], {}, 0.1 + 0.2 * uniform());
        outer.rotation = {360 * uniform(), 360 * uniform(), 0};
        inner.rotation = {360 * uniform(), 360 * uniform(), 0};
        const Rotation turned(outer.rotation);
        const Polyhedron& shape = platonic_shape(PlatonicSolid(outer.solid));
        TrianglesObject hole = triangulated_solid(inner);
        const auto wall_at = [&](const glm::dvec3& normal) {
            double nearest = INFINITY;
            for (const glm::dvec3& p : hole.vertices)
                nearest = std::min(nearest, shape.inradius - dot(turned(normal), p));
            return nearest;
        };
        const glm::dvec3 toward = shape.faces[random() % shape.faces.size()].normal;
        const double wall = std::pow(10, -3.7 - 5 * uniform());
        const glm::dvec3 move = (wall_at(toward) - wall) * turned(toward);
        for (glm::dvec3& p : hole.vertices) p += move;
        double least = INFINITY;
        for (const auto& face : shape.faces) least = std::min(least, wall_at(face.normal));
        if (least < 0.9 * wall) continue;  // beyond another face
        SceneDescription scene = empty_scene();
        scene.materials.push_back(material("glass", 0, 0.5));
        TrianglesObject mesh = united(triangulated_solid(outer), hole);
        double half = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const auto [low, high] =
                std::minmax_element(mesh.vertices.begin(), mesh.vertices.end(),
                                    [&](const auto& a, const auto& b) { return a[axis] < b[axis]; });
            half = std::max(half, ((*high)[axis] - (*low)[axis]) / 2);
        }
        add_object(scene, mesh, 1);
        const SmallestPart part = smallest_part(scene);
        if (least / half >= 0x1p-12) continue;
        EXPECT_EQ(part.what, "/objects/0: object 0: half its thinnest wall");
        EXPECT_NEAR(part.share * half, least / 2, 1e-12) << round;
        ++found;
    }
    EXPECT_GT(found, 300);
}

SceneDescription two_balls(double coat, double x = 0) {
    SceneDescription scene = empty_scene();
    for (const double radius : {1.0, 1 + coat}) {
        SphereObject ball;
        ball.center = {radius == 1 ? 0 : x, 0, 0};
        ball.radius = radius;
        add_object(scene, ball);
    }
    return scene;
}

TEST(SmallestPart, CoatsThatFloatWouldLoseTakeDouble) {
    for (const double coat : {9e-7, 3e-7, 1e-9, 1e-12, 1e-14}) {
        for (const SceneDescription& scene : {two_balls(coat), two_balls(-coat), two_balls(coat / 2, coat / 2)}) {
            const SmallestPart part = smallest_part(scene);
            EXPECT_EQ(part.what, "/objects/1: object 1: its distance from /objects/0");
            EXPECT_NEAR(part.share, std::max(coat, 0x1p-42), 1e-5 * coat + 1e-15);
            EXPECT_EQ(choose_precision({}, part).precision, Precision::double_);
            EXPECT_TRUE(choose_precision(Precision::double_, part).warning.empty());
            EXPECT_FALSE(choose_precision(Precision::single_, part).warning.empty());
        }
    }
    for (const double coat : {0.0, 4e-16, 3e-15, 2e-6, 0.1})  // equal, as rounding may leave them, and thick ones
        EXPECT_EQ(choose_precision({}, smallest_part(two_balls(coat))).precision, Precision::single_) << coat;
}

TEST(SmallestPart, TheThinnestOfManyCoatsCounts) {
    SceneDescription scene = empty_scene();
    for (const int shell : {4, 0, 9, 2, 16, 7}) {  // the nearest are 2 apart
        SphereObject ball;
        ball.radius = 1 + shell * 1e-7;
        ball.center = {3, 5, 7};
        add_object(scene, ball);
    }
    EXPECT_NEAR(smallest_part(scene).share, 2e-7, 1e-12);
}

TEST(SmallestPart, CoatsThatDoubleWouldLoseAreRefused) {
    for (const double distance : {1e7, 1e9}) {
        SceneDescription scene = two_balls(3e-7);
        SphereObject moon;
        moon.center = {distance, 0, 0};
        add_object(scene, moon);
        if (distance < 1e8)
            EXPECT_EQ(choose_precision({}, smallest_part(scene)).precision, Precision::double_);
        else
            EXPECT_ERROR(
                smallest_part(scene), ExitCode::usage,
                "test.json: /objects/1: 3.0e-07 from /objects/0: beside the scene's size double precision cannot "
                "hold that; make them equal, or bring what is far away nearer");
        scene.objects[1].shape = scene.objects[0].shape;  // equal ones are one, however far the moon is
        EXPECT_EQ(smallest_part(scene).what.find("distance"), std::string::npos);
    }
}

TEST(SmallestPart, LightsCountNearFacesUnlessTheyLieOnThem) {
    SceneDescription scene = floor_scene();
    add_object(scene, cube({0, 0, 4}, 1));
    add_light(scene, {0.5, 0.25, 5.01});
    expect_part(scene, 0.01, "/lights/0: a light's distance from a face of /objects/1");
    scene.lights[0].position = {0.5, 0.25, 4.99};
    expect_part(scene, 0.01, "/lights/0: a light's distance from a face of /objects/1");
    scene.lights[0].position = {0.5, 0.25, 0.01};
    expect_part(scene, 0.01, "/lights/0: a light's distance from a face of /objects/0");
    scene.lights[0].color = glm::dvec3(0);  // it lights nothing
    expect_part(scene, 1, "/objects/1: object 1: its inradius");
    scene.lights[0].color = glm::dvec3(1);
    for (const glm::dvec3& elsewhere : {glm::dvec3(0.5, 0.25, 5), glm::dvec3(0.5, 0.25, 0), glm::dvec3(2, 0, 5.01),
                                        glm::dvec3(2000, 0, 0.01), glm::dvec3(1, 1, 5)}) {
        scene.lights[0].position = elsewhere;
        expect_part(scene, 1, "/objects/1: object 1: its inradius");
    }
}

TEST(SmallestPart, SeenLightsHaveTheirRadius) {
    SceneDescription scene = floor_scene();
    add_light(scene, {0, 0, 4}).radius = 0.01;
    expect_part(scene, 0.01, "/lights/0: a light's radius");
    scene.lights.clear();
    SolidObject lamp = cube({0, 0, 4}, 1);
    lamp.edge_lights.count = 2;
    lamp.edge_lights.radius = 0.02;
    add_object(scene, lamp);
    expect_part(scene, 0.02, "/objects/1: a light's radius");
    add_light(scene, {0, 0, 1e8}).radius = 1e6;  // a sun makes the scene large
    EXPECT_NEAR(smallest_part(scene).share, 0.02 / (0.5 * (1e8 + 1e6)), 1e-12);
}

}  // namespace
}  // namespace cistula
