// libcore's own intersectors as tests call them: functions, so that a test with many calls compiles them once.
#pragma once

#include "cistula/traversal/bvh.h"

namespace cistula::test {

/// An intersector over a view of a scene.
template <class Real, class Inner>
struct Called {
    using Media = typename Inner::Media;
    using Scene = typename Inner::Scene;
    const Scene& scene;

    template <class E = Effects<all_effects>>
    CISTULA_NOINLINE Hit<Real> closest(const Ray<Real, Media>& ray) const {
        return Inner{scene}.template closest<E>(ray);
    }
    template <class E>
    CISTULA_NOINLINE Throughput<Real, E> transmittance(const ShadowRay<Real, Media>& shadow) const {
        return Inner{scene}.template transmittance<E>(shadow);
    }
};

template <class Real>
using Brute = Called<Real, BruteIntersector<Real>>;
template <class Real>
using Bvh = Called<Real, BvhIntersector<Real>>;

}  // namespace cistula::test
