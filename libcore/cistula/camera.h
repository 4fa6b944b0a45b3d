// The pinhole camera. Its rays are computed in double for both precisions and both sides.
#pragma once

#include "cistula/vec.h"

namespace cistula {

/// Orthonormal axes; right and up are the picture's. Row 0 is the top.
struct Camera {
    Vec3<double> position, forward, right, up;
    double tan_half_width = 1;  // tan(horizontal field of view / 2)
};

/// The unit direction through the point (x, y) of a picture of width x height pixels; (0, 0) is its top left corner.
CISTULA_HD inline Vec3<double> camera_direction(const Camera& camera, double x, double y, int width, int height) {
    // Exact numerators: mirrored points have mirrored directions, bit for bit.
    const double sx = (2 * x - width) / width * camera.tan_half_width;
    const double sy = (height - 2 * y) / width * camera.tan_half_width;
    return normalized(camera.forward + sx * camera.right + sy * camera.up);
}

}  // namespace cistula
