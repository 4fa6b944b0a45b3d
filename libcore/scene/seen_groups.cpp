#include "scene/seen_groups.h"

#include <algorithm>
#include <cmath>

#include "cistula/real.h"
#include "scene/tree_build.h"

namespace cistula {
namespace {

using glm::dvec3;

/// So few are tried one after the other.
constexpr uint32_t fewest_in_tree = 9;

template <class Real>
Box box_of(const SeenLight<Real>& light) {
    const dvec3 center(light.center), radius{static_cast<double>(light.radius)};
    return {center - radius, center + radius};
}

float rounded_up_to_float(double x) {
    const auto f = static_cast<float>(x);
    return f < x ? std::nextafter(f, RealTraits<float>::infinity) : f;
}

/// The sphere around them, and how far from an edge they reach. Padded: more than rounding needs (passes_by, near_edges).
template <class Real>
void bound(const CompiledScene<Real>& scene, SeenGroup& group) {
    Box box;
    for (uint32_t i = 0; i < group.count; ++i) {
        const Box light = box_of(scene.seen_lights[group.first + i]);
        box.add(light.low);
        box.add(light.high);
    }
    group.center = Vec3<float>((box.low + box.high) * 0.5);
    double reach = 0, farthest = 0;
    for (uint32_t i = 0; i < group.count; ++i) {
        const SeenLight<Real>& light = scene.seen_lights[group.first + i];
        const auto radius = static_cast<double>(light.radius);
        reach = std::max(reach, radius);
        farthest = std::max(farthest, length(dvec3(light.center) - dvec3(group.center)) + radius);
    }
    group.padded_square = rounded_up_to_float(farthest * farthest) + sphere_padding;
    group.reach = rounded_up_to_float(reach * (1 + 0x1p-10) + 0x1p-16 * static_cast<double>(scene.extent));
}

template <class Real>
void add_tree(CompiledScene<Real>& scene, SeenGroup& group) {
    std::vector<RTCBuildPrimitive> primitives;
    for (uint32_t i = 0; i < group.count; ++i)
        primitives.push_back(padded_primitive(box_of(scene.seen_lights[group.first + i]),
                                              0x1p-18 * static_cast<double>(scene.extent), i));
    const Tree tree = build_tree(primitives, 1);
    const auto nodes = static_cast<int32_t>(scene.seen_tree.size()), items = static_cast<int32_t>(scene.seen_items.size());
    group.root = nodes;
    for (TreeNode node : tree.nodes) {
        for (int32_t& child : node.child) child = child >= 0 ? child + nodes : ~(~child + items);
        scene.seen_tree.push_back(node);
    }
    for (const uint32_t item : tree.items) scene.seen_items.push_back(group.first + item);
}

}  // namespace

template <class Real>
void group_seen_lights(CompiledScene<Real>& scene, const std::vector<uint32_t>& edges) {
    const auto count = static_cast<uint32_t>(scene.seen_lights.size());
    std::vector<SeenGroup> groups;
    for (uint32_t i = 0; i < count; ++i) {
        if (groups.empty() || groups.back().solid != edges[i]) groups.push_back({.solid = edges[i], .first = i});
        ++groups.back().count;
    }
    if (groups.size() > most_seen_groups) groups = {{.first = 0, .count = count}};
    for (SeenGroup& group : groups) {
        bound(scene, group);
        if (group.count >= fewest_in_tree) add_tree(scene, group);
    }
    scene.seen_groups = std::move(groups);
}

template void group_seen_lights<float>(CompiledScene<float>&, const std::vector<uint32_t>&);
template void group_seen_lights<double>(CompiledScene<double>&, const std::vector<uint32_t>&);

}  // namespace cistula
