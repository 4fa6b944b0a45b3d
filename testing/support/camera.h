// Cameras for tests of picture contents, and the pixels that are compared.
#pragma once

#include <cmath>
#include <cstring>

#include "cistula/transport/pixel.h"
#include "testing/support/scene.h"

namespace cistula::test {

inline bool same_bytes(const PixelRecord& a, const PixelRecord& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

/// A random camera: far or near, wide or narrow, inside the scene or turned away from it.
inline CameraDescription random_camera(Random& random, const CameraDescription& like) {
    constexpr double size = 5;  // size of most test scenes
    CameraDescription camera = like;
    camera.position_path.reset();
    camera.target_path.reset();
    const double distance = size * std::exp(random.between(std::log(0.01), std::log(300.0)));
    camera.position = random.in_cube(distance);
    camera.target = random.below(3) != 0 ? random.in_cube(0.5 * size) : camera.position + random.in_cube(1.0);
    camera.field_of_view =
        random.below(2) != 0 ? random.between(5, 175) : std::exp(random.between(std::log(0.5), std::log(90.0)));
    return camera;
}

/// A view from `position` along -z.
inline FrameView frame_from(const glm::dvec3& position, double tangent, int width, int height) {
    FrameView frame;
    frame.camera.position = frame.camera_sides[0].start = position;
    frame.camera.forward = {0, 0, -1};
    frame.camera.right = {1, 0, 0};
    frame.camera.up = {0, 1, 0};
    frame.camera.tan_half_width = tangent;
    frame.width = width;
    frame.height = height;
    return frame;
}

}  // namespace cistula::test
