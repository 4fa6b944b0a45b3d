#include "scene/trees/tree_build.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/error.h"
#include "scene/trees/embree_handles.h"

namespace cistula {
namespace {

constexpr uint32_t group_size = cluster_lanes;

/// The device that all trees are built on: to open one takes longer than most trees. It lives as long as the program.
RTCDevice builder_device() {
    static const RTCDevice device = make_embree_device("").release();
    return device;
}

void* run_builder(RTCBuildArguments& arguments, RTCDevice device, StopSignal stop = {}) {
    void* root = rtcBuildBVH(&arguments);
    if (stop.is_given()) rtcGetDeviceError(device);  // that it was stopped
    stop.check();
    check_embree(device, "building a tree");
    if (!root) throw Error(ErrorKind::device, "Embree: building a tree failed");
    return root;
}

float rounded_down(double x) {
    const auto f = static_cast<float>(x);
    return f > x ? std::nextafterf(f, -INFINITY) : f;
}
float rounded_up(double x) {
    const auto f = static_cast<float>(x);
    return f < x ? std::nextafterf(f, INFINITY) : f;
}

// ---- groups

struct GroupLeaves {
    const RTCBuildPrimitive* begin;  // start of the array, which the builder partitions in place
    std::vector<uint64_t> leaves;    // first << 32 | count
    StopSignal stop;
    std::atomic<uint32_t> leaf_count{0};
};

void* group_node(RTCThreadLocalAllocator, unsigned, void* user) {
    return user;  // nodes are not kept; any non-null pointer will do
}
void group_children(void*, void**, unsigned, void*) {}
void group_bounds(void*, const RTCBounds**, unsigned, void*) {}

void* group_leaf(RTCThreadLocalAllocator, const RTCBuildPrimitive* primitives, size_t count, void* user) {
    auto& leaves = *static_cast<GroupLeaves*>(user);
    leaves.leaves[leaves.leaf_count.fetch_add(1)] = uint64_t(primitives - leaves.begin) << 32 | count;
    return user;
}

/// Throws when it is to stop, which the builder makes an error of: it does not look at what is returned.
bool group_progress(void* user, double) {
    static_cast<GroupLeaves*>(user)->stop.check();
    return true;
}

// ---- trees

struct BuildNode {
    RTCBounds bounds[2];
    BuildNode* child[2];
    uint32_t count;  // number of items; 0: not a leaf
    uint32_t items[2];
};

void* tree_node(RTCThreadLocalAllocator allocator, unsigned, void*) {
    auto* node = static_cast<BuildNode*>(rtcThreadLocalAlloc(allocator, sizeof(BuildNode), 16));
    node->count = 0;
    return node;
}
void tree_children(void* pointer, void** children, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i)
        static_cast<BuildNode*>(pointer)->child[i] = static_cast<BuildNode*>(children[i]);
}
void tree_bounds(void* pointer, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) static_cast<BuildNode*>(pointer)->bounds[i] = *bounds[i];
}
void* tree_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count, void*) {
    auto* leaf = static_cast<BuildNode*>(rtcThreadLocalAlloc(allocator, sizeof(BuildNode), 16));
    leaf->count = static_cast<uint32_t>(count);
    for (size_t i = 0; i < count; ++i) leaf->items[i] = primitives[i].primID;
    if (count == 2 && leaf->items[0] > leaf->items[1]) std::swap(leaf->items[0], leaf->items[1]);
    return leaf;
}

void set_box(TreeNode& node, int side, const RTCBounds& b) {
    const float low[3] = {b.lower_x, b.lower_y, b.lower_z};
    const float high[3] = {b.upper_x, b.upper_y, b.upper_z};
    std::copy(low, low + 3, node.low[side]);
    std::copy(high, high + 3, node.high[side]);
}

void set_leaf(Tree& tree, uint32_t node, int side, const BuildNode& leaf) {
    tree.nodes[node].child[side] = ~static_cast<int32_t>(tree.items.size());
    tree.nodes[node].count[side] = leaf.count;
    tree.items.insert(tree.items.end(), leaf.items, leaf.items + leaf.count);
}

/// Stores nodes depth first, so that a node's first child follows it.
uint32_t flatten(Tree& tree, const BuildNode& from) {
    const auto index = static_cast<uint32_t>(tree.nodes.size());
    tree.nodes.emplace_back();
    for (int side = 0; side < 2; ++side) {
        set_box(tree.nodes[index], side, from.bounds[side]);
        const BuildNode& child = *from.child[side];
        if (child.count > 0) {
            set_leaf(tree, index, side, child);
        } else {
            const uint32_t number = flatten(tree, child);
            tree.nodes[index].child[side] = static_cast<int32_t>(number);
            tree.nodes[index].count[side] = 0;
        }
    }
    return index;
}

/// A tree of a single leaf. The root needs two children: the second is an empty leaf, whose box no ray hits.
Tree single_leaf(const BuildNode& leaf, const RTCBounds& bounds) {
    Tree tree;
    tree.nodes.emplace_back();
    set_box(tree.nodes[0], 0, bounds);
    set_leaf(tree, 0, 0, leaf);
    RTCBounds nothing{};
    nothing.lower_x = nothing.lower_y = nothing.lower_z = INFINITY;
    nothing.upper_x = nothing.upper_y = nothing.upper_z = INFINITY;
    set_box(tree.nodes[0], 1, nothing);
    tree.nodes[0].child[1] = ~static_cast<int32_t>(tree.items.size());
    tree.nodes[0].count[1] = 0;
    return tree;
}

}  // namespace

RTCBuildPrimitive padded_primitive(const Box& box, double pad, uint32_t number) {
    RTCBuildPrimitive p;
    p.lower_x = rounded_down(box.low.x - pad);
    p.lower_y = rounded_down(box.low.y - pad);
    p.lower_z = rounded_down(box.low.z - pad);
    p.upper_x = rounded_up(box.high.x + pad);
    p.upper_y = rounded_up(box.high.y + pad);
    p.upper_z = rounded_up(box.high.z + pad);
    p.geomID = 0;
    p.primID = number;
    return p;
}

QueryBox::QueryBox(const Box& box) {
    for (int axis = 0; axis < 3; ++axis)
        low[axis] = rounded_up(box.low[axis]), high[axis] = rounded_down(box.high[axis]);
}

Groups group_neighbors(std::vector<RTCBuildPrimitive>& primitives, StopSignal stop) {
    Groups groups;
    if (primitives.empty()) return groups;
    if (primitives.size() <= group_size) {  // the builder makes one leaf of so few, in ten times the time
        for (const RTCBuildPrimitive& p : primitives) groups.order.push_back(p.primID);
        std::sort(groups.order.begin(), groups.order.end());
        groups.first = {0, static_cast<uint32_t>(primitives.size())};
        return groups;
    }
    GroupLeaves leaves{primitives.data(), std::vector<uint64_t>(primitives.size()), stop, {}};
    const RTCDevice device = builder_device();
    const BvhPointer bvh(rtcNewBVH(device));
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.maxDepth = max_tree_depth;
    arguments.sahBlockSize = group_size;
    arguments.minLeafSize = group_size;
    arguments.maxLeafSize = group_size;
    arguments.bvh = bvh.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = group_node;
    arguments.setNodeChildren = group_children;
    arguments.setNodeBounds = group_bounds;
    arguments.createLeaf = group_leaf;
    arguments.buildProgress = group_progress;
    arguments.userPtr = &leaves;
    run_builder(arguments, device, stop);

    // Threads finish leaves in any order; sorted by position in the array they are in tree order, neighbors together.
    leaves.leaves.resize(leaves.leaf_count);
    std::sort(leaves.leaves.begin(), leaves.leaves.end());
    groups.order.reserve(primitives.size());
    groups.first.reserve(leaves.leaves.size() + 1);
    for (const uint64_t leaf : leaves.leaves) {
        const auto begin = static_cast<size_t>(leaf >> 32);
        const auto count = static_cast<size_t>(leaf & 0xffffffffu);
        const size_t first = groups.order.size();
        groups.first.push_back(static_cast<uint32_t>(first));
        for (size_t i = 0; i < count; ++i) groups.order.push_back(primitives[begin + i].primID);
        std::sort(groups.order.begin() + static_cast<ptrdiff_t>(first), groups.order.end());
    }
    groups.first.push_back(static_cast<uint32_t>(groups.order.size()));
    return groups;
}

Tree build_tree(std::vector<RTCBuildPrimitive>& primitives, int quality) {
    if (primitives.empty()) return {};
    RTCBounds all = {INFINITY, INFINITY, INFINITY, 0, -INFINITY, -INFINITY, -INFINITY, 0};
    for (const RTCBuildPrimitive& p : primitives) {
        all.lower_x = std::min(all.lower_x, p.lower_x);
        all.lower_y = std::min(all.lower_y, p.lower_y);
        all.lower_z = std::min(all.lower_z, p.lower_z);
        all.upper_x = std::max(all.upper_x, p.upper_x);
        all.upper_y = std::max(all.upper_y, p.upper_y);
        all.upper_z = std::max(all.upper_z, p.upper_z);
    }
    const RTCDevice device = builder_device();
    const BvhPointer bvh(rtcNewBVH(device));
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = quality > 0 ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_LOW;
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = max_tree_depth;
    arguments.minLeafSize = 1;
    arguments.maxLeafSize = 2;
    arguments.bvh = bvh.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = tree_node;
    arguments.setNodeChildren = tree_children;
    arguments.setNodeBounds = tree_bounds;
    arguments.createLeaf = tree_leaf;
    const auto* root = static_cast<const BuildNode*>(run_builder(arguments, device));
    if (root->count > 0) return single_leaf(*root, all);
    Tree tree;
    tree.nodes.reserve(primitives.size());
    tree.items.reserve(primitives.size());
    flatten(tree, *root);
    return tree;
}

}  // namespace cistula
