// Traversal of the tree over visible lights, four boxes at a time and in no particular order, since most rays meet no
// light.
#pragma once

#include "cistula/traversal/bvh.h"

namespace cistula {

/// The minimum number of lights for a tree; fewer are all tested.
inline constexpr uint32_t fewest_in_light_tree = 9;

/// Tests a ray against a node's boxes between its limits, which are finite and not negative. The device tests from t =
/// 0 on, so it may accept more boxes.
CISTULA_INLINE void intersect_boxes(const LightNode& node, const BoxRay& box_ray, bool (&meets)[LightNode::width]) {
    constexpr int width = LightNode::width;
    float near_t[3][width], far_t[3][width];
    for (int k = 0; k < 3; ++k) {  // copies whole lanes, for wide loads
        const LightNode::Lanes center = node.center[k];
        const LightNode::Lanes half = node.half[k];
        const float inverse = magnitude(box_ray.inverse[k]);
        CISTULA_VECTORS
        for (int i = 0; i < width; ++i) {
            const float middle = box_ray.plane_t(k, center.of[i]);
            near_t[k][i] = fused(-half.of[i], inverse, middle);
            far_t[k][i] = fused(half.of[i], inverse, middle);
        }
    }
#if CISTULA_ON_DEVICE
    // Floats compare as integers here: none is NaN, and the limits are not negative. One instruction gives the maximum
    // of three integers.
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
        meets[i] = max_no_nan(max_no_nan(near_t[0][i], near_t[1][i]), max_no_nan(near_t[2][i], box_ray.near_limit)) <=
                   min_no_nan(min_no_nan(far_t[0][i], far_t[1][i]), min_no_nan(far_t[2][i], box_ray.far_limit));
#endif
}

/// The stack of a traversal; an entry is a node or ~light.
class LightStack {
  public:
    static constexpr int32_t none = INT32_MIN;
    static constexpr int32_t root = 0;
    static constexpr int capacity = (LightNode::width - 1) * (max_tree_depth + 1) + 1;
    using Storage = int32_t[capacity];

    /// Keeps the entries in `storage`, apart, so that the rest stays in registers.
    CISTULA_INLINE explicit LightStack(Storage& storage) : waiting_(storage) {}

    CISTULA_INLINE void push(int32_t item) {
        if (next_ != none) waiting_[size_++] = next_;
        next_ = item;
    }
    /// Pops the latest entry; `none` if the stack is empty.
    CISTULA_INLINE int32_t pop() {
        if (next_ == none && size_ != 0) next_ = waiting_[--size_];
        const int32_t item = next_;
        next_ = none;
        return item;
    }

  private:
    Storage& waiting_;
    int size_ = 0;
    int32_t next_ = none;  // top of the stack
};

/// Calls visit(light) for the candidates of box_ray among the entries of `stack`; visit returns the new far limit.
template <class Visit>
CISTULA_INLINE void traverse_lights(const Span<LightNode>& nodes, BoxRay box_ray, LightStack& stack,
                                    const Visit& visit) {
    // The far limit must be finite, since boxes beside which a ray runs give infinite times.
    const auto limited = [](float far_limit) { return min_or_second(far_limit, RealTraits<float>::largest); };
    box_ray.far_limit = limited(box_ray.far_limit);
    for (int32_t next = stack.pop(); next != LightStack::none; next = stack.pop()) {
        if (next < 0) {
            box_ray.far_limit = limited(visit(uint32_t(~next)));
            continue;
        }
        const LightNode& node = nodes[uint32_t(next)];
        bool meets[LightNode::width];
        intersect_boxes(node, box_ray, meets);
        const LightNode::Children children = node.children;
        for (int i = 0; i < LightNode::width; ++i)
            if (meets[i]) stack.push(children.of[i]);
    }
}

}  // namespace cistula
