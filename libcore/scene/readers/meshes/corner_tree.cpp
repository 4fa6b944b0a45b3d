#include "scene/readers/meshes/corner_tree.h"

#include <algorithm>
#include <numeric>

#include <glm/common.hpp>

namespace cistula {

CornerTree::CornerTree(std::vector<glm::dvec2> points, size_t most_in_a_leaf)
    : points_(std::move(points)), order_(points_.size()), leaf_of_(points_.size()), removed_(points_.size(), false) {
    size_t leaves = 1;
    while (leaves * most_in_a_leaf < points_.size()) leaves *= 2;
    nodes_.resize(2 * leaves - 1);
    std::iota(order_.begin(), order_.end(), 0);
    build(0, 0, static_cast<uint32_t>(points_.size()));
}

void CornerTree::build(uint32_t number, uint32_t first, uint32_t end) {
    Node& node = nodes_[number];
    node.first = first;
    node.end = end;
    node.left = end - first;
    if (first == end) return;
    node.low = node.high = points_[order_[first]];
    for (uint32_t i = first; i < end; ++i) {
        node.low = glm::min(node.low, points_[order_[i]]);
        node.high = glm::max(node.high, points_[order_[i]]);
    }
    if (2 * number + 1 >= nodes_.size()) {
        for (uint32_t i = first; i < end; ++i) leaf_of_[order_[i]] = number;
        return;
    }
    const glm::dvec2 size = node.high - node.low;
    const int axis = size.y > size.x ? 1 : 0;
    const uint32_t middle = first + (end - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + end,
                     [&](uint32_t a, uint32_t b) {
                         return points_[a][axis] != points_[b][axis] ? points_[a][axis] < points_[b][axis] : a < b;
                     });
    build(2 * number + 1, first, middle);
    build(2 * number + 2, middle, end);
}

void CornerTree::remove(uint32_t point) {
    removed_[point] = true;
    for (uint32_t number = leaf_of_[point] + 1; number > 0; number /= 2) --nodes_[number - 1].left;
}

}  // namespace cistula
