// What a sample met, as a number: samples with equal ones are alike but for gradual change. It is the sum of what is
// asked of an intersector, so that the order of work does not show.
#pragma once

#include "cistula/model/effects.h"
#include "cistula/transport/ray_tree.h"

namespace cistula {

/// Hash of the ray tree under way. Branches too faint to matter leave it alone.
struct PathHash {
    uint32_t value = 0;
    bool counts = true;  // whether the branch under way matters

    /// Any change of a, b or c changes all of what is added (Appleby's final mix of MurmurHash3, public domain).
    CISTULA_INLINE void add(uint32_t a, uint32_t b, uint32_t c) {
        uint32_t h = a * 0x9e3779b1u + b * 0x85ebca77u + c * 0xc2b2ae3du + 0x27d4eb2fu;
        h = (h ^ h >> 16) * 0x85ebca6bu;
        h = (h ^ h >> 13) * 0xc2b2ae35u;
        value += h ^ h >> 16;
    }
};

/// Intersector that adds to a hash the faces that are hit and what arrives from lights: of what changes gradually only
/// whether any does.
template <class Inner>
struct HashingIntersector {
    using Media = typename Inner::Media;
    using Scene = typename Inner::Scene;
    using Real = typename Scene::Scalar;
    const Inner& inner;
    PathHash& hash;
    bool gradual;  // shades_gradually

    template <class E = Effects<all_effects>>
    CISTULA_INLINE Hit<Real> closest(const Ray<Real, Media>& ray) const {
        const Hit<Real> hit = inner.template closest<E>(ray);
        // A ray from the camera that meets nothing tells no more than one that passes the scene by.
        if (hash.counts && (hit.found() || ray.from_solid != no_solid))
            hash.add(uint32_t(hit.key), uint32_t(hit.key >> 32), ray.from_solid + 31 * ray.from_face);
        return hit;
    }

    template <class E>
    CISTULA_INLINE Share<Real, E> transmittance(const ShadowRay<Real, Media>& shadow) const {
        const Share<Real, E> arrives = inner.template transmittance<E>(shadow);
        if (hash.counts) {
            const uint32_t light = uint32_t(shadow.light - inner.scene.lights.data);
            hash.add(told_apart(channel(arrives, 0)) + 3 * told_apart(channel(arrives, 1)),
                     5 * told_apart(channel(arrives, 2)), light + 0x10000u);
        }
        return arrives;
    }

  private:
    CISTULA_INLINE uint32_t told_apart(Real share) const {
        return gradual ? (share > Real(0) ? 1u : 0u) : bits_as<uint32_t>(float(share));
    }
};

/// Branches of a tree that are followed while a frame has a target. Where little is lost at every bounce and much goes
/// both ways, a tree is as good as endless: then more is dropped (take_sample).
inline constexpr uint32_t most_branches = 1u << 12;

/// Stack that tells a hash which branches matter, and ends trees that are too large.
template <class Inner, class Real>
class HashingStack {
  public:
    CISTULA_INLINE HashingStack(Inner& inner, PathHash& hash, Real significant)
        : inner_(inner), hash_(hash), significant_(significant) {}

    template <class Entry>
    CISTULA_INLINE bool push(const Entry& branch) {
        return inner_.push(branch);
    }
    template <class Entry>
    CISTULA_INLINE bool pop(Entry& branch) {
        if (followed_ == most_branches || !inner_.pop(branch)) return false;
        ++followed_;
        hash_.counts = largest_component(branch.weight) >= significant_;
        return true;
    }

    CISTULA_INLINE void clear() { inner_.clear(); }
    CISTULA_INLINE bool stopped() const { return inner_.stopped(); }

    /// Empties the stack. False if it was: the tree was followed to its end.
    CISTULA_INLINE bool drop() {
        const bool any = !inner_.empty();
        inner_.clear();
        return any;
    }

  private:
    Inner& inner_;
    PathHash& hash_;
    const Real significant_;
    uint32_t followed_ = 0;
};

}  // namespace cistula
