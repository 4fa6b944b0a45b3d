// Convex bodies around the visible parts of a scene.
#pragma once

#include <vector>

#include "cistula/numerics/vec.h"

namespace cistula {

/// All points within distance `reach` of the convex hull of `points`, in the frame of reference.
struct Hull {
    std::vector<Vec3<double>> points;
    double reach = 0;
};

}  // namespace cistula
