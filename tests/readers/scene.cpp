// Scene files: JSON from the top level down to cameras, textures, materials and lights; objects are in
// tests/readers/objects.cpp.
#include "scene/readers/read_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <sstream>

#include "scene/readers/scene_formats.h"
#include "testing/support/read_text.h"
#include "testing/support/scene_dump.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

using test::json_scene;
using test::scene_with;

TEST(SceneFile, UnreadableFilesAreFileErrors) {
    const ScratchDirectory scratch;
    const std::string missing = scratch.file("missing.json");
    EXPECT_ERROR(read_scene(missing), ExitCode::file, missing + ": cannot read the scene: No such file or directory");
    EXPECT_ERROR(read_scene(scratch.file("")), ExitCode::file,
                 scratch.file("") + ": is a folder; expected a scene file");
}

TEST(SceneFile, NamesInItAreRelativeToIt) {
    const ScratchDirectory scratch;
    put_bytes(scratch.file("a.json"), R"({"objects": [{"mesh": "deep/b.ply"}],
        "textures": {"near": {"file": "t.exr"}, "far": {"file": "/elsewhere/t.exr"}}})");
    const SceneDescription scene = read_scene(scratch.file("a.json"));
    EXPECT_EQ(scene.source, scratch.file("a.json"));
    EXPECT_EQ(scene.textures[0].file, scratch.file("t.exr"));
    EXPECT_EQ(scene.textures[1].file, "/elsewhere/t.exr");
    EXPECT_EQ(std::get<MeshObject>(scene.objects[0].shape).file, scratch.file("deep/b.ply"));
}

TEST(SceneFile, StandardInputIsRead) {
    std::istringstream input(R"({"objects": [], "depth": 7, "textures": {"t": {"file": "t.exr"}}})");
    std::streambuf* const before = std::cin.rdbuf(input.rdbuf());
    const SceneDescription scene = read_scene("-");
    std::istringstream wrong("{\"depth\": 0, \"objects\": []}");
    std::cin.rdbuf(wrong.rdbuf());
    std::cin.clear();
    EXPECT_WRONG(read_scene("-"), "standard input: /depth: expected a whole number from 1 to 1024, found 0");
    std::cin.rdbuf(before);
    EXPECT_EQ(scene.source, "-");
    EXPECT_EQ(scene.depth, 7);
    EXPECT_EQ(scene.textures[0].file, "t.exr");
}

TEST(SceneFile, FormatIsToldByTheFirstCharacter) {
    EXPECT_FALSE(json_scene(" \n\t{\"objects\": []}").from_text_input);
    EXPECT_FALSE(json_scene("\xEF\xBB\xBF{\"objects\": []}").from_text_input);
    EXPECT_TRUE(json_scene("\n" + text_input_template()).from_text_input);
    EXPECT_WRONG(json_scene(" \n"), "a.json: the scene is empty; expected JSON or the text of --print-template");
    EXPECT_WRONG(json_scene("// mine\n{}"),
                 "a.json: a JSON scene begins with '{', found '/'; comments may stand anywhere after it");
    EXPECT_WRONG(json_scene("[]"),
                 "a.json: a JSON scene begins with '{', found '['; comments may stand anywhere after it");
}

TEST(SceneKeys, UnknownOnesNameTheNearest) {
    EXPECT_WRONG(scene_with("\"dept\": 1"), "a.json: /dept: unknown key; did you mean 'depth'?");
    EXPECT_WRONG(scene_with("\"film\": {\"widht\": 1}"), "a.json: /film/widht: unknown key; did you mean 'width'?");
    EXPECT_WRONG(
        scene_with("\"film\": {\"quality\": 1}"),
        "a.json: /film/quality: unknown key; known keys: width, height, frames, supersample, frames_per_second, "
        "owner, comments");
    EXPECT_WRONG(scene_with("\"a/b~\\n\": 1"),
                 "a.json: /a~1b~0\\n: unknown key; known keys: $schema, film, depth, cutoff, contact, ambient, "
                 "background, camera, "
                 "textures, materials, objects, lights, frame");
    EXPECT_WRONG(json_scene("{}"), "a.json: /: missing key 'objects'");
}

TEST(SceneKeys, TypesAreChecked) {
    EXPECT_WRONG(scene_with("\"depth\": \"4\""), "a.json: /depth: expected a whole number from 1 to 1024, found '4'");
    EXPECT_WRONG(scene_with("\"depth\": 1.5"), "a.json: /depth: expected a whole number from 1 to 1024, found 1.5");
    EXPECT_WRONG(scene_with("\"depth\": null"), "a.json: /depth: expected a whole number from 1 to 1024, found null");
    EXPECT_WRONG(scene_with("\"depth\": 99999999999999999999"),
                 "a.json: /depth: expected a whole number from 1 to 1024, found 1e20");
    EXPECT_WRONG(scene_with("\"cutoff\": true"), "a.json: /cutoff: expected a number from 0 to 1e30, found true");
    EXPECT_WRONG(scene_with("\"film\": 3"), "a.json: /film: expected an object, found 3");
    EXPECT_WRONG(scene_with("\"lights\": {}"), "a.json: /lights: expected an array of lights, found an empty object");
    EXPECT_WRONG(json_scene("{\"objects\": 1}"), "a.json: /objects: expected an array of objects, found 1");
    EXPECT_WRONG(scene_with("\"materials\": []"),
                 "a.json: /materials: expected an object of materials by name, found an empty array");
    EXPECT_WRONG(scene_with("\"materials\": {\"\": {}}"), "a.json: /materials/: a material's name is not empty");
    EXPECT_WRONG(scene_with("\"$schema\": 1"), "a.json: /$schema: expected a string that is not empty, found 1");
    EXPECT_WRONG(scene_with("\"$schema\": \"\""),
                 "a.json: /$schema: expected a string that is not empty, found an empty string");
    EXPECT_EQ(scene_with("\"depth\": 1e1").depth, 10);
}

TEST(SceneKeys, RangesOfFilmAndTopLevel) {
    for (const char* key : {"width", "height"}) {
        for (const char* wrong : {"0", "65537"})
            EXPECT_WRONG(
                scene_with("\"film\": {\"" + std::string(key) + "\": " + wrong + "}"),
                "a.json: /film/" + std::string(key) + ": expected a whole number from 1 to 65536, found " + wrong);
        EXPECT_NO_THROW(scene_with("\"film\": {\"" + std::string(key) + "\": 65536}"));
    }
    EXPECT_WRONG(scene_with("\"film\": {\"frames\": 0}"),
                 "a.json: /film/frames: expected a whole number from 1 to 1000000, found 0");
    EXPECT_WRONG(scene_with("\"film\": {\"supersample\": 65}"),
                 "a.json: /film/supersample: expected a whole number from 1 to 64, found 65");
    EXPECT_WRONG(scene_with("\"depth\": 1025"), "a.json: /depth: expected a whole number from 1 to 1024, found 1025");
    EXPECT_WRONG(scene_with("\"cutoff\": -1e-9"), "a.json: /cutoff: expected a number from 0 to 1e30, found -1e-09");
    EXPECT_EQ(scene_with("\"depth\": 1024").depth, 1024);
}

TEST(SceneKeys, ColorsAreOneNumberOrThree) {
    EXPECT_EQ(scene_with("\"background\": 0.25").background, glm::dvec3(0.25));
    EXPECT_EQ(scene_with("\"background\": [0.1, 2, 3]").background, glm::dvec3(0.1, 2, 3));
    EXPECT_WRONG(
        scene_with("\"ambient\": [1, 2]"),
        "a.json: /ambient: expected a color: a number or [red, green, blue], each from 0 to 1e30, found an array of 2");
    EXPECT_WRONG(scene_with("\"ambient\": -1"),
                 "a.json: /ambient: expected a color: a number or [red, green, blue], each from 0 to 1e30, found -1");
    EXPECT_WRONG(scene_with("\"ambient\": [1, -2, 1]"),
                 "a.json: /ambient/1: expected a number from 0 to 1e30, found -2");
    EXPECT_WRONG(scene_with("\"ambient\": [1, 1, \"x\"]"),
                 "a.json: /ambient/2: expected a number from 0 to 1e30, found 'x'");
    EXPECT_FALSE(std::signbit(scene_with("\"background\": -0.0").background.x));
}

TEST(SceneCamera, FixedAndOnPaths) {
    const CameraDescription fixed =
        scene_with(R"("camera": {"position": [1, 2, 3], "target": [4, 5, 6], "up": [0, 1, 0],
        "fov": 90, "time_step": 0.5})")
            .camera;
    EXPECT_EQ(fixed.position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(fixed.target, glm::dvec3(4, 5, 6));
    EXPECT_EQ(fixed.up, glm::dvec3(0, 1, 0));
    EXPECT_EQ(fixed.field_of_view, 90);
    EXPECT_EQ(fixed.time_step, 0.5);
    EXPECT_FALSE(fixed.position_path || fixed.target_path);

    const CameraDescription moved =
        scene_with(R"("camera": {"path": {"target": {"r0": 1, "z0": 2, "phi0": 3, "Ar": 4, "Az": 5,
        "wr": 6, "wz": 7, "wphi": 8, "pr": 9, "pz": 10}}, "position": [1, 2, 3]})")
            .camera;
    EXPECT_EQ(moved.position, glm::dvec3(1, 2, 3));
    ASSERT_TRUE(moved.target_path && !moved.position_path);
    const CylindricalPath& p = *moved.target_path;
    EXPECT_EQ((std::vector{p.r0, p.z0, p.phi0, p.Ar, p.Az, p.wr, p.wz, p.wphi, p.pr, p.pz}),
              (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
}

TEST(SceneCamera, Errors) {
    EXPECT_WRONG(scene_with(R"("camera": {"fov": 0})"),
                 "a.json: /camera/fov: expected a number above 0, under 180, found 0");
    EXPECT_WRONG(scene_with(R"("camera": {"fov": 180})"),
                 "a.json: /camera/fov: expected a number above 0, under 180, found 180");
    EXPECT_WRONG(scene_with(R"("camera": {"up": [0, 0, 0]})"),
                 "a.json: /camera/up: expected a direction other than [0, 0, 0]");
    EXPECT_WRONG(scene_with(R"("camera": {"position": [1, 1, 1], "target": [1, 1, 1]})"),
                 "a.json: /camera/target: the camera's position and target coincide; move one of them");
    EXPECT_WRONG(scene_with(R"("camera": {"position": [1, 1, 1], "path": {"position": {}}})"),
                 "a.json: /camera/position: the path gives the position already; leave out one of the two");
    EXPECT_WRONG(scene_with(R"("camera": {"target": [1, 1, 1], "path": {"target": {}}})"),
                 "a.json: /camera/target: the path gives the target already; leave out one of the two");
    EXPECT_WRONG(scene_with(R"("camera": {"path": {}})"),
                 "a.json: /camera/path: expected a path for 'position', for 'target' or for both");
    EXPECT_WRONG(scene_with(R"("camera": {"path": {"position": {"R0": 1}}})"),
                 "a.json: /camera/path/position/R0: unknown key; did you mean 'r0'?");
    EXPECT_WRONG(scene_with(R"("camera": {"path": {"position": {"phi0": 1e7}}})"),
                 "a.json: /camera/path/position/phi0: expected a number from -1000000 to 1000000, found 10000000");
    EXPECT_WRONG(scene_with(R"("camera": {"position": [0, 1e31, 0]})"),
                 "a.json: /camera/position/1: expected a number from -1e30 to 1e30, found 1e31");
}

TEST(SceneTextures, FilesAndCheckers) {
    const auto textures = scene_with(R"("textures": {"z": {"file": "a.exr", "filter": "nearest", "repeat": [2, 3]},
        "a": {"checker": [0.5, [1, 0, 0]], "repeat": [5, 4]}})")
                              .textures;
    ASSERT_EQ(textures.size(), 2u);
    EXPECT_EQ(textures[0].name, "z");
    EXPECT_EQ(textures[0].file, "a.exr");
    EXPECT_FALSE(textures[0].bilinear);
    EXPECT_EQ(textures[0].repeat, glm::dvec2(2, 3));
    EXPECT_EQ(textures[1].name, "a");
    EXPECT_TRUE(textures[1].file.empty());
    EXPECT_EQ(textures[1].checker[0], glm::dvec3(0.5));
    EXPECT_EQ(textures[1].checker[1], glm::dvec3(1, 0, 0));
    EXPECT_EQ(textures[1].repeat, glm::dvec2(5, 4));
    EXPECT_FALSE(textures[1].bilinear);
    EXPECT_TRUE(scene_with(R"("textures": {"a": {"file": "a.exr", "filter": "bilinear"}})").textures[0].bilinear);
    using Wraps = std::array<TextureWrap, 2>;
    const auto wrap = [](const std::string& value) {
        return scene_with(R"("textures": {"a": {"file": "a.exr", "wrap": )" + value + "}}").textures[0].wrap;
    };
    EXPECT_EQ(textures[0].wrap, (Wraps{TextureWrap::repeat, TextureWrap::repeat}));
    EXPECT_EQ(wrap("\"clamp\""), (Wraps{TextureWrap::clamp, TextureWrap::clamp}));
    EXPECT_EQ(wrap("[\"mirror\", \"repeat\"]"), (Wraps{TextureWrap::mirror, TextureWrap::repeat}));
}

TEST(SceneTextures, Errors) {
    const auto wrong = [](const std::string& texture) { scene_with("\"textures\": {\"t\": " + texture + "}"); };
    EXPECT_WRONG(wrong("{}"), "a.json: /textures/t: expected one of the keys 'file' and 'checker'");
    EXPECT_WRONG(wrong("3"), "a.json: /textures/t: expected an object, found 3");
    EXPECT_WRONG(wrong(R"({"chequer": [0, 1]})"), "a.json: /textures/t/chequer: unknown key; did you mean 'checker'?");
    EXPECT_WRONG(wrong(R"({"file": "a", "checker": [0, 1]})"),
                 "a.json: /textures/t: expected one of 'file' and 'checker', found both");
    EXPECT_WRONG(wrong(R"({"file": ""})"),
                 "a.json: /textures/t/file: expected a string that is not empty, found an empty string");
    EXPECT_WRONG(wrong(R"({"file": "a", "filter": "linear"})"),
                 "a.json: /textures/t/filter: unknown value 'linear'; did you mean 'bilinear'?");
    EXPECT_WRONG(wrong(R"({"file": "a", "filter": 1})"),
                 "a.json: /textures/t/filter: expected one of nearest, bilinear, found 1");
    EXPECT_WRONG(wrong(R"({"file": "a", "repeat": [0, 1]})"),
                 "a.json: /textures/t/repeat/0: expected a number above 0, to 1000000, found 0");
    EXPECT_WRONG(wrong(R"({"file": "a", "repeat": 2})"),
                 "a.json: /textures/t/repeat: expected [u, v], each above 0, to 1000000, found 2");
    EXPECT_WRONG(wrong(R"({"checker": [0, 1], "filter": "nearest"})"),
                 "a.json: /textures/t/filter: unknown key; known keys: checker, repeat, wrap");
    EXPECT_WRONG(wrong(R"({"file": "a", "wrap": "mirrored"})"),
                 "a.json: /textures/t/wrap: unknown value 'mirrored'; did you mean 'mirror'?");
    EXPECT_WRONG(wrong(R"({"checker": [0, 1], "wrap": ["clamp", "border"]})"),
                 "a.json: /textures/t/wrap/1: unknown value 'border'; known values: repeat, clamp, mirror");
    EXPECT_WRONG(wrong(R"({"file": "a", "wrap": ["clamp"]})"),
                 "a.json: /textures/t/wrap: expected one of repeat, clamp, mirror, or two of them for u and v, found "
                 "an array of 1");
    for (const char* colors : {"[0]", "[0, 1, 1]"})
        EXPECT_WRONG(wrong("{\"checker\": " + std::string(colors) + "}"),
                     "a.json: /textures/t/checker: expected an array of two colors, found an array of " +
                         std::string(colors[2] == ']' ? "1" : "3"));
    EXPECT_WRONG(
        wrong(R"({"checker": [0, -1]})"),
        "a.json: /textures/t/checker/1: expected a color: a number or [red, green, blue], each from 0 to 1e30, "
        "found -1");
}

TEST(SceneMaterials, EveryKeyArrives) {
    const SceneDescription scene =
        scene_with(R"("materials": {"m": {"color": [0.1, 0.2, 0.3], "texture": "t", "ambient": 0.4,
        "diffuse": 0.5, "specular": 0.6, "specular_color": [0.7, 0.8, 0.9], "exponent": 11, "reflection": 0.12,
        "transmission": 0.13, "tint": [0.14, 0.15, 0.16], "index": 1.7, "absorption": [18, 19, 20], "fresnel": true}},
        "textures": {"s": {"checker": [0, 1]}, "t": {"checker": [0, 1]}})");
    const MaterialDescription& m = scene.materials.at(0);
    EXPECT_EQ(m.name, "m");
    EXPECT_EQ(m.color, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(m.texture, 1);
    EXPECT_EQ((std::vector{m.ambient, m.diffuse, m.specular, m.exponent, m.reflection, m.transmission, m.index}),
              (std::vector{0.4, 0.5, 0.6, 11.0, 0.12, 0.13, 1.7}));
    EXPECT_EQ(m.specular_color, glm::dvec3(0.7, 0.8, 0.9));
    EXPECT_EQ(m.tint, glm::dvec3(0.14, 0.15, 0.16));
    EXPECT_EQ(m.absorption, glm::dvec3(18, 19, 20));
    EXPECT_TRUE(m.fresnel);
}

TEST(SceneMaterials, Errors) {
    const auto wrong = [](const std::string& keys) {
        scene_with("\"textures\": {\"marble\": {\"file\": \"a\"}}, \"materials\": {\"m\": {" + keys + "}}");
    };
    const std::string m = "a.json: /materials/m";
    EXPECT_WRONG(wrong(R"("colour": 1)"), m + "/colour: unknown key; did you mean 'color'?");
    EXPECT_WRONG(wrong(R"("reflection": 0.7, "transmission": 0.4)"),
                 m + ": reflection + transmission is 1.1; expected at most 1");
    EXPECT_NO_THROW(wrong(R"("reflection": 0.7, "transmission": 0.3000005)"));
    EXPECT_WRONG(wrong(R"("reflection": 1.1)"), m + "/reflection: expected a number from 0 to 1, found 1.1");
    EXPECT_WRONG(wrong(R"("transmission": -0.1)"), m + "/transmission: expected a number from 0 to 1, found -0.1");
    EXPECT_WRONG(wrong(R"("tint": [1, 1.5, 1])"), m + "/tint/1: expected a number from 0 to 1, found 1.5");
    EXPECT_WRONG(wrong(R"("index": 0)"), m + "/index: expected a number from 0.01 to 100, found 0");
    EXPECT_WRONG(wrong(R"("exponent": 1e7)"), m + "/exponent: expected a number from 0 to 1000000, found 10000000");
    EXPECT_WRONG(wrong(R"("fresnel": 1)"), m + "/fresnel: expected true or false, found 1");
    for (const std::string key : {"ambient", "diffuse", "specular"})
        EXPECT_WRONG(wrong("\"" + key + "\": -1"), m + "/" + key + ": expected a number from 0 to 1e30, found -1");
    for (const std::string key : {"color", "specular_color", "absorption"})
        EXPECT_WRONG(wrong("\"" + key + "\": [0, 0, 1e31]"),
                     m + "/" + key + "/2: expected a number from 0 to 1e30, found 1e31");
    EXPECT_WRONG(wrong(R"("texture": "marbel")"), m + "/texture: unknown texture 'marbel'; did you mean 'marble'?");
    EXPECT_WRONG(wrong(R"("texture": 3)"), m + "/texture: expected the name of a texture, found 3");
    EXPECT_WRONG(scene_with(R"("materials": {"m": {"texture": "t"}})"),
                 m + "/texture: unknown texture 't'; there are no textures");
}

TEST(SceneLights, EveryKeyArrives) {
    const auto lights = scene_with(R"("lights": [{"position": [1, 2, 3]}, {"position": [4, 5, 6], "color": [1, 2, 3],
        "glow": 7, "radius": 0.5, "visible": false, "falloff": "inverse-square"}])")
                            .lights;
    ASSERT_EQ(lights.size(), 2u);
    EXPECT_EQ(lights[0].place, "/lights/0");
    EXPECT_FALSE(lights[0].glow || lights[0].falloff || lights[0].shown());
    EXPECT_TRUE(lights[0].visible);
    EXPECT_FALSE(lights[1].visible || lights[1].shown());
    EXPECT_EQ(lights[1].position, glm::dvec3(4, 5, 6));
    EXPECT_EQ(lights[1].color, glm::dvec3(1, 2, 3));
    EXPECT_EQ(lights[1].glow, glm::dvec3(7));
    EXPECT_EQ(lights[1].radius, 0.5);
    EXPECT_TRUE(lights[1].falloff);
}

TEST(SceneLights, Errors) {
    const auto wrong = [](const std::string& keys) { scene_with("\"lights\": [{" + keys + "}]"); };
    EXPECT_WRONG(wrong(""), "a.json: /lights/0: missing key 'position': expected [x, y, z], each from -1e30 to 1e30");
    EXPECT_WRONG(wrong(R"("position": [0, 0, 0], "falloff": "inverse-square")"),
                 "a.json: /lights/0/falloff: inverse-square needs a 'radius' above 0, within which it stays constant");
    EXPECT_WRONG(wrong(R"("position": [0, 0, 0], "falloff": "linear")"),
                 "a.json: /lights/0/falloff: unknown value 'linear'; known values: none, inverse-square");
    EXPECT_WRONG(wrong(R"("position": [0, 0, 0], "radius": -1)"),
                 "a.json: /lights/0/radius: expected a number from 0 to 1e30, found -1");
    EXPECT_WRONG(wrong(R"("position": [0, 0, 0], "glow": [1, 1, -1])"),
                 "a.json: /lights/0/glow/2: expected a number from 0 to 1e30, found -1");
    EXPECT_WRONG(wrong(R"("position": [0, 0])"),
                 "a.json: /lights/0/position: expected [x, y, z], each from -1e30 to 1e30, found an array of 2");
}

TEST(SceneFrame, IsPinned) {
    const auto frame = scene_with(R"("frame": {"center": [1, 2, 3], "scale": -4, "bound": 8})").frame;
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->center, glm::dvec3(1, 2, 3));
    EXPECT_EQ(frame->scale, -4);
    EXPECT_EQ(frame->bound, 8);
    EXPECT_FALSE(scene_with(R"("frame": {"center": [1, 2, 3], "scale": 0})").frame->bound);
    EXPECT_FALSE(scene_with("\"depth\": 1").frame);
    EXPECT_WRONG(scene_with(R"("frame": {"center": [0, 0, 0]})"),
                 "a.json: /frame: missing key 'scale': expected a whole number from -150 to 150");
    EXPECT_WRONG(scene_with(R"("frame": {"center": [0, 0, 0], "scale": 0, "bound": 0})"),
                 "a.json: /frame/bound: expected a number above 0, to 1e30, found 0");
}

}  // namespace
}  // namespace cistula
