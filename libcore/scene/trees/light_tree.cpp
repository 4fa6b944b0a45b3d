#include "scene/trees/tree_build.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cistula {
namespace {

/// A child of a binary node: another node, or `count` items from ~child on.
struct Part {
    float low[3], high[3];
    int32_t child;
    uint32_t count;

    bool is_light() const { return child < 0 && count == 1; }
    float half_area() const {
        const float x = high[0] - low[0];
        const float y = high[1] - low[1];
        const float z = high[2] - low[2];
        return x * y + y * z + z * x;
    }
};

Part side_of(const TreeNode& node, int side) {
    Part part{{}, {}, node.child[side], node.count[side]};
    std::copy_n(node.low[side], 3, part.low);
    std::copy_n(node.high[side], 3, part.high);
    return part;
}

class Widening {
  public:
    explicit Widening(const Tree& binary) : binary_(binary) {}

    /// Both children of a part that is not a single light.
    std::pair<Part, Part> halves(const Part& part) const {
        if (part.child >= 0) {
            const TreeNode& node = binary_.nodes[static_cast<size_t>(part.child)];
            return {side_of(node, 0), side_of(node, 1)};
        }
        Part first = part;
        Part rest = part;
        first.count = 1;
        --rest.child;  // the next item
        --rest.count;
        return {first, rest};
    }

    /// Adds a wide node. Its largest parts, which most rays enter, are opened first.
    uint32_t add(const Part& top) {
        std::vector<Part> parts{top};
        while (parts.size() < LightNode::width) {
            const auto next = std::max_element(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
                return (a.is_light() ? -1 : a.half_area()) < (b.is_light() ? -1 : b.half_area());
            });
            if (next->is_light()) break;
            auto [first, rest] = halves(*next);
            *next = first;
            if (rest.child >= 0 || rest.count > 0) parts.push_back(rest);
        }
        const auto index = static_cast<uint32_t>(nodes.size());
        nodes.emplace_back();
        for (size_t i = 0; i < LightNode::width; ++i) {
            const bool is_there = i < parts.size();
            for (int k = 0; k < 3; ++k) {
                const float center = is_there ? (parts[i].low[k] + parts[i].high[k]) / 2 : 0;
                nodes[index].center[k].of[i] = center;
                const float half = is_there ? std::max(parts[i].high[k] - center, center - parts[i].low[k]) : -INFINITY;
                nodes[index].half[k].of[i] =
                    is_there ? std::nextafter(half, INFINITY) : half;  // a margin for the rounding of half
            }
            nodes[index].children.of[i] = 0;
        }
        for (size_t i = 0; i < parts.size(); ++i) {
            const Part& part = parts[i];
            const int32_t child = part.is_light()
                                      ? ~static_cast<int32_t>(binary_.items[~static_cast<uint32_t>(part.child)])
                                      : static_cast<int32_t>(add(part));
            nodes[index].children.of[i] = child;
        }
        return index;
    }

    std::vector<LightNode> nodes;

  private:
    const Tree& binary_;
};

}  // namespace

std::vector<LightNode> light_tree(const Tree& binary) {
    if (binary.nodes.empty()) return {};
    Widening widening(binary);
    widening.add({{}, {}, 0, 0});
    return std::move(widening.nodes);
}

}  // namespace cistula
