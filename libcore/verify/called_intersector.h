// The host's intersectors as cases call them. Nothing of them is compiled into a case, so a case is compiled once for
// all.
#pragma once

#include "cistula/traversal/bvh.h"

namespace cistula::verify {

/// Effects of the shadow rays that cases send: all, and those of opaque bodies.
using AllEffects = Effects<all_effects>;
using OpaqueEffects = Effects<opaque_bodies | effect_lights_on_faces>;

/// An intersector of the host. One without `transmittance` must not be asked for it.
template <class Real>
class CalledIntersector {
  public:
    using Media = InteriorList;
    using Scene = SceneView<Real>;

    template <class Intersector>
    explicit CalledIntersector(const Intersector& intersector) : intersector_(&intersector) {
        closest_ = [](const void* i, const Ray<Real>& ray) { return static_cast<const Intersector*>(i)->closest(ray); };
        if constexpr (requires(const ShadowRay<Real>& ray) { intersector.template transmittance<AllEffects>(ray); }) {
            all_ = &transmittance_of<Intersector, AllEffects>;
            opaque_ = &transmittance_of<Intersector, OpaqueEffects>;
        }
    }

    Hit<Real> closest(const Ray<Real>& ray) const { return closest_(intersector_, ray); }
    template <class E>
    Throughput<Real, E> transmittance(const ShadowRay<Real>& shadow) const {
        if constexpr (E::mask == AllEffects::mask) {
            return all_(intersector_, shadow);
        } else {
            static_assert(E::mask == OpaqueEffects::mask, "cases ask for these two alone");
            return opaque_(intersector_, shadow);
        }
    }

  private:
    template <class Intersector, class E>
    static Throughput<Real, E> transmittance_of(const void* i, const ShadowRay<Real>& shadow) {
        return static_cast<const Intersector*>(i)->template transmittance<E>(shadow);
    }

    const void* intersector_;
    Hit<Real> (*closest_)(const void*, const Ray<Real>&);
    Throughput<Real, AllEffects> (*all_)(const void*, const ShadowRay<Real>&) = nullptr;
    Throughput<Real, OpaqueEffects> (*opaque_)(const void*, const ShadowRay<Real>&) = nullptr;
};

}  // namespace cistula::verify
