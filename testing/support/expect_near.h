// Vectors that are nearly equal.
#pragma once

#include <gtest/gtest.h>
#include <glm/vec3.hpp>

namespace cistula::test {

/// Each component of `a` is that of `b` up to the tolerance.
inline void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-15) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance) << "axis " << axis;
}

}  // namespace cistula::test
