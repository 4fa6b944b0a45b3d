// Bounding volume hierarchies from Embree's builder. Private to libcore/scene.
#pragma once

#include <span>
#include <vector>

#include "base/box.h"
#include "base/error.h"
#include "cistula/model/scene_view.h"
#include "scene/trees/embree_handles.h"

namespace cistula {

/// A box for Embree's builder, with its item's number: rounded outward to float and grown by `pad`.
RTCBuildPrimitive padded_primitive(const Box& box, double pad, uint32_t number);

/// Items in groups of at most eight neighbors: group g is order[first[g]] to order[first[g + 1] - 1], ascending.
struct Groups {
    std::vector<uint32_t> order, first;
    uint32_t size() const { return first.empty() ? 0 : static_cast<uint32_t>(first.size()) - 1; }
};
/// Groups of neighboring primitives, deterministic. Reorders `primitives`.
Groups group_neighbors(std::vector<RTCBuildPrimitive>& primitives, StopSignal stop = {});

struct Tree {
    std::vector<TreeNode> nodes;
    std::vector<uint32_t> items;
};
/// A binary tree whose leaves hold one or two items; item i is primitive i. At most max_tree_depth deep. quality 0:
/// quick; 1: the builder's best without splitting primitives. Reorders `primitives`.
Tree build_tree(std::vector<RTCBuildPrimitive>& primitives, int quality);

/// A box that meets the same boxes of floats as one of doubles does.
struct QueryBox {
    float low[3], high[3];

    explicit QueryBox(const Box& box);
};

/// Whether found(item) holds for an item of a leaf whose box overlaps `box`; asks no further once it does.
template <class Found>
bool any_in_box(const Tree& tree, const Box& box, const Found& found) {
    if (tree.nodes.empty()) return false;
    const QueryBox query(box);
    int32_t stack[max_tree_depth + 1] = {0};
    int size = 1;
    while (size > 0) {
        const TreeNode& node = tree.nodes[static_cast<size_t>(stack[--size])];
        for (int side = 0; side < 2; ++side) {
            bool apart = false;
            for (int axis = 0; axis < 3; ++axis)
                apart |=
                    bool(int(node.low[side][axis] > query.high[axis]) | int(node.high[side][axis] < query.low[axis]));
            if (apart) continue;
            const int32_t child = node.child[side];
            if (child >= 0) {
                stack[size++] = child;
            } else {
                for (uint32_t i = 0; i < node.count[side]; ++i)
                    if (found(tree.items[static_cast<size_t>(~child) + i])) return true;
            }
        }
    }
    return false;
}

/// Calls visit(item) for the items of all leaves whose box overlaps `box`.
template <class Visit>
void for_each_in_box(const Tree& tree, const Box& box, const Visit& visit) {
    any_in_box(tree, box, [&visit](uint32_t item) {
        visit(item);
        return false;
    });
}

/// The light tree with the nodes of `binary` collapsed; item i of `binary` is light i.
std::vector<LightNode> light_tree(const Tree& binary);

}  // namespace cistula
