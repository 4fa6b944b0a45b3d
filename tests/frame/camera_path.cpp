#include "scene/description/camera_path.h"

#include <cmath>

#include <gtest/gtest.h>

#include "testing/support/expect_near.h"
#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

using samples::expect_error;
using test::expect_near;

TEST(CameraPath, AFixedCameraLooksAtItsTarget) {
    CameraDescription description;
    description.position = {0, -5, 0};
    description.target = {0, 0, 0};
    description.field_of_view = 90;
    const CameraFrame frame = camera_at(description, 7);
    EXPECT_EQ(frame.frame, 7);
    EXPECT_EQ(frame.time, 7);
    expect_near(frame.camera.position, {0, -5, 0});
    expect_near(frame.camera.forward, {0, 1, 0});
    expect_near(frame.camera.right, {1, 0, 0});
    expect_near(frame.camera.up, {0, 0, 1});
    EXPECT_NEAR(frame.camera.tan_half_width, 1, 1e-15);
}

TEST(CameraPath, AxesAreOrthonormal) {
    CameraDescription description;
    description.position = {1, 2, 3};
    description.target = {-4, 0.5, 2};
    description.up = {0.3, 0.2, 5};
    const Camera camera = camera_at(description, 0).camera;
    for (const auto& axis : {camera.forward, camera.right, camera.up}) EXPECT_NEAR(length(axis), 1, 1e-15);
    EXPECT_NEAR(dot(camera.forward, camera.right), 0, 1e-15);
    EXPECT_NEAR(dot(camera.forward, camera.up), 0, 1e-15);
    EXPECT_NEAR(dot(camera.right, camera.up), 0, 1e-15);
    EXPECT_GT(dot(camera.up, description.up), 0);
    expect_near(cross(camera.right, camera.forward), camera.up);
}

TEST(CameraPath, FollowsTheSinusoids) {
    CameraDescription description;
    CylindricalPath path{4, 2, 0.5, 1, 0.25, 2, 3, 0.1, 0.7, 0.3};
    description.position_path = path;
    description.target_path = CylindricalPath{1, 0, 0, 0.5, 0.1, 0.5, 1, 0.1, 0, 0};
    description.time_step = 0.5;
    for (const int frame : {0, 1, 17, 299}) {
        const double t = 0.5 * frame;
        const double r = 4 + std::sin(2 * t + 0.7), z = 2 + 0.25 * std::sin(3 * t + 0.3), phi = 0.5 + 0.1 * t;
        const CameraFrame result = camera_at(description, frame);
        EXPECT_EQ(result.time, t);
        const glm::dvec3 position{r * std::cos(phi), r * std::sin(phi), z};
        expect_near(result.camera.position, position, 1e-14);
        const double rn = 1 + 0.5 * std::sin(0.5 * t);
        const glm::dvec3 target{rn * std::cos(0.1 * t), rn * std::sin(0.1 * t), 0.1 * std::sin(t)};
        expect_near(result.camera.forward, normalized(target - position), 1e-14);
    }
}

TEST(CameraPath, RefusesViewsThatDefineNoPicture) {
    CameraDescription description;
    description.position = description.target = {1, 2, 3};
    description.place = "a.json: /camera/path";
    expect_error([&] { camera_at(description, 4); }, ExitCode::usage,
                 "a.json: /camera/path: at frame 4 the camera's position and target coincide");
    description.target = {2, 2, 3};
    description.up = glm::dvec3{0};
    expect_error([&] { camera_at(description, 0); }, ExitCode::usage, "up is the zero vector");
    description.up = {0, 0, 1};
    description.field_of_view = 180;
    expect_error([&] { camera_at(description, 0); }, ExitCode::usage, "field of view");
}

}  // namespace
}  // namespace cistula
