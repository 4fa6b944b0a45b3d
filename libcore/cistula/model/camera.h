// The pinhole camera. Its rays are computed in double for both precisions and both sides.
#pragma once

#include "cistula/numerics/vec.h"

namespace cistula {

/// Orthonormal axes; right and up are the picture's. Row 0 is the top.
struct Camera {
    Vec3<double> position, forward, right, up;
    double tan_half_width = 1;  // tan(horizontal field of view / 2)
};

/// 1 / sqrt(square) to within 2 u of double, for squares in [2^-120, 2^120]: Newton from a single-precision start, a
/// third of the time of a square root and a division where doubles are dear.
CISTULA_INLINE double inverse_root(double square) {
    double r = double(reciprocal(square_root(float(square))));
    for (int step = 0; step < 2; ++step) r = r * fused(-0.5 * square * r, r, 1.5);
    return r;
}

/// The unit direction to the point `across` and `down` steps right of and below the picture's center. Mirrored points
/// have mirrored directions, bit for bit, as steps are whole numbers or half of them.
CISTULA_INLINE Vec3<double> camera_direction(const Camera& camera, double across, double down, double step) {
    const Vec3<double> through = along(along(camera.forward, across * step, camera.right), -down * step, camera.up);
    return through * inverse_root(dot(through, through));
}

/// The unit direction through the point (x, y) of a picture of width x height pixels; (0, 0) is its top left corner.
CISTULA_HD inline Vec3<double> camera_direction(const Camera& camera, double x, double y, int width, int height) {
    return camera_direction(camera, 2 * x - width, 2 * y - height, camera.tan_half_width / width);
}

}  // namespace cistula
