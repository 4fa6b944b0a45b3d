// Cameras that look along `up`, and films that pass that direction.
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "scene/description/camera_path.h"
#include "scene/readers/read_scene.h"
#include "testing/support/expect_near.h"
#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

using test::expect_near;

void expect_orthonormal(const Camera& camera) {
    for (const auto& axis : {camera.forward, camera.right, camera.up}) EXPECT_NEAR(length(axis), 1, 1e-15);
    EXPECT_NEAR(dot(camera.forward, camera.right), 0, 1e-15);
    expect_near(cross(camera.right, camera.forward), camera.up);
}

CameraDescription looking(const glm::dvec3& direction, const glm::dvec3& up) {
    CameraDescription camera;
    camera.position = {0.1, -0.7, 0.3};
    camera.target = camera.position + direction;
    camera.up = up;
    return camera;
}

/// Above the origin, with r = sin(t (frame - zenith)) along a meridian that turns by `turning` a frame.
CameraDescription over_the_zenith(int zenith, double turning = 0) {
    constexpr double step = 0.3141592653589793;
    CameraDescription camera;
    camera.position_path = CylindricalPath{0, 6, 0.7, 3, 0, step, 0, turning, -step * zenith, 0};
    camera.place = "film.json: /camera/path";
    return camera;
}

std::vector<int> frames(int count) {
    std::vector<int> all(static_cast<size_t>(count));
    std::iota(all.begin(), all.end(), 0);
    return all;
}

/// The angle between the right of a frame and that of the next, in radians.
double turn(const CameraDescription& camera, int frame) {
    return std::acos(
        std::min(1.0, dot(camera_at(camera, frame).camera.right, camera_at(camera, frame + 1).camera.right)));
}

TEST(CameraUp, AStillAlongUpHasAnAxisAsItsRight) {
    const struct {
        glm::dvec3 direction, up, right;
    } cases[] = {
        {{0, 0, -6}, {0, 0, 1}, {1, 0, 0}},   // a map: north, +y, is above
        {{0, 0, 6}, {0, 0, 1}, {1, 0, 0}},    // a ceiling
        {{0, -2, 0}, {0, 3, 0}, {1, 0, 0}},   // y is up
        {{0, 0, -6}, {0, 0, -1}, {1, 0, 0}},  //
        {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}},   //
    };
    for (const auto& one : cases) {
        const Camera camera = camera_at(looking(one.direction, one.up), 3).camera;
        expect_orthonormal(camera);
        expect_near(camera.right, one.right);
    }
    expect_near(camera_at(looking({0, 0, -6}, {0, 0, 1}), 0).camera.up, {0, 1, 0});
    const Camera oblique = camera_at(looking({-3, -1, -2}, {3, 1, 2}), 0).camera;
    expect_orthonormal(oblique);
    EXPECT_GT(oblique.right.y, 0.9);
}

TEST(CameraUp, OnlyWhatRoundingDoesNotTellApartIsAlongUp) {
    CameraDescription camera = looking({0, 0, -6}, {0, 0, 1});
    camera.position = {0, 0, 6};
    for (const double beside : {1e-3, 1e-9, 1e-12}) {
        camera.target = {0, beside, 0};  // the picture's up is +y, whichever way it is off
        expect_near(camera_at(camera, 0).camera.right, {1, 0, 0});
        camera.target = {beside, 0, 0};
        expect_near(camera_at(camera, 0).camera.right, {0, -1, 0});
    }
    // From afar a direction is known less well: half an ulp of the place.
    camera.position = {1e9, 0, 1};
    camera.target = {1e9 + 0x1p-23, 0, 0};
    expect_near(camera_at(camera, 0).camera.right, {1, 0, 0}, 1e-6);
    camera.target = {1e9 + 0x1p-20, 0, 0};
    expect_near(camera_at(camera, 0).camera.right, {0, -1, 0}, 1e-6);
}

TEST(CameraUp, TheFrameAtTheZenithGoesOnWithTheOneBefore) {
    for (const double turning : {0.0, 0.02}) {
        const CameraDescription film = over_the_zenith(5, turning);
        const Camera at = camera_at(film, 5).camera;
        expect_orthonormal(at);
        EXPECT_NEAR(turn(film, 4), turning, 1e-6);
        EXPECT_NEAR(turn(film, 5), 3.14159265 - turning, 1e-6);
        EXPECT_EQ(camera_turns(film, frames(8)),
                  "film.json: /camera/path: the view passes along up and the picture turns at once: by " +
                      std::string(turning == 0 ? "180" : "179") + " degrees between frames 5 and 6");
    }
    // Before frame 0 there is nothing.
    const CameraDescription film = over_the_zenith(0);
    EXPECT_NEAR(turn(film, 0), 0, 1e-6);
    EXPECT_EQ(camera_turns(film, frames(9)), "");
}

TEST(CameraUp, AFilmThatSpinsAlongUpTurnsSmoothly) {
    CameraDescription film;
    film.position_path = CylindricalPath{0, 6, 0.5, 0, 1, 0, 0.3, 0.25, 0, 0};
    for (int frame = 0; frame < 30; ++frame) {
        const double phi = 0.5 + 0.25 * frame;
        expect_near(camera_at(film, frame).camera.up, {-std::cos(phi), -std::sin(phi), 0});
    }
    EXPECT_EQ(camera_turns(film, frames(30)), "");
    // As from just off the axis.
    CameraDescription beside = film;
    beside.position_path->r0 = 1e-9;
    for (const int frame : {0, 7})
        expect_near(camera_at(film, frame).camera.right, camera_at(beside, frame).camera.right, 1e-8);
    // A target that circles at the camera's foot.
    std::swap(film.position_path, film.target_path);
    film.position = {0, 0, 20};
    expect_near(camera_at(film, 0).camera.up, {std::cos(0.5), std::sin(0.5), 0});
}

TEST(CameraUp, AFilmThatTouchesTheZenithAndTurnsBackDoesNotTurn) {
    CameraDescription film;  // r = 2 + 2 sin(t), least at frame 6
    film.position_path = CylindricalPath{2, 5, 0.3, 2, 0, 0.25, 0, 0.05, 4.71238898038469 - 1.5, 0};
    for (int frame = 0; frame < 12; ++frame) EXPECT_NEAR(turn(film, frame), 0.05, 1e-3) << frame;
    EXPECT_EQ(camera_turns(film, frames(13)), "");
}

TEST(CameraUp, TurnsAreCountedBetweenNeighborsAlone) {
    CameraDescription film = over_the_zenith(5);
    const std::string every = camera_turns(film, frames(100));
    EXPECT_NE(every.find("between frames 5 and 6, by 180 degrees between frames 15 and 16, by 180 degrees between "
                         "frames 25 and 26, and in 7 places more"),
              std::string::npos)
        << every;
    EXPECT_EQ(camera_turns(film, {0, 5, 10, 15, 20, 6}), "");
    film.position_path->phi0 = 0;  // in the plane of x and z; up along y never meets the view
    film.up = {0, 1, 0};
    EXPECT_EQ(camera_turns(film, frames(100)), "");
}

TEST(CameraUp, ReadersSayWhereTheCameraIs) {
    const auto of = [](const std::string& text) { return read_scene_text(text, "dir/s.json", "dir").camera; };
    const CameraDescription json = of(R"({"camera": {"path": {"target": {"z0": 2, "Az": -2, "wz": 1.5707963267948966}},
        "position": [0, 0, 0]}, "objects": []})");
    samples::expect_error([&] { camera_at(json, 1); }, ExitCode::usage,
                          "dir/s.json: /camera/path: at frame 1 the camera's position and target coincide");
    EXPECT_NO_THROW(camera_at(json, 0));  // straight up
}

}  // namespace
}  // namespace cistula
