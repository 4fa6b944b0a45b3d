// A tree over primitives, walked by a register of rays at once: a node is visited if any ray may meet it.
#pragma once

#include "cistula/lanes/lanes.h"
#include "cistula/traversal/bvh.h"

namespace cistula {

/// The rays of box tests in lanes (BoxRay).
template <class Real>
struct LaneBoxRay {
    Real inverse[3], shift[3], near_limit;

    CISTULA_INLINE LaneBoxRay(const Vec3<Real>& origin, const Vec3<Real>& direction, const Real& near)
        : near_limit(near) {
        const Real least_step(ScalarOf<Real>(0x1p-60));
        for (int k = 0; k < 3; ++k) {
            const Real step = direction[k];
            inverse[k] = reciprocal(select(magnitude(step) < least_step, least_step, step));
            shift[k] = -origin[k] * inverse[k];
        }
    }

    /// The rays that enter a box up to `far`, and when.
    CISTULA_INLINE MaskOf<Real> enters(const float (&low)[3], const float (&high)[3], Real far, Real& enter) const {
        enter = near_limit;
        for (int k = 0; k < 3; ++k) {
            const Real at_low = fused(Real(low[k]), inverse[k], shift[k]),
                       at_high = fused(Real(high[k]), inverse[k], shift[k]);
            enter = max_or_second(min_or_second(at_low, at_high), enter);
            far = min_or_second(max_or_second(at_low, at_high), far);
        }
        return enter <= far;
    }
};

/// tree_far() and tree_near() in lanes; infinity stays.
template <class T, int n>
CISTULA_INLINE Lanes<T, n> tree_far(const Lanes<T, n>& t) {
    return fused(t, Lanes<T, n>(T(1) + T(tree_slack_relative)), Lanes<T, n>(T(tree_slack_absolute)));
}
template <class T, int n>
CISTULA_INLINE Lanes<T, n> tree_near(const Lanes<T, n>& t) {
    return max_or_second(fused(t, Lanes<T, n>(T(1) - T(tree_slack_relative)), Lanes<T, n>(-T(tree_slack_absolute))),
                         Lanes<T, n>(T(0)));
}

/// Calls visit(item, rays) for the items whose boxes the rays of `who` may meet up to far(), nearer boxes first.
template <class Real, class Far, class Visit>
CISTULA_INLINE void traverse_tree(const Span<TreeNode>& nodes, const Span<uint32_t>& items, const LaneBoxRay<Real>& ray,
                                  const MaskOf<Real>& who, const Far& far, const Visit& visit) {
    using Mask = MaskOf<Real>;
    struct Pending {
        Real enter;
        Mask who;
        int32_t node;
    } pending[max_tree_depth + 1];
    int depth = 0;
    if (nodes.empty()) return;
    int32_t node = 0;
    Mask rays = who;
    for (;;) {
        const TreeNode& n = nodes[uint32_t(node)];
        Real enter[2];
        Mask meets[2];
        const Real limit = far();
        for (int side = 0; side < 2; ++side)
            meets[side] = rays & ray.enters(n.low[side], n.high[side], limit, enter[side]);
        const Mask both = meets[0] & meets[1], sooner = both & (enter[1] < enter[0]);
        const int first = 2 * __builtin_popcount(sooner.bits()) > __builtin_popcount(both.bits()) ? 1 : 0;
        node = -1;
        for (const int side : {first, 1 - first}) {
            if (!any(meets[side])) continue;
            const int32_t child = n.child[side];
            if (child < 0) {
                for (uint32_t i = 0; i < n.count[side]; ++i) {
                    const Mask left = meets[side] & (enter[side] <= far());
                    if (any(left)) visit(items[uint32_t(~child) + i], left);
                }
            } else if (node < 0) {
                node = child;
                rays = meets[side];
            } else {
                pending[depth++] = {enter[side], meets[side], child};
            }
        }
        while (node < 0) {
            if (depth == 0) return;
            const Pending& next = pending[--depth];
            rays = next.who & (next.enter <= far());
            if (any(rays)) node = next.node;
        }
    }
}

}  // namespace cistula
