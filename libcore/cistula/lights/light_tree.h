// Walks the tree over seen lights, four boxes at a time, nearest or not: most rays meet none.
#pragma once

#include "cistula/traversal/bvh.h"

namespace cistula {

/// Fewer lights than these have no tree: a walk looks at all of them.
inline constexpr uint32_t fewest_in_light_tree = 9;

/// Which boxes a line meets between its limits, which are finite and not negative. Devices ask from 0 on: some more,
/// perhaps.
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
    // None is NaN: as integers they compare alike but for two that are negative, and the limits are not. Of integers
    // one instruction tells the greatest of three.
    for (int i = 0; i < width; ++i) {
        const int near_bits =
            __vimax3_s32_relu(__float_as_int(near_t[0][i]), __float_as_int(near_t[1][i]), __float_as_int(near_t[2][i]));
        const int far_bits =
            __vimin3_s32(__float_as_int(far_t[0][i]), __float_as_int(far_t[1][i]), __float_as_int(far_t[2][i]));
        meets[i] = near_bits <= min(far_bits, __float_as_int(box_ray.far_limit));
    }
#else
    CISTULA_VECTORS
    for (int i = 0; i < width; ++i)
        meets[i] = greater(greater(near_t[0][i], near_t[1][i]), greater(near_t[2][i], box_ray.near_limit)) <=
                   lesser(lesser(far_t[0][i], far_t[1][i]), lesser(far_t[2][i], box_ray.far_limit));
#endif
}

/// What a walk has yet to look at, the latest first: nodes, or ~light.
class LightStack {
  public:
    static constexpr int32_t none = INT32_MIN, root = 0;
    static constexpr int capacity = (LightNode::width - 1) * (max_tree_depth + 1) + 1;
    using Room = int32_t[capacity];

    /// The room apart, so that the rest stays in registers.
    CISTULA_INLINE explicit LightStack(Room& room) : waiting_(room) {}

    CISTULA_INLINE void push(int32_t item) {
        if (next_ != none) waiting_[size_++] = next_;
        next_ = item;
    }
    /// The latest; none where there is nothing.
    CISTULA_INLINE int32_t pop() {
        if (next_ == none && size_ != 0) next_ = waiting_[--size_];
        const int32_t item = next_;
        next_ = none;
        return item;
    }

  private:
    Room& waiting_;
    int size_ = 0;
    int32_t next_ = none;  // what was pushed last, if it was not popped
};

/// Calls visit(light) for the candidates of box_ray among what `stack` holds; visit returns the new far limit.
template <class Visit>
CISTULA_INLINE void walk_lights(const Span<LightNode>& nodes, BoxRay box_ray, LightStack& stack, const Visit& visit) {
    // Finite, as least and greatest of boxes beside which a line runs are not.
    const auto limited = [](float far_limit) { return least(far_limit, RealTraits<float>::largest); };
    box_ray.far_limit = limited(box_ray.far_limit);
    for (int32_t next = stack.pop(); next != LightStack::none; next = stack.pop()) {
        if (next < 0) {
            box_ray.far_limit = limited(visit(uint32_t(~next)));
            continue;
        }
        const LightNode& node = nodes[uint32_t(next)];
        bool meets[LightNode::width];
        meet_boxes(node, box_ray, meets);
        const LightNode::Children children = node.children;
        for (int i = 0; i < LightNode::width; ++i)
            if (meets[i]) stack.push(children.of[i]);
    }
}

}  // namespace cistula
