// The frame of reference (NUMERICS, 1): centered, and scaled by a power of two so that coordinates stay under 2.
#pragma once

#include <array>
#include <cmath>

#include <glm/vec3.hpp>

#include "scene/scene_source.h"

namespace cistula {

struct Box {
    glm::dvec3 low{INFINITY}, high{-INFINITY};

    void add(const glm::dvec3& p) {
        for (int axis = 0; axis < 3; ++axis) {
            if (p[axis] < low[axis]) low[axis] = p[axis];
            if (p[axis] > high[axis]) high[axis] = p[axis];
        }
    }
    bool empty() const { return !(low.x <= high.x); }
    std::array<glm::dvec3, 8> corners() const {
        std::array<glm::dvec3, 8> all;
        for (int i = 0; i < 8; ++i)
            all[size_t(i)] = {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
        return all;
    }
};

struct Frame {
    glm::dvec3 center{0};
    int scale = 0;
    double factor = 1;  // 2^scale
    double extent = 1;  // M

    glm::dvec3 point(const glm::dvec3& world) const { return (world - center) * factor; }
};

/// M lies in [1, 2) unless the description pins the frame; then it is what results, and 2 or more is an error.
Frame find_frame(const SceneSource& source);

/// A solid's corners in scene units.
std::vector<glm::dvec3> world_vertices(const SolidObject& solid);

}  // namespace cistula
