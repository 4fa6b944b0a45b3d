#include "scene/compile/meshes/mesh_apex.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace cistula {
namespace {

template <class Body>
void for_each_parallel(uint32_t count, const Body& body) {
    tbb::parallel_for(tbb::blocked_range<uint32_t>(0, count, 256), [&](const auto& range) {
        for (uint32_t i = range.begin(); i != range.end(); ++i) body(i);
    });
}

struct GroupBox {
    float low[3], high[3];
};

void add(GroupBox& all, const GroupBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
        all.low[axis] = min_or_second(box.low[axis], all.low[axis]);
        all.high[axis] = max_or_second(box.high[axis], all.high[axis]);
    }
}

/// Adds a node over groups [begin, end), the next, and returns its box. The groups are in the order of the builder's
/// tree, so halves are neighbors and no second build is needed.
GroupBox halve(Tree& tree, const std::vector<GroupBox>& boxes, uint32_t begin, uint32_t end) {
    constexpr GroupBox nothing{{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    const auto number = static_cast<uint32_t>(tree.nodes.size());
    GroupBox all = nothing;
    tree.nodes.emplace_back();
    const uint32_t middle = begin + (end - begin + 1) / 2;
    for (int side = 0; side < 2; ++side) {
        const uint32_t first = side ? middle : begin;
        const uint32_t last = side ? end : middle;
        int32_t child = ~static_cast<int32_t>(first);
        uint32_t count = last - first;
        GroupBox box = nothing;
        if (count > 2) {
            child = static_cast<int32_t>(tree.nodes.size());
            count = 0;
            box = halve(tree, boxes, first, last);
        } else {
            for (uint32_t i = first; i < last; ++i) add(box, boxes[i]);
        }
        TreeNode& node = tree.nodes[number];
        node.child[side] = child;
        node.count[side] = count;
        std::copy(box.low, box.low + 3, node.low[side]);
        std::copy(box.high, box.high + 3, node.high[side]);
        add(all, box);
    }
    return all;
}

}  // namespace

Groups group_triangles(const NormalizedMesh& mesh, StopSignal stop) {
    std::vector<RTCBuildPrimitive> primitives(mesh.size());
    for_each_parallel(mesh.size(), [&](uint32_t t) {
        Box box;
        for (const auto& corner : mesh.triangle(t)) box.add(corner);
        primitives[t] = padded_primitive(box, 0, t);
    });
    return group_neighbors(primitives, stop);
}

Tree group_tree(const NormalizedMesh& mesh, const Groups& groups) {
    if (groups.size() == 0) return {};
    std::vector<GroupBox> boxes(groups.size());
    for_each_parallel(groups.size(), [&](uint32_t g) {
        Box box;
        for (uint32_t i = groups.first[g]; i < groups.first[g + 1]; ++i)
            for (const auto& corner : mesh.triangle(groups.order[i])) box.add(corner);
        const RTCBuildPrimitive outward = padded_primitive(box, 0, g);
        boxes[g] = {{outward.lower_x, outward.lower_y, outward.lower_z},
                    {outward.upper_x, outward.upper_y, outward.upper_z}};
    });
    Tree tree;
    tree.nodes.reserve(groups.size() / 2 + 1);
    tree.items.resize(groups.size());
    std::iota(tree.items.begin(), tree.items.end(), 0u);
    halve(tree, boxes, 0, groups.size());
    return tree;
}

template <class Real>
void append_clusters(const NormalizedMesh& mesh, const Groups& groups, const ApexHeights& heights, uint32_t solid,
                     uint32_t first_triangle, std::vector<Cluster<Real>>& clusters) {
    const size_t first_cluster = clusters.size();
    clusters.resize(first_cluster + groups.size());
    for_each_parallel(groups.size(), [&](uint32_t g) {
        Cluster<Real>& cluster = clusters[first_cluster + g];
        cluster.solid = solid;
        cluster.count = groups.first[g + 1] - groups.first[g];
        for (uint32_t lane = 0; lane < cluster_lanes; ++lane) {
            const bool used = lane < cluster.count;
            const uint32_t triangle = groups.order[groups.first[g] + (used ? lane : 0)];
            const auto corners = mesh.triangle(triangle);
            for (int c = 0; c < 3; ++c)
                for (int axis = 0; axis < 3; ++axis)
                    cluster.corner[c][axis][lane] = static_cast<Real>(corners[used ? c : 0][axis]);
            for (int side = 0; side < 2; ++side) cluster.height[side][lane] = heights.side[side][triangle];
            cluster.triangle[lane] = first_triangle + triangle;
        }
    });
}

template void append_clusters(const NormalizedMesh&, const Groups&, const ApexHeights&, uint32_t, uint32_t,
                              std::vector<Cluster<float>>&);
template void append_clusters(const NormalizedMesh&, const Groups&, const ApexHeights&, uint32_t, uint32_t,
                              std::vector<Cluster<double>>&);

}  // namespace cistula
