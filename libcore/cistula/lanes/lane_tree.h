// A tree over primitives, walked by a register of rays at once: a node is visited if any ray may meet it.
#pragma once

#include "cistula/lanes/lanes.h"
#include "cistula/traversal/bvh.h"

namespace cistula {

/// The rays of tests of a node's two boxes in lanes (BoxRay). Bits of its results are those of the rays, for the first
/// box and then for the second.
template <class Real>
class LaneBoxRay {
  public:
    /// When rays enter the boxes.
    struct Entered {
        Real of[2];
    };

    CISTULA_INLINE LaneBoxRay(const Vec3<Real>& origin, const Vec3<Real>& direction, const Real& near)
        : near_limit_(near) {
        const Real least_step(ScalarOf<Real>(0x1p-60));
        for (int k = 0; k < 3; ++k) {
            const Real step = direction[k];
            inverse_[k] = reciprocal(select(magnitude(step) < least_step, least_step, step));
            shift_[k] = -origin[k] * inverse_[k];
        }
    }

    /// The rays that enter the boxes up to `far`.
    CISTULA_INLINE uint32_t enters(const TreeNode& node, const Real& far, Entered& entered) const {
        return enters(node, 0, far, entered) | enters(node, 1, far, entered) << LaneTraits<Real>::lanes;
    }
    /// The rays that enter one of the boxes up to `far`.
    CISTULA_INLINE static uint32_t reach(const Entered& entered, int box, const Real& far) {
        return (entered.of[box] <= far).bits();
    }
    /// Whether most of some rays enter the second box first.
    CISTULA_INLINE static bool takes_second(const Entered& entered, uint32_t rays) {
        const uint32_t sooner = (entered.of[1] < entered.of[0]).bits() & rays;
        return 2 * __builtin_popcount(sooner) > __builtin_popcount(rays);
    }

  private:
    CISTULA_INLINE uint32_t enters(const TreeNode& node, int box, Real far, Entered& entered) const {
        Real& enter = entered.of[box];
        enter = near_limit_;
        for (int k = 0; k < 3; ++k) {
            const Real at_low = fused(Real(node.low[box][k]), inverse_[k], shift_[k]);
            const Real at_high = fused(Real(node.high[box][k]), inverse_[k], shift_[k]);
            enter = max_or_second(min_or_second(at_low, at_high), enter);
            far = min_or_second(max_or_second(at_low, at_high), far);
        }
        return (enter <= far).bits();
    }

    Real inverse_[3], shift_[3], near_limit_;
};

/// Rays of double, of which a register holds half as many: both boxes are tested at once in float, as those of single
/// rays are.
template <int n>
class LaneBoxRay<Lanes<double, n>> {
  public:
    using Real = Lanes<double, n>;
    using Both = Lanes<float, 2 * n>;
    struct Entered {
        Both both;
    };

    CISTULA_INLINE LaneBoxRay(const Vec3<Real>& origin, const Vec3<Real>& direction, const Real& near)
        : near_limit_(twice(near)) {
        const Both least_step(0x1p-60f);
        for (int k = 0; k < 3; ++k) {
            const Both step = twice(direction[k]);
            inverse_[k] = reciprocal(select(magnitude(step) < least_step, least_step, step));
            shift_[k] = -twice(origin[k]) * inverse_[k];
        }
    }

    CISTULA_INLINE uint32_t enters(const TreeNode& node, const Real& far, Entered& entered) const {
        Both enter = near_limit_;
        Both leave = twice(far);
        for (int k = 0; k < 3; ++k) {
            const Both at_low = fused(of_both(node.low[0][k], node.low[1][k]), inverse_[k], shift_[k]);
            const Both at_high = fused(of_both(node.high[0][k], node.high[1][k]), inverse_[k], shift_[k]);
            enter = max_or_second(min_or_second(at_low, at_high), enter);
            leave = min_or_second(max_or_second(at_low, at_high), leave);
        }
        entered.both = enter;
        return (enter <= leave).bits();
    }
    CISTULA_INLINE static uint32_t reach(const Entered& entered, int box, const Real& far) {
        return (entered.both <= twice(far)).bits() >> box * n;
    }
    /// Whether the first of some rays enters the second box first.
    CISTULA_INLINE static bool takes_second(const Entered& entered, uint32_t rays) {
        if (rays == 0) return false;
        const LaneArray<Both> times(entered.both);
        const uint32_t first = lowest_bit(rays);
        return times.of[first + n] < times.of[first];
    }

  private:
    CISTULA_INLINE static Both twice(const Real& a) { return Both(Lanes<double, 2 * n>(a, a)); }
    CISTULA_INLINE static Both of_both(float first, float second) {
        constexpr uint32_t half = (1u << n) - 1u;
        return select(LaneMask<4, 2 * n>::of_bits(half), Both(first), Both(second));
    }

    Both inverse_[3], shift_[3], near_limit_;
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

/// Calls visit(item, rays) for the items whose boxes the rays of `active` may meet up to far(), nearer boxes first.
template <class Real, class Far, class Visit>
CISTULA_INLINE void traverse_tree(const Span<TreeNode>& nodes, const Span<uint32_t>& items, const LaneBoxRay<Real>& ray,
                                  const MaskOf<Real>& active, const Far& far, const Visit& visit) {
    using Mask = MaskOf<Real>;
    using Boxes = LaneBoxRay<Real>;
    constexpr int lanes = LaneTraits<Real>::lanes;
    struct Pending {
        typename Boxes::Entered entered;
        uint32_t rays;
        int32_t node;
        int box;
    } pending[max_tree_depth + 1];
    int depth = 0;
    if (nodes.empty()) return;
    int32_t node = 0;
    uint32_t rays = active.bits();
    for (;;) {
        const TreeNode& n = nodes[uint32_t(node)];
        typename Boxes::Entered entered;
        const uint32_t hits = ray.enters(n, far(), entered);
        const uint32_t meets[2] = {hits & rays, hits >> lanes & rays};
        const int first = Boxes::takes_second(entered, meets[0] & meets[1]) ? 1 : 0;
        node = -1;
        for (const int box : {first, 1 - first}) {
            if (meets[box] == 0) continue;
            const int32_t child = n.child[box];
            if (child < 0) {
                for (uint32_t i = 0; i < n.count[box]; ++i) {
                    const uint32_t left = meets[box] & Boxes::reach(entered, box, far());
                    if (left != 0) visit(items[uint32_t(~child) + i], Mask::of_bits(left));
                }
            } else if (node < 0) {
                node = child;
                rays = meets[box];
            } else {
                pending[depth++] = {entered, meets[box], child, box};
            }
        }
        while (node < 0) {
            if (depth == 0) return;
            const Pending& next = pending[--depth];
            rays = next.rays & Boxes::reach(next.entered, next.box, far());
            if (rays != 0) node = next.node;
        }
    }
}

}  // namespace cistula
