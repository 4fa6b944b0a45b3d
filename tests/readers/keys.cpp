// Values that change from frame to frame.
#include <gtest/gtest.h>

#include "scene/description/camera_path.h"
#include "testing/support/read_text.h"
#include "testing/support/scene_dump.h"

namespace cistula {
namespace {

using test::json_scene;
using test::scene_with;

/// Scenes of one light whose position has these keys.
SceneDescription light_with(const std::string& keyed) {
    return scene_with(R"("lights": [{"position": )" + keyed + "}]");
}
double x_at(const SceneDescription& scene, int frame) {
    return at_frame(scene, frame).lights[0].position.x;
}

constexpr const char* four = R"({"keys": [[0, [0, 0, 0]], [4, [4, 0, 0]], [8, [16, 0, 0]], [16, [0, 0, 0]]])";

TEST(Keys, AreHeldBeforeAndAfterAndMetAtTheirFrames) {
    for (const char* interpolation : {"}", R"(, "interpolation": "step"})", R"(, "interpolation": "smooth"})"}) {
        const SceneDescription scene = light_with(std::string(four) + interpolation);
        EXPECT_EQ(x_at(scene, 0), 0);
        EXPECT_EQ(x_at(scene, 4), 4);
        EXPECT_EQ(x_at(scene, 8), 16);
        EXPECT_EQ(x_at(scene, 16), 0);
        EXPECT_EQ(x_at(scene, 1000), 0);
    }
    const SceneDescription late = light_with(R"({"keys": [[-3, [1, 0, 0]], [5.5, [2, 0, 0]]]})");
    EXPECT_EQ(late.motion->frames, (std::vector{-3, 5, 6}));
    EXPECT_EQ(x_at(late, 6), 2);
}

TEST(Keys, LieBetweenAsTheirInterpolationSays) {
    const SceneDescription linear = light_with(std::string(four) + "}");
    EXPECT_EQ(x_at(linear, 1), 1);
    EXPECT_EQ(x_at(linear, 6), 10);
    EXPECT_EQ(x_at(linear, 12), 8);
    const SceneDescription step = light_with(std::string(four) + R"(, "interpolation": "step"})");
    EXPECT_EQ(x_at(step, 3), 0);
    EXPECT_EQ(x_at(step, 7), 4);
    // Halfway, Catmull-Rom: the mean of the ends and an eighth of the difference of the changes there, over the
    // interval. Changes per frame: 2 at frame 4, (0 - 4) / 12 at frame 8; at the ends 1 and -2.
    const SceneDescription smooth = light_with(std::string(four) + R"(, "interpolation": "smooth"})");
    EXPECT_DOUBLE_EQ(x_at(smooth, 6), 10 + 4 * (2 + 1.0 / 3) / 8);
    EXPECT_DOUBLE_EQ(x_at(smooth, 2), 2 + 4 * (1.0 - 2) / 8);
    EXPECT_DOUBLE_EQ(x_at(smooth, 12), 8 + 8 * (-1.0 / 3 + 2) / 8);
}

TEST(Keys, ChangeEverythingThatMayChange) {
    const SceneDescription scene = json_scene(R"({
        "ambient": {"keys": [[0, 0], [10, [1, 2, 3]]]}, "background": {"keys": [[0, 0], [10, 1]]},
        "camera": {"position": {"keys": [[0, [0, -5, 0]], [10, [0, -15, 0]]]}, "fov": {"keys": [[0, 40], [10, 60]]}},
        "materials": {"a": {}, "b": {"reflection": {"keys": [[0, 0], [10, 1]]}}},
        "objects": [{"solid": "cube", "material": "a"},
            {"solid": "cube", "material": "b", "rotate": [0, 0, {"keys": [[0, 0], [10, -720]]}], "center": [4, 0, 0]},
            {"quad": [[0, 0, 0], [1, 0, 0], {"keys": [[0, [1, 1, 0]], [10, [2, 2, 0]]]}, [0, 1, 0]], "material": "a"},
            {"mesh": "m.ply", "scale": {"keys": [[0, 1], [10, 2]]}}],
        "lights": [{"position": [0, 0, 9], "color": {"keys": [[0, 0], [10, [4, 2, 0]]]}}, {"position": [0, 0, 8]}]})");
    EXPECT_EQ(scene.motion->objects, (std::vector<size_t>{1, 2, 3}));
    EXPECT_EQ(scene.motion->lights, (std::vector<size_t>{0}));
    EXPECT_EQ(scene.motion->frames, (std::vector{0, 10}));
    const SceneDescription at = at_frame(scene, 5);
    EXPECT_EQ(at.shown, 5);
    EXPECT_TRUE(at.still);
    EXPECT_EQ(at.ambient, glm::dvec3(0.5, 1, 1.5));
    EXPECT_EQ(at.background, glm::dvec3(0.5));
    EXPECT_EQ(at.materials[1].reflection, 0.5);
    EXPECT_EQ(std::get<SolidObject>(at.objects[1].shape).rotation, glm::dvec3(0, 0, -360));
    EXPECT_EQ(std::get<TrianglesObject>(at.objects[2].shape).vertices[2], glm::dvec3(1.5, 1.5, 0));
    EXPECT_EQ(std::get<MeshObject>(at.objects[3].shape).scale, 1.5);
    EXPECT_EQ(at.lights[0].color, glm::dvec3(2, 1, 0));
    EXPECT_EQ(camera_at(scene.camera, 5).camera.position, glm::dvec3(0, -10, 0));
    EXPECT_NEAR(camera_at(scene.camera, 5).camera.tan_half_width, 0.46630765815499859, 1e-15);
    EXPECT_EQ(scene_with("\"depth\": 3").motion, nullptr);
}

TEST(Keys, AFrameIsTheSceneWithItsValuesWrittenOut) {
    const auto scene = [](const std::string& center, const std::string& color) {
        return json_scene(R"({"materials": {"m": {"color": )" + color + R"(}}, "objects": [{"solid": "cube",
            "material": "m", "center": )" +
                          center + "}]}");
    };
    const SceneDescription moving = scene(R"({"keys": [[0, [0, 0, 0]], [8, [8, 4, 0]]]})",
                                          R"({"keys": [[0, 0], [8, 1]], "interpolation": "step"})");
    EXPECT_EQ(SceneDump::of(at_frame(moving, 2)), SceneDump::of(scene("[2, 1, 0]", "0")));
    EXPECT_EQ(SceneDump::of(at_frame(moving, 9)), SceneDump::of(scene("[8, 4, 0]", "1")));
}

TEST(Keys, SmoothCurvesStayInTheRange) {
    const SceneDescription scene = scene_with(
        R"("materials": {"m": {"reflection": {"keys": [[0, 0], [4, 0], [8, 1], [12, 1]], "interpolation": "smooth"}}})");
    for (int frame = 0; frame <= 12; ++frame) {
        const double reflection = at_frame(scene, frame).materials[0].reflection;
        EXPECT_TRUE(reflection >= 0 && reflection <= 1) << frame;
    }
    EXPECT_EQ(at_frame(scene, 2).materials[0].reflection, 0);
    EXPECT_EQ(at_frame(scene, 10).materials[0].reflection, 1);
}

TEST(Keys, SmoothCurvesOfOpenRangesAreHeldAtAKeyOfTheirInterval) {
    const auto with_radius = [](const std::string& keys) {
        return json_scene(
            R"({"materials": {"m": {}}, "objects": [{"solid": "sphere", "material": "m", "radius": {"keys": )" + keys +
            R"(, "interpolation": "smooth"}}]})");
    };
    const auto radius = [](const SceneDescription& scene, int frame) {
        return std::get<SphereObject>(at_frame(scene, frame).objects[0].shape).radius;
    };
    const SceneDescription stays = with_radius("[[0, 4], [10, 4], [20, 5], [30, 5]]");
    EXPECT_LT(radius(stays, 5), 4) << "an overshoot within the range is the curve's";
    EXPECT_GT(radius(stays, 5), 3.5);
    EXPECT_TRUE(stays.warnings.empty());

    const SceneDescription leaves = with_radius("[[0, 0.125], [10, 0.25], [20, 9], [30, 9]]");
    for (int frame = 0; frame <= 10; ++frame) EXPECT_GE(radius(leaves, frame), 0.125) << frame;
    EXPECT_EQ(radius(leaves, 5), 0.125);
    EXPECT_EQ(radius(leaves, 10), 0.25);
    EXPECT_GT(radius(leaves, 22), 9) << "above the larger key the range goes on";
    ASSERT_EQ(leaves.warnings.size(), 1u);
    EXPECT_EQ(leaves.warnings[0],
              "a.json: /objects/0/radius: the smooth curve leaves what is possible between frames 0 and 10, and stays "
              "at 0.125 there; add a key between them");

    const SceneDescription wide = json_scene(
        R"({"camera": {"fov": {"keys": [[0, 10], [10, 170], [20, 175], [30, 175]], "interpolation": "smooth"}},
            "objects": []})");
    for (int frame = 0; frame <= 20; ++frame) EXPECT_LE(wide.camera.at(frame).field_of_view, 175) << frame;
    EXPECT_EQ(wide.camera.at(14).field_of_view, 175);
    EXPECT_EQ(wide.warnings.size(), 1u);
}

TEST(Keys, FaultsHaveTheirPlace) {
    const std::string at = "a.json: /lights/0/position";
    EXPECT_WRONG(light_with(R"({"keys": [[0, [0, 0, 0]], [0, [1, 0, 0]]]})"),
                 at + "/keys/1/0: frame 0 stands after frame 0; the frames of keys ascend");
    EXPECT_WRONG(light_with(R"({"keys": [[0, [0, 0, 0]], [3, 1]]})"),
                 at + "/keys/1/1: expected [x, y, z], each from -1e30 to 1e30, found 1");
    EXPECT_WRONG(light_with(R"({"keys": [[0, [0, 0, 0], 3]]})"),
                 at + "/keys/0: expected a key [frame, value], found an array of 3");
    EXPECT_WRONG(light_with(R"({"keys": []})"),
                 at + "/keys: expected an array of keys [frame, value], found an empty array");
    EXPECT_WRONG(light_with(R"({"keys": [[0, [0, 0, 0]]], "interpolation": "smoth"})"),
                 at + "/interpolation: unknown value 'smoth'; did you mean 'smooth'?");
    EXPECT_WRONG(light_with(R"({"interpolation": "step"})"), at + ": missing key 'keys'");
    EXPECT_WRONG(light_with(R"({"keys": [["a", [0, 0, 0]]]})"),
                 at + "/keys/0/0: expected a number from -1000000 to 1000000, found 'a'");
    EXPECT_WRONG(scene_with(R"("materials": {"m": {"index": {"keys": [[0, 1], [4, 1000]]}}})"),
                 "a.json: /materials/m/index/keys/1/1: expected a number from 0.01 to 100, found 1000");
    EXPECT_WRONG(
        scene_with(R"("depth": {"keys": [[0, 1], [4, 2]]})"),
        "a.json: /depth: expected a whole number from 1 to 1024, found an object; keys are for numbers, points, "
        "planes and colors of the camera, lights, objects, materials and what is around");
    EXPECT_WRONG(at_frame(scene_with(R"("materials": {"m": {"transmission": 0.5,
                     "reflection": {"keys": [[0, 0], [4, 1]]}}})"),
                          3),
                 "frame 3: a.json: /materials/m: reflection + transmission is 1.25; expected at most 1");
}

}  // namespace
}  // namespace cistula
