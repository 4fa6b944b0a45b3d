// What is smallest in a scene, and which object it is (docs/rules.md, 12).
#include "scene/compile/solids/smallest_part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/description/platonic.h"
#include "scene/description/rotation.h"
#include "testing/support/expect_error.h"
#include "testing/support/scene_samples.h"

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
