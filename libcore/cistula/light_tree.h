// Walks the tree over seen lights, four boxes at a time, nearest or not: most rays meet none.
#pragma once

#include "cistula/bvh.h"

namespace cistula {

/// Which boxes a line meets between its limits, which are finite and not negative. Devices ask from 0 on: some more, perhaps.
CISTULA_INLINE void meet_boxes(const LightNode& node, const BoxRay& box_ray, bool (&meets)[LightNode::width]) {
    constexpr int width = LightNode::width;
    float near_t[3][width], far_t[3][width];
    for (int k = 0; k < 3; ++k) {  // copies of all lanes: wide loads
        const LightNode::Lanes center = node.center[k], half = node.half[k];
        const float pace = magnitude(box_ray.inverse[k]);
        CISTULA_VECTORS
        for (int i = 0; i < width; ++i) {
            const float middle = box_ray.meets(k, center.of[i]);
            near_t[k][i] = fused(-half.of[i], pace, middle);
            far_t[k][i] = fused(half.of[i], pace, middle);
        }
    }
#if CISTULA_ON_DEVICE
    // None is NaN: as integers they compare alike but for two that are negative, and the limits are not. Of integers one
    // instruction tells the greatest of three.
    for (int i = 0; i < width; ++i) {
        const int near_bits = __vimax3_s32_relu(__float_as_int(near_t[0][i]), __float_as_int(near_t[1][i]), __float_as_int(near_t[2][i]));
        const int far_bits = __vimin3_s32(__float_as_int(far_t[0][i]), __float_as_int(far_t[1][i]), __float_as_int(far_t[2][i]));
        meets[i] = near_bits <= min(far_bits, __float_as_int(box_ray.far_limit));
    }
#else
    CISTULA_VECTORS
    for (int i = 0; i < width; ++i)
        meets[i] = greater(greater(near_t[0][i], near_t[1][i]), greater(near_t[2][i], box_ray.near_limit)) <=
                   lesser(lesser(far_t[0][i], far_t[1][i]), lesser(far_t[2][i], box_ray.far_limit));
#endif
}

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
            bool meets[width];
            meet_boxes(node, box_ray, meets);
            const LightNode::Children children = node.children;
            for (int i = 0; i < width; ++i) {
                if (!meets[i]) continue;
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
