// Axis-aligned bounding boxes in double.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include <glm/vec3.hpp>

namespace cistula {

/// The smallest axis-aligned box around the points added to it; empty before the first.
struct Box {
    glm::dvec3 low{INFINITY}, high{-INFINITY};

    void add(const glm::dvec3& p) {
        for (int axis = 0; axis < 3; ++axis) {
            if (p[axis] < low[axis]) low[axis] = p[axis];
            if (p[axis] > high[axis]) high[axis] = p[axis];
        }
    }
    void add(const Box& other) {
        if (!other.empty()) add(other.low), add(other.high);
    }
    bool empty() const { return !(low.x <= high.x); }
    std::array<glm::dvec3, 8> corners() const {
        std::array<glm::dvec3, 8> all;
        for (int i = 0; i < 8; ++i)
            all[size_t(i)] = {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
        return all;
    }
};

inline Box box_of(std::span<const glm::dvec3> points) {
    Box box;
    for (const glm::dvec3& p : points) box.add(p);
    return box;
}

}  // namespace cistula
