// The elements of "objects" in scene files.
#include <gtest/gtest.h>

#include "scene/description/light_group.h"
#include "scene/description/polyhedron.h"
#include "scene/readers/read_scene.h"
#include "scene/readers/scene_keys.h"
#include "testing/support/expect_error.h"

namespace cistula {
namespace {

SceneDescription read_objects(const std::string& objects) {
    return read_scene_text(
        "{\"textures\": {\"t\": {\"checker\": [0, 1]}}, \"materials\": {\"glass\": {}, \"tiles\": "
        "{\"texture\": \"t\"}}, \"objects\": [" +
            objects + "]}",
        "a.json", "dir");
}

#define EXPECT_WRONG_OBJECT(object, message) \
    EXPECT_ERROR(read_objects(object), ExitCode::usage, std::string("a.json: /objects/0") + message)

template <class Shape>
Shape shape_of(const std::string& object) {
    return std::get<Shape>(read_objects(object).objects.at(0).shape);
}

TEST(SceneSpheres, EveryKeyArrives) {
    const ObjectDescription object = read_objects(R"({"name": "ball", "solid": "sphere", "center": [1, 2, 3],
        "radius": 4, "rotate": [5, 6, 7], "material": "tiles"})")
                                         .objects.at(0);
    EXPECT_EQ(object.name, "ball");
    const auto& sphere = std::get<SphereObject>(object.shape);
    EXPECT_EQ(sphere.center, glm::dvec3(1, 2, 3));
    EXPECT_EQ(sphere.radius, 4);
    EXPECT_EQ(sphere.rotation, glm::dvec3(5, 6, 7));
}

TEST(SceneSpheres, HaveNoEdges) {
    EXPECT_WRONG_OBJECT(R"({"solid": "sphere", "material": "glass", "edge_lights": {"count": 1}})",
                        "/edge_lights: unknown key; known keys: name, solid, center, radius, rotate, material");
    EXPECT_WRONG_OBJECT(R"({"solid": "spere", "material": "glass"})",
                        "/solid: unknown value 'spere'; did you mean 'sphere'?");
}

TEST(ScenePlanes, EveryNumberArrives) {
    const auto plane = shape_of<DiskObject>(R"({"plane": [0, 3, 4, 10], "material": "tiles"})");
    EXPECT_TRUE(plane.is_endless());
    EXPECT_EQ(plane.normal, glm::dvec3(0, 3, 4));
    EXPECT_NEAR(length(plane.center - glm::dvec3(0, 1.2, 1.6)), 0, 1e-15);
    EXPECT_WRONG_OBJECT(R"({"plane": [0, 0, 0, 1], "material": "glass"})",
                        "/plane: the normal is 0; give the direction across the plane");
    EXPECT_WRONG_OBJECT(R"({"plane": [0, 0, 1], "material": "glass"})",
                        "/plane: expected a plane [nx, ny, nz, d], found an array of 3");
    EXPECT_WRONG_OBJECT(R"({"plane": [0, 0, 1, null], "material": "glass"})",
                        "/plane/3: expected a number from -1e30 to 1e30, found null");
    EXPECT_WRONG_OBJECT(R"({"plane": [0, 0, 1, 0], "radius": 2, "material": "glass"})",
                        "/radius: unknown key; known keys: name, plane, material");
}

TEST(SceneDisks, EveryKeyArrives) {
    const auto disk = shape_of<DiskObject>(
        R"({"disk": {"center": [1, 2, 3], "normal": [4, 5, 6], "radius": 7}, "material": "tiles"})");
    EXPECT_FALSE(disk.is_endless());
    EXPECT_EQ(disk.center, glm::dvec3(1, 2, 3));
    EXPECT_EQ(disk.normal, glm::dvec3(4, 5, 6));
    EXPECT_EQ(disk.radius, 7);
    EXPECT_EQ(shape_of<DiskObject>(R"({"disk": {}, "material": "tiles"})").radius, 1);
    EXPECT_WRONG_OBJECT(R"({"disk": {"normal": [0, 0, 0]}, "material": "glass"})",
                        "/disk/normal: the normal is 0; give the direction across the disk");
    EXPECT_WRONG_OBJECT(R"({"disk": {"radius": 0}, "material": "glass"})",
                        "/disk/radius: expected a number from 1e-30 to 1e30, found 0");
    EXPECT_WRONG_OBJECT(R"({"disk": {"radius": -1}, "material": "glass"})",
                        "/disk/radius: expected a number from 1e-30 to 1e30, found -1");
    EXPECT_WRONG_OBJECT(R"({"disk": 3, "material": "glass"})", "/disk: expected an object, found 3");
}

TEST(ScenePlanes, ChangeNumberByNumber) {
    const SceneDescription scene = read_objects(
        R"({"plane": [0, 0, 1, {"keys": [[0, 1], [2, 3]]}], "material": "glass"},
           {"disk": {"radius": {"keys": [[0, 1], [2, 2]]}}, "material": "glass"})");
    const SceneDescription later = at_frame(scene, 1);
    EXPECT_EQ(std::get<DiskObject>(later.objects[0].shape).center, glm::dvec3(0, 0, 2));
    EXPECT_EQ(std::get<DiskObject>(later.objects[1].shape).radius, 1.5);
}

TEST(ScenePlanes, ChangeAsAWhole) {
    const SceneDescription scene = read_objects(
        R"({"plane": {"keys": [[0, [0, 0, 1, 2]], [4, [0, 4, 1, 6]], [8, [0, 4, 1, -2]]]}, "material": "glass"},
           {"solid": "convex", "material": "glass", "planes": [[1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1],
                [0, 0, 1, 1], {"keys": [[0, [0, 0, -1, 1]], [2, [0, 0, -1, 3]]], "interpolation": "step"}]})");
    ASSERT_TRUE(scene.motion);
    EXPECT_EQ(scene.motion->objects, (std::vector<size_t>{0, 1}));
    EXPECT_EQ(scene.motion->frames, (std::vector{0, 2, 4, 8}));
    const auto plane = [&](int frame) { return std::get<DiskObject>(at_frame(scene, frame).objects[0].shape); };
    EXPECT_EQ(plane(0).normal, glm::dvec3(0, 0, 1));
    EXPECT_EQ(plane(0).center, glm::dvec3(0, 0, 2));
    EXPECT_EQ(plane(1).normal, glm::dvec3(0, 1, 1));
    EXPECT_NEAR(length(plane(1).center - glm::dvec3(0, 1.5, 1.5)), 0, 1e-15);
    EXPECT_EQ(plane(9).normal, glm::dvec3(0, 4, 1));
    EXPECT_NEAR(dot(plane(9).center, plane(9).normal), -2, 1e-15);
    const auto lowest = [&](int frame) {
        double z = 0;
        const SceneDescription there = at_frame(scene, frame);
        for (const glm::dvec3& vertex : std::get<SolidObject>(there.objects[1].shape).body->vertices)
            z = std::min(z, vertex.z);
        return z;
    };
    EXPECT_EQ(lowest(1), -1);
    EXPECT_EQ(lowest(2), -3);
    EXPECT_WRONG_OBJECT(R"({"plane": {"keys": [[0, [0, 0, 1]]]}, "material": "glass"})",
                        "/plane/keys/0/1: expected a plane [nx, ny, nz, d], found an array of 3");
    EXPECT_WRONG_OBJECT(R"({"plane": {"keys": [[0, [0, 0, 1, 1e31]]]}, "material": "glass"})",
                        "/plane/keys/0/1/3: expected a number from -1e30 to 1e30, found 1e31");
    EXPECT_ERROR(read_objects(R"({"plane": {"keys": [[0, [0, 0, 0, 1]]]}, "material": "glass"})"), ExitCode::usage,
                 "frame 0: a.json: /objects/0/plane: the normal is 0; give the direction across the plane");
}

TEST(SceneSolids, EveryKeyArrives) {
    const ObjectDescription object =
        read_objects(R"({"name": "gem", "solid": "icosahedron", "center": [1, 2, 3], "radius": 4,
        "rotate": [5, 6, 7], "material": "glass", "edge_lights": {"count": 8, "color": [1, 2, 3], "glow": 9,
        "radius": 0.5, "visible": false, "falloff": "inverse-square"}})")
            .objects.at(0);
    EXPECT_EQ(object.name, "gem");
    EXPECT_EQ(object.material, 0);
    EXPECT_EQ(object.place, "/objects/0");
    const auto& solid = std::get<SolidObject>(object.shape);
    EXPECT_EQ(solid.center, glm::dvec3(1, 2, 3));
    EXPECT_EQ(solid.radius, 4);
    EXPECT_EQ(solid.rotation, glm::dvec3(5, 6, 7));
    EXPECT_EQ(solid.edge_lights.count, 8);
    EXPECT_EQ(solid.edge_lights.color, glm::dvec3(1, 2, 3));
    EXPECT_EQ(solid.edge_lights.glow, glm::dvec3(9));
    EXPECT_EQ(solid.edge_lights.radius, 0.5);
    EXPECT_FALSE(solid.edge_lights.visible || solid.edge_lights.shown());
    EXPECT_TRUE(solid.edge_lights.falloff);
}

TEST(SceneSolids, AllFiveByName) {
    const std::pair<const char*, PlatonicSolid> solids[] = {{"tetrahedron", PlatonicSolid::tetrahedron},
                                                            {"cube", PlatonicSolid::cube},
                                                            {"octahedron", PlatonicSolid::octahedron},
                                                            {"dodecahedron", PlatonicSolid::dodecahedron},
                                                            {"icosahedron", PlatonicSolid::icosahedron}};
    for (const auto& [name, solid] : solids)
        EXPECT_EQ(shape_of<SolidObject>("{\"solid\": \"" + std::string(name) + "\", \"material\": \"glass\"}").solid,
                  solid);
}

TEST(SceneSolids, Errors) {
    EXPECT_WRONG_OBJECT(R"({"solid": "octahedrom", "material": "glass"})",
                        "/solid: unknown value 'octahedrom'; did you mean 'octahedron'?");
    std::string names;
    for (const KeyTable* table : {&sphere_keys, &box_keys, &convex_keys, &prism_keys, &solid_keys})
        for (const std::string_view name : table->find("solid")->choices)
            names += (names.empty() ? "" : ", ") + std::string(name);
    EXPECT_WRONG_OBJECT(R"({"solid": "torus", "material": "glass"})",
                        "/solid: unknown value 'torus'; known values: " +
                            names.substr(0, names.find(", truncated-cuboctahedron")) + ", ...");
    EXPECT_WRONG_OBJECT(R"({"solid": "truncatedcube", "material": "glass"})",
                        "/solid: unknown value 'truncatedcube'; did you mean 'truncated-cube'?");
    EXPECT_WRONG_OBJECT(R"({"solid": 8, "material": "glass"})", "/solid: expected one of " + names + ", found 8");
    EXPECT_WRONG_OBJECT(R"({"solid": "cube", "radius": 0, "material": "glass"})",
                        "/radius: expected a number from 1e-30 to 1e30, found 0");
    EXPECT_WRONG_OBJECT(R"({"solid": "cube", "center": [1, 2], "material": "glass"})",
                        "/center: expected [x, y, z], each from -1e30 to 1e30, found an array of 2");
    EXPECT_WRONG_OBJECT(R"({"solid": "cube", "center": [1, 2, null], "material": "glass"})",
                        "/center/2: expected a number from -1e30 to 1e30, found null");
    EXPECT_WRONG_OBJECT(R"({"solid": "cube", "rotate": 30, "material": "glass"})",
                        "/rotate: expected [x, y, z], each from -1000000 to 1000000, found 30");
    EXPECT_WRONG_OBJECT(R"({"solid": "cube"})", ": missing key 'material': expected a string that is not empty");
    EXPECT_WRONG_OBJECT(R"({"solid": "cube", "material": "glas"})",
                        "/material: unknown material 'glas'; did you mean 'glass'?");
    EXPECT_WRONG_OBJECT(R"({"solid": "cube", "material": "adamant"})",
                        "/material: unknown material 'adamant'; known materials: glass, tiles");
    EXPECT_WRONG_OBJECT(
        R"({"solid": "cube", "material": "tiles"})",
        "/material: the material 'tiles' has a texture, but a solid has no uv for it; use triangles with 'uvs' or a "
        "mesh");
    EXPECT_WRONG_OBJECT(R"({"solid": "cube", "material": "glass", "scale": 2})",
                        "/scale: unknown key; known keys: name, solid, center, radius, rotate, material, edge_lights");
    EXPECT_WRONG_OBJECT(R"({"solid": "cube", "material": "glass", "name": ""})",
                        "/name: expected a string that is not empty, found an empty string");
}

TEST(SceneSolids, BodiesOfOtherKinds) {
    const auto body = [](const std::string& keys) {
        return shape_of<SolidObject>("{" + keys + R"(, "center": [1, 2, 3], "rotate": [4, 5, 6], "material": "glass",
            "edge_lights": {"count": 3}})");
    };
    const SolidObject box = body(R"("solid": "box", "size": [1, 2, 4])");
    EXPECT_EQ(box.body->name, "box");
    EXPECT_EQ(box.body->planes[2].high, 2);
    EXPECT_EQ(box.center, glm::dvec3(1, 2, 3));
    EXPECT_EQ(box.rotation, glm::dvec3(4, 5, 6));
    EXPECT_EQ(box.radius, 1);
    EXPECT_EQ(box.edge_lights.count, 3);
    const SolidObject snub = body(R"("solid": "snub-cube", "radius": 2)");
    EXPECT_EQ(snub.body->name, "snub-cube");
    EXPECT_EQ(snub.radius, 2);
    const SolidObject pyramid = body(R"("solid": "pyramid", "sides": 5, "height": 3)");
    EXPECT_EQ(pyramid.body->faces.size(), 6u);
    EXPECT_EQ(pyramid.body->vertices[5], glm::dvec3(0, 0, 1.5));
    EXPECT_EQ(body(R"("solid": "prism", "sides": 5, "radius": 3)").body->vertices[0], glm::dvec3(3, 0, -0.5));
    const SolidObject planes = body(R"("solid": "convex", "scale": 2,
        "planes": [[-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -2, 0], [1, 1, 1, 1]])");
    EXPECT_EQ(planes.body->faces.size(), 4u);
    EXPECT_EQ(planes.radius, 2);
    EXPECT_EQ(body(R"("solid": "convex", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])").body->faces.size(),
              4u);
}

TEST(SceneSolids, BodyErrors) {
    const auto wrong = [](const std::string& keys, const std::string& message) {
        EXPECT_WRONG_OBJECT("{" + keys + R"(, "material": "glass"})", message);
    };
    wrong(R"("solid": "box", "radius": 1, "size": [1, 1, 1])",
          "/radius: unknown key; known keys: name, solid, size, center, rotate, material, edge_lights");
    wrong(R"("solid": "box", "size": [1, 0, 1])", "/size/1: expected a number from 1e-30 to 1e30, found 0");
    wrong(R"("solid": "box", "size": [1, 1e-20, 1])", "/size: the body is flat, or nearly so; give one with an inside");
    wrong(R"("solid": "prism", "sides": 2)", "/sides: expected a whole number from 3 to 255, found 2");
    wrong(R"("solid": "antiprism", "sides": 128)",
          "/sides: the body has 258 faces; expected at most 256; give it as a mesh");
    wrong(R"("solid": "convex")", ": expected one of the keys 'planes' and 'points'");
    wrong(R"("solid": "convex", "planes": [], "points": [])", ": expected one of 'planes' and 'points', found both");
    wrong(R"("solid": "convex", "planes": [[1, 0, 0, 1]])",
          "/planes: expected an array of at least four planes [nx, ny, nz, d], found an array of 1");
    wrong(R"("solid": "convex", "planes": [[1, 0, 0], 1, 2, 3])",
          "/planes/0: expected a plane [nx, ny, nz, d], found an array of 3");
    wrong(R"("solid": "convex", "planes": [[1, 0, 0, 1], [0, 0, 0, 1], 2, 3])",
          "/planes/1: the normal is 0; give the direction in which the face looks");
    wrong(R"("solid": "convex", "planes": [[1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1], [0, 0, 1, 1]])",
          "/planes: the planes leave the body open toward [0, 0, -1]; add a plane that faces there");
    wrong(R"("solid": "convex", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])",
          "/points: the points lie in one plane, or nearly so; give corners of a body with an inside");
}

TEST(SceneSolids, EdgeLightErrors) {
    const auto solid = [](const std::string& lights) {
        return R"({"solid": "cube", "material": "glass", "edge_lights": )" + lights + "}";
    };
    EXPECT_WRONG_OBJECT(solid("6"), "/edge_lights: expected an object, found 6");
    EXPECT_WRONG_OBJECT(solid("{}"), "/edge_lights: missing key 'count': expected a whole number from 0 to 1000");
    EXPECT_WRONG_OBJECT(solid(R"({"count": 1001})"),
                        "/edge_lights/count: expected a whole number from 0 to 1000, found 1001");
    EXPECT_WRONG_OBJECT(solid(R"({"count": 1, "position": [0, 0, 0]})"),
                        "/edge_lights/position: unknown key; known keys: count, color, glow, radius, visible, falloff, "
                        "group");
    EXPECT_WRONG_OBJECT(solid(R"({"count": 1, "group": "key.left"})"),
                        "/edge_lights/group: the name 'key.left' has a dot, which separates layers from channels");
    EXPECT_WRONG_OBJECT(solid(R"({"count": 1, "group": "key left"})"),
                        "/edge_lights/group: the name 'key left' has other characters than letters, digits, _ and -");
    EXPECT_WRONG_OBJECT(solid(R"({"count": 1, "group": "glow"})"),
                        "/edge_lights/group: the name 'glow' is that of a layer which every scene has");
    EXPECT_WRONG_OBJECT(solid(R"({"count": 1, "group": ")" + std::string(55, 'g') + "\"}"),
                        "/edge_lights/group: the name '" + std::string(40, 'g') + "...' is longer than 54 bytes");
    EXPECT_WRONG_OBJECT(solid(R"({"count": 1, "group": ""})"),
                        "/edge_lights/group: expected a string that is not empty, found an empty string");
    EXPECT_WRONG_OBJECT(
        solid(R"({"count": 1, "falloff": "inverse-square"})"),
        "/edge_lights/falloff: inverse-square needs a 'radius' above 0, within which it stays constant");
}

TEST(SceneSolids, EdgeLightsAreAGroupByTheSolidsName) {
    const auto group = [](const std::string& solid) {
        return LightGroups(SceneDescription()).of_edges(EdgeLights{}, solid);
    };
    EXPECT_EQ(group("left. cube"), "edges_left__cube");
    EXPECT_EQ(group(std::string(48, 'n')), "edges_" + std::string(48, 'n'));
    EXPECT_EQ(group(std::string(49, 'n')), "edges_" + std::string(48, 'n'));
    EXPECT_EQ(group(std::string(47, 'n') + "\u00fc"), "edges_" + std::string(47, 'n'));  // two bytes
    EXPECT_EQ(group(std::string(46, 'n') + "\u00fc"), "edges_" + std::string(46, 'n') + "\u00fc");
    EdgeLights given;
    given.group = std::string(54, 'g');
    EXPECT_EQ(LightGroups(SceneDescription()).of_edges(given, "cube"), given.group);
    EXPECT_EQ(fault_of_light_group(given.group), "");
}

TEST(SceneLights, GroupsThatAreNotGivenAreNobodyElses) {
    SceneDescription scene;
    scene.lights.resize(3);
    scene.lights[0].group = "light1";
    LightGroups groups(scene);
    EXPECT_EQ(groups.of_light(0), "light1");
    EXPECT_EQ(groups.of_light(1), "light1_2");
    EXPECT_EQ(groups.of_light(2), "light2");
    EXPECT_EQ(groups.of_edges({}, "a b"), "edges_a_b");
    EXPECT_EQ(groups.of_edges({}, "a_b"), "edges_a_b_2");
    EXPECT_EQ(groups.of_edges({}, "a.b"), "edges_a_b_3");
    EXPECT_EQ(groups.of_edges({}, std::string(60, 'n') + '1'), "edges_" + std::string(48, 'n'));
    EXPECT_EQ(groups.of_edges({}, std::string(60, 'n') + '2'), "edges_" + std::string(46, 'n') + "_2");
}

TEST(SceneQuads, BecomeTwoTrianglesWithUv) {
    const auto quad =
        shape_of<TrianglesObject>(R"({"quad": [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]], "material": "tiles"})");
    EXPECT_EQ(quad.vertices, (std::vector<glm::dvec3>{{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}));
    EXPECT_EQ(quad.triangles, (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(quad.uvs, (std::vector<glm::dvec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
}

TEST(SceneQuads, MustBePlanarAndConvexAtAnyScale) {
    const auto quad = [](const std::string& corners) { return R"({"material": "glass", "quad": )" + corners + "}"; };
    EXPECT_NO_THROW(read_objects(quad("[[0, 0, 0], [1, 0, 0], [1, 1, 1e-7], [0, 1, 0]]")));
    EXPECT_NO_THROW(read_objects(quad("[[0, 0, 0], [1e29, 0, 0], [1e29, 1e29, 0], [0, 1e29, 0]]")));
    EXPECT_NO_THROW(read_objects(quad("[[0, 0, 0], [1e-20, 0, 0], [1e-20, 1e-20, 0], [0, 1e-20, 0]]")));
    EXPECT_NO_THROW(read_objects(quad("[[0, 0, 0], [0, 0, 2], [1, 0, 3], [5, 0, 0]]")));
    EXPECT_WRONG_OBJECT(
        quad("[[0, 0, 0], [4, 0, 0], [4, 3, 2.5], [0, 3, 0]]"),
        "/quad: the quad is not planar: its diagonals pass at 0.2 of their length, at most 1e-06 is allowed");
    EXPECT_WRONG_OBJECT(quad("[[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]]"),
                        "/quad: the quad has no area or crosses itself; give the corners in order around it");
    EXPECT_WRONG_OBJECT(quad("[[0, 0, 0], [4, 0, 0], [1, 1, 0], [0, 4, 0]]"),
                        "/quad: the quad is not convex at corner 2; give the corners in order around it");
    EXPECT_WRONG_OBJECT(quad("[[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]"),
                        "/quad: the quad has no area or crosses itself; give the corners in order around it");
    EXPECT_WRONG_OBJECT(quad("[[0, 0, 0], [2, 2, 0], [3, 0, 0], [0, 1, 0]]"),
                        "/quad: the quad is not convex at corner 0; give the corners in order around it");
    EXPECT_WRONG_OBJECT(quad("[[1, 1, 1], [1, 1, 1], [1, 1, 1], [1, 1, 1]]"),
                        "/quad: the four corners of the quad coincide");
    EXPECT_WRONG_OBJECT(quad("[[0, 0, 0], [1, 0, 0], [1, 1, 0]]"),
                        "/quad: expected an array of four points [x, y, z], found an array of 3");
    EXPECT_WRONG_OBJECT(quad("[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1]]"),
                        "/quad/3: expected [x, y, z], each from -1e30 to 1e30, found an array of 2");
    EXPECT_WRONG_OBJECT(
        R"({"quad": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "material": "glass", "center": [0, 0, 0]})",
        "/center: unknown key; known keys: name, quad, material");
    EXPECT_WRONG_OBJECT(R"({"quad": []})", ": missing key 'material': expected a string that is not empty");
}

TEST(SceneTriangles, Arrive) {
    const auto list =
        shape_of<TrianglesObject>(R"({"name": "n", "material": "tiles", "keep_triangles": true, "triangles": {
        "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "indices": [[0, 1, 2], [3, 2, 1]],
        "uvs": [[0, 0], [1, 0], [0, 1], [-2, 3.5]], "normals": [[0, 0, 1], [0, 0, 0], [1, 2, 3], [0, 0, 1]]},
        "smooth": 45})");
    EXPECT_EQ(list.vertices.size(), 4u);
    EXPECT_EQ(list.vertices[3], glm::dvec3(0, 0, 1));
    EXPECT_EQ(list.triangles, (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {3, 2, 1}}));
    EXPECT_EQ(list.uvs[3], glm::dvec2(-2, 3.5));
    EXPECT_EQ(list.normals[2], glm::dvec3(1, 2, 3));
    EXPECT_EQ(list.smooth, 45.0);
    EXPECT_TRUE(list.keep_triangles);
}

TEST(SceneTriangles, Errors) {
    const auto list = [](const std::string& vertices, const std::string& indices, const std::string& more = "") {
        return R"({"material": "glass", "triangles": {"vertices": )" + vertices + ", \"indices\": " + indices + more +
               "}}";
    };
    const std::string three = "[[0, 0, 0], [1, 0, 0], [0, 1, 0]]";
    EXPECT_WRONG_OBJECT(
        list("[[0, 0, 0]]", "[[0, 0, 0]]"),
        "/triangles/vertices: expected an array of at least three points [x, y, z], found an array of 1");
    EXPECT_WRONG_OBJECT(list("[[0, 0, 0], [1, 0, 0], 5]", "[[0, 0, 0]]"),
                        "/triangles/vertices/2: expected [x, y, z], each from -1e30 to 1e30, found 5");
    EXPECT_WRONG_OBJECT(
        list(three, "[]"),
        "/triangles/indices: expected an array of at least one triangle [i, j, k], found an empty array");
    EXPECT_WRONG_OBJECT(list(three, "[[0, 1]]"),
                        "/triangles/indices/0: expected three indices of vertices [i, j, k], found an array of 2");
    EXPECT_WRONG_OBJECT(list(three, "[[0, 1, 2], [0, 1, 3]]"),
                        "/triangles/indices/1/2: expected a whole number from 0 to 2, found 3");
    EXPECT_WRONG_OBJECT(list(three, "[[0, 1, -1]]"),
                        "/triangles/indices/0/2: expected a whole number from 0 to 2, found -1");
    EXPECT_WRONG_OBJECT(list(three, "[[0, 1, 0.5]]"),
                        "/triangles/indices/0/2: expected a whole number from 0 to 2, found 0.5");
    EXPECT_WRONG_OBJECT(list(three, "[[0, 1, 2]]", R"(, "uvs": [[0, 0]])"),
                        "/triangles/uvs: expected an array of 3 pairs [u, v], one a vertex, found an array of 1");
    EXPECT_WRONG_OBJECT(list(three, "[[0, 1, 2]]", R"(, "uvs": [[0, 0], [0, 0], [0, 1e7]])"),
                        "/triangles/uvs/2/1: expected a number from -1000000 to 1000000, found 10000000");
    EXPECT_WRONG_OBJECT(
        list(three, "[[0, 1, 2]]", R"(, "normals": [[0, 0, 1]])"),
        "/triangles/normals: expected an array of 3 vectors [x, y, z], one a vertex, found an array of 1");
    const auto smooth = [](const std::string& value) {
        return R"({"material": "glass", "mesh": "a.ply", "smooth": )" + value + "}";
    };
    EXPECT_WRONG_OBJECT(smooth("true"), "/smooth: expected false, or an angle from 0 to 180 degrees, found true");
    EXPECT_WRONG_OBJECT(smooth("181"), "/smooth: expected a number from 0 to 180, found 181");
    EXPECT_WRONG_OBJECT(smooth("-1"), "/smooth: expected a number from 0 to 180, found -1");
    EXPECT_EQ(shape_of<MeshObject>(R"({"material": "glass", "mesh": "a.ply", "smooth": false})").smooth, 0.0);
    EXPECT_FALSE(shape_of<MeshObject>(R"({"material": "glass", "mesh": "a.ply"})").smooth.has_value());
    EXPECT_WRONG_OBJECT(list(three, "[[0, 1, 2]]", R"(, "uv": [])"), "/triangles/uv: unknown key; did you mean 'uvs'?");
    EXPECT_WRONG_OBJECT(R"({"material": "glass", "triangles": {"vertices": []}})", "/triangles: missing key 'indices'");
    EXPECT_WRONG_OBJECT(R"({"material": "tiles", "triangles": {"vertices": )" + three + R"(, "indices": [[0, 1, 2]]}})",
                        "/material: the material 'tiles' has a texture, but the triangles have no 'uvs'");
}

TEST(SceneMeshes, EveryKeyArrives) {
    const ObjectDescription object =
        read_objects(
            R"({"name": "n", "mesh": "a.ply", "center": [1, 2, 3], "scale": 4, "rotate": [5, 6, 7],
                "keep_triangles": true, "material": "tiles"})")
            .objects.at(0);
    const auto& mesh = std::get<MeshObject>(object.shape);
    EXPECT_EQ(object.material, 1);
    EXPECT_EQ(mesh.file, "dir/a.ply");
    EXPECT_EQ(mesh.center, glm::dvec3(1, 2, 3));
    EXPECT_EQ(mesh.scale, 4);
    EXPECT_EQ(mesh.rotation, glm::dvec3(5, 6, 7));
    EXPECT_TRUE(mesh.keep_triangles);
    EXPECT_FALSE(shape_of<MeshObject>(R"({"mesh": "a.ply"})").keep_triangles);
    EXPECT_EQ(read_objects(R"({"mesh": "a.ply"})").objects.at(0).material, -1);
    EXPECT_WRONG_OBJECT(R"({"mesh": "a.ply", "scale": -1})", "/scale: expected a number from 1e-30 to 1e30, found -1");
    EXPECT_WRONG_OBJECT(R"({"mesh": 1})", "/mesh: expected a string that is not empty, found 1");
}

TEST(SceneObjects, HaveOneForm) {
    EXPECT_WRONG_OBJECT("3", ": expected an object, found 3");
    EXPECT_WRONG_OBJECT("{}", ": expected one of the keys 'solid', 'plane', 'disk', 'quad', 'triangles' and 'mesh'");
    EXPECT_WRONG_OBJECT(R"({"soild": "cube", "material": "glass"})", "/soild: unknown key; did you mean 'solid'?");
    EXPECT_WRONG_OBJECT(R"({"solid": "cube", "mesh": "a.ply"})",
                        ": expected one of 'solid', 'plane', 'disk', 'quad', 'triangles' and 'mesh', found both "
                        "'solid' and 'mesh'");
    EXPECT_ERROR(read_objects(R"({"mesh": "a"}, {"mesh": "b"}, {"solid": "cube", "center": 0, "material": "glass"})"),
                 ExitCode::usage, "a.json: /objects/2/center: expected [x, y, z], each from -1e30 to 1e30, found 0");
}

TEST(SceneObjects, HaveDifferentNames) {
    const auto scene = [](const std::string& first, const std::string& second) {
        const auto cube = [](const std::string& name) {
            return R"({"solid": "cube", "material": "m")" + (name.empty() ? "" : ", \"name\": \"" + name + "\"") + "}";
        };
        return R"({"materials": {"m": {}}, "objects": [)" + cube(first) + "," + cube(second) + "]}";
    };
    EXPECT_NO_THROW(read_scene_text(scene("a", "b"), "a.json", ""));
    EXPECT_NO_THROW(read_scene_text(scene("", ""), "a.json", ""));
    EXPECT_ERROR(read_scene_text(scene("a", "a"), "a.json", ""), ExitCode::usage,
                 "a.json: /objects/1/name: 'a' is the name of /objects/0 too; give each its own");
}

TEST(SceneObjects, KeepTheOrderOfTheFile) {
    const auto objects = read_objects(R"({"mesh": "z"}, {"mesh": "a"}, {"mesh": "m"})").objects;
    std::string order;
    for (const auto& object : objects) order += std::get<MeshObject>(object.shape).file + object.place + " ";
    EXPECT_EQ(order, "dir/z/objects/0 dir/a/objects/1 dir/m/objects/2 ");
}

}  // namespace
}  // namespace cistula
