// Walks the tree over seen lights, four boxes at a time, nearest or not: most rays meet none.
#pragma once

#include "cistula/bvh.h"

namespace cistula {

/// Calls visit(light) for the candidates of box_ray; visit returns the new far limit.
template <class Visit>
CISTULA_INLINE void walk_lights(const Span<LightNode>& nodes, BoxRay box_ray, const Visit& visit) {
    constexpr int width = LightNode::width;
    constexpr int32_t none = INT32_MIN;
    uint32_t first_met[3];
    for (uint32_t k = 0; k < 3; ++k) first_met[k] = 2 * k + (box_ray.inverse[k] < 0.0f ? 1 : 0);
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
            for (int k = 0; k < 3; ++k) {  // copies of whole planes: wide loads
                const LightNode::Planes first = node.planes[first_met[k]], last = node.planes[first_met[k] ^ 1u];
                CISTULA_VECTORS
                for (int i = 0; i < width; ++i) {
                    near_t[i] = greater(box_ray.meets(k, first.of[i]), near_t[i]);
                    far_t[i] = lesser(box_ray.meets(k, last.of[i]), far_t[i]);
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
