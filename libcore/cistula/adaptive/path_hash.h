// A hash of what a sample's rays met: faces, texels and lights. Samples with equal hashes differ only by gradual
// changes. It is a sum over the queries to the intersector, so it does not depend on their order.
#pragma once

#include "cistula/model/effects.h"
#include "cistula/transport/ray_tree.h"

namespace cistula {

/// The hash of the ray tree that is being traced. Branches of negligible throughput do not count.
struct PathHash {
    uint32_t value = 0;
    bool counts = true;  // whether the current branch counts

    /// Adds a term of which any change of a, b or c changes all bits (Appleby's final mix of MurmurHash3, public
    /// domain).
    CISTULA_INLINE void add(uint32_t a, uint32_t b, uint32_t c) {
        uint32_t h = a * 0x9e3779b1u + b * 0x85ebca77u + c * 0xc2b2ae3du + 0x27d4eb2fu;
        h = (h ^ h >> 16) * 0x85ebca6bu;
        h = (h ^ h >> 13) * 0xc2b2ae35u;
        value += h ^ h >> 16;
    }
};

/// Adds the texel at a hit to a hash.
template <class Scene, class Real, class Media>
CISTULA_INLINE void add_texel(PathHash& hash, const Scene& scene, const Ray<Real, Media>& ray, const Hit<Real>& hit) {
    const Solid& solid = scene.solids[key_solid(hit.key)];
    const int32_t texture = scene.materials[solid.material].texture;
    if (texture < 0) return;
    const Texture& of = scene.textures[uint32_t(texture)];
    const Vec3<Real> normal = is_ball(solid) ? normal_at(scene, ray, hit) : Vec3<Real>(Real(0));
    const Vec2<Real> texel = first_texel(of, texture_uv(scene, hit, normal));
    hash.add(bits_as<uint32_t>(float(texel.x)), bits_as<uint32_t>(float(texel.y)), solid.material);
}

/// A solid's number, and a key, in the scene as it was compiled: an intersector's may number solids anew.
template <class Intersector>
CISTULA_INLINE uint32_t compiled_number(const Intersector&, uint32_t solid) {
    return solid;
}
template <class Intersector>
CISTULA_INLINE uint64_t compiled_key(const Intersector&, uint64_t key) {
    return key;
}

/// An intersector that adds the faces and texels that are hit and the transmittance toward lights to a hash; of a
/// transmittance that varies gradually only whether it is above zero.
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
        // A primary ray that hits nothing counts like one that misses the scene.
        if (hash.counts && (hit.found() || ray.from_solid != no_solid)) {
            const uint64_t key = compiled_key(inner, hit.key);
            hash.add(uint32_t(key), uint32_t(key >> 32), compiled_number(inner, ray.from_solid) + 31 * ray.from_face);
        }
        if (hash.counts && hit.found()) add_texel(hash, inner.scene, ray, hit);
        return hit;
    }

    template <class E>
    CISTULA_INLINE Throughput<Real, E> transmittance(const ShadowRay<Real, Media>& shadow) const {
        const Throughput<Real, E> arrives = inner.template transmittance<E>(shadow);
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

template <class Inner>
CISTULA_INLINE const Inner& unobserved(const HashingIntersector<Inner>& intersector) {
    return intersector.inner;
}

/// The maximum number of branches followed in a tree while a frame has a target. A tree that loses little light at
/// every bounce and splits often is practically endless; more of it is then dropped (take_sample).
inline constexpr uint32_t most_branches = 1u << 12;

/// A stack that tells a PathHash which branches count, and ends trees that are too large.
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

    /// Empties the stack. False if it was empty: the tree was followed to its end.
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
