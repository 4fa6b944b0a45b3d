// Corners of a polygon that are still to be clipped, by their place in its plane.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

namespace cistula {

/// A tree of boxes over points of a plane, from which points can be removed. Up to `most_in_a_leaf` of them make one
/// leaf.
class CornerTree {
  public:
    CornerTree(std::vector<glm::dvec2> points, size_t most_in_a_leaf);

    void remove(uint32_t point);

    /// Whether `blocks(point)` holds for a point that is left, among those in boxes that `touches(low, high)`. Boxes
    /// that are one point are asked once.
    template <class Touches, class Blocks>
    bool any(const Touches& touches, const Blocks& blocks) const {
        uint32_t stack[64] = {0};
        int size = 1;
        while (size > 0) {
            const uint32_t number = stack[--size];
            const Node& node = nodes_[number];
            if (node.left == 0 || !touches(node.low, node.high)) continue;
            if (node.low == node.high) {
                if (blocks(order_[node.first])) return true;
            } else if (2 * number + 1 < nodes_.size()) {
                stack[size++] = 2 * number + 2;
                stack[size++] = 2 * number + 1;
            } else {
                for (uint32_t i = node.first; i < node.end; ++i)
                    if (!removed_[order_[i]] && blocks(order_[i])) return true;
            }
        }
        return false;
    }

  private:
    /// Children of node n are 2 n + 1 and 2 n + 2.
    struct Node {
        glm::dvec2 low, high;
        uint32_t first = 0;
        uint32_t end = 0;
        uint32_t left = 0;
    };
    void build(uint32_t number, uint32_t first, uint32_t end);

    std::vector<glm::dvec2> points_;
    std::vector<uint32_t> order_, leaf_of_;
    std::vector<bool> removed_;
    std::vector<Node> nodes_;
};

}  // namespace cistula
