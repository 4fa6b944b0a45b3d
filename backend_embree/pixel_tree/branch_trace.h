// What one branch of a ray tree asked and was answered, and how to give the answers once more.
#pragma once

#include <vector>

#include "cistula/transport/pixel.h"
#include "render/pixel_tree.h"

namespace cistula {

using BranchEffects = Effects<effect_masks[limited_mask]>;

inline FixedColor colors_of(const int64_t (&sums)[3]) {
    return {sums[0], sums[1], sums[2]};
}
inline FixedColor less(const FixedColor& a, const FixedColor& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// A snapshot of a pixel's sums.
struct Sums {
    FixedColor radiance{}, pruned{}, cut{};

    static Sums of(const PixelRecord& r) { return {colors_of(r.radiance), colors_of(r.pruned), colors_of(r.cut)}; }
};

/// All queries of one branch to its intersector and its stack, in order.
template <class Real>
struct BranchTrace {
    struct Look {
        Ray<Real> ray;
        Hit<Real> hit;
    };
    struct Shadow {
        ShadowRay<Real> shadow;
        Vec3<Real> arrives;
        FixedColor before;  // radiance sum before the query
    };
    struct Push {
        Branch<Real> branch;
        bool fits;
    };
    std::vector<Look> looks;
    std::vector<Shadow> shadows;
    std::vector<Push> pushed;
    Vec3<Real> weight{Real(1)};
    Sums begin, end;
    uint32_t flags = 0;
    double start = 0;  // primary rays: distance of the origin from the camera
};

/// An intersector that replays the recorded hits in their order.
template <class Real>
struct ReplayedIntersector {
    const std::vector<typename BranchTrace<Real>::Look>& looks;
    size_t& next;

    Hit<Real> closest(const Ray<Real>&) const { return next < looks.size() ? looks[next++].hit : Hit<Real>(); }
};

/// An intersector that replays the recorded shadow rays in their order; `agrees` becomes false if other ones are
/// queried.
template <class Real, class Intersector>
struct ReplayedShadows {
    const std::vector<typename BranchTrace<Real>::Shadow>& shadows;
    size_t& next;
    bool& agrees;
    const Intersector& intersector;

    Hit<Real> closest(const Ray<Real>& ray) const { return intersector.closest(ray); }
    template <class E>
    Vec3<Real> transmittance(const ShadowRay<Real>& shadow) const {
        if (next == shadows.size() || shadows[next].shadow.light != shadow.light) {
            agrees = false;
            return Vec3<Real>(Real(0));
        }
        return shadows[next++].arrives;
    }
};

/// A sink for radiance that was added before.
struct DiscardedSums {
    template <class... Parts>
    void add(const Parts&...) const {}
    template <class... Parts>
    void add_light(const Parts&...) const {}
};

}  // namespace cistula
