// The pinhole camera. Its rays are computed in double whatever the render precision, on host and device.
#pragma once

#include "cistula/numerics/vec.h"

namespace cistula {

/// A pinhole camera in the scene's frame. Its axes are orthonormal; right and up are those of the picture, and row 0 is
/// the top.
struct Camera {
    Vec3<double> position, forward, right, up;
    double tan_half_width = 1;  // tan(horizontal field of view / 2)
};

/// 1 / sqrt(square) to within 2 u of double, for squares in [2^-120, 2^120]: Newton's method from a single-precision
/// start. Takes a third of the time of a square root and a division where double precision is slow.
CISTULA_INLINE double inverse_root(double square) {
    double r = double(reciprocal(square_root(float(square))));
    for (int step = 0; step < 2; ++step) r = r * fused(-0.5 * square * r, r, 1.5);
    return r;
}

/// The unit direction to the point `across` steps right of the picture's center and `down` steps below it. Steps are
/// multiples of 1/2, so mirrored points have exactly mirrored directions.
CISTULA_INLINE Vec3<double> camera_direction(const Camera& camera, double across, double down, double step) {
    const Vec3<double> through = along(along(camera.forward, across * step, camera.right), -down * step, camera.up);
    return through * inverse_root(dot(through, through));
}

/// The unit direction through the point (x, y) of a picture of width x height pixels; (0, 0) is its top left corner.
CISTULA_HD inline Vec3<double> camera_direction(const Camera& camera, double x, double y, int width, int height) {
    return camera_direction(camera, 2 * x - width, 2 * y - height, camera.tan_half_width / width);
}

}  // namespace cistula
