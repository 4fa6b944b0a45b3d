// Walks the tree over seen lights, four boxes at a time, nearest or not: most rays meet none.
#pragma once

#include "cistula/bvh.h"

namespace cistula {

/// Calls visit(light) for the candidates of box_ray; visit returns the new far limit.
template <class Visit>
CISTULA_INLINE void walk_lights(const Span<LightNode>& nodes, BoxRay box_ray, const Visit& visit) {
    constexpr int width = LightNode::width;
    constexpr int32_t none = INT32_MIN;
    // Finite, as least and greatest of boxes beside which a line runs are not.
    const auto limited = [](float far_limit) { return least(far_limit, RealTraits<float>::largest); };
    box_ray.far_limit = limited(box_ray.far_limit);
    int32_t pending[(width - 1) * (max_tree_depth + 1) + 1];
    int depth = 0;
    int32_t next = 0;
    for (;;) {
        int32_t found = none;
        if (next < 0) {
            box_ray.far_limit = limited(visit(uint32_t(~next)));
        } else {
            const LightNode& node = nodes[uint32_t(next)];
            float near_t[width], far_t[width];
            for (int i = 0; i < width; ++i) near_t[i] = box_ray.near_limit, far_t[i] = box_ray.far_limit;
            for (int k = 0; k < 3; ++k) {  // copies of all lanes: wide loads
                const LightNode::Lanes center = node.center[k], half = node.half[k];
                const float pace = magnitude(box_ray.inverse[k]);
                CISTULA_VECTORS
                for (int i = 0; i < width; ++i) {
                    const float middle = box_ray.meets(k, center.of[i]);
                    near_t[i] = greater(fused(-half.of[i], pace, middle), near_t[i]);
                    far_t[i] = lesser(fused(half.of[i], pace, middle), far_t[i]);
                }
            }
            const LightNode::Children children = node.children;
            for (int i = 0; i < width; ++i) {
                if (!(near_t[i] <= far_t[i])) continue;
                if (found != none) pending[depth++] = found;
                found = children.of[i];
            }
        }
        if (found == none) {
            if (depth == 0) return;
            found = pending[--depth];
        }
        next = found;
    }
}

}  // namespace cistula
