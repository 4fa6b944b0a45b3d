// Path hashes of samples whose rays are traced in lanes (path_hash.h).
#pragma once

#include "cistula/adaptive/path_hash.h"
#include "cistula/lanes/lane_intersector.h"

namespace cistula {

/// What branches in lanes add to the hashes of their samples.
template <class Real>
struct LanePathHash {
    using Index = IndexOf<Real>;
    using Mask = MaskOf<Real>;

    Index value = 0;
    Mask counts = true;  // where the branch counts

    CISTULA_INLINE void begin(const Mask& counted, bool any_counts) {
        value = 0;
        counts = counted & Mask(any_counts);
    }
    /// PathHash::add where `active` holds. Integers are below 2^32, in lanes of 64 bits too.
    CISTULA_INLINE void add(const Index& a, const Index& b, const Index& c, const Mask& active) {
        Index h = kept(a * of(0x9e3779b1u) + b * of(0x85ebca77u) + c * of(0xc2b2ae3du) + of(0x27d4eb2fu));
        h = kept((h ^ shifted<16>(h)) * of(0x85ebca6bu));
        h = kept((h ^ shifted<13>(h)) * of(0xc2b2ae35u));
        value += select(active, h ^ shifted<16>(h), Index(0));
    }

  private:
    using T = ScalarOf<Index>;
    CISTULA_INLINE static Index of(uint32_t a) { return Index(T(a)); }
    CISTULA_INLINE static Index kept(const Index& a) {
        if constexpr (sizeof(T) == sizeof(uint32_t))
            return a;
        else
            return a & of(0xffffffffu);
    }
    template <int bits>
    CISTULA_INLINE static Index shifted(const Index& a) {
        return (a >> bits) & of(0xffffffffu >> bits);
    }
};

/// HashingIntersector in lanes. Solids count by the scene's own numbers.
template <class Real>
struct HashingLanes {
    using Scene = typename LaneIntersector<Real>::Scene;
    using Media = typename LaneIntersector<Real>::Media;
    using Mask = MaskOf<Real>;
    using Index = IndexOf<Real>;
    using T = ScalarOf<Index>;
    const LaneIntersector<Real> inner;
    LanePathHash<Real>& hash;
    bool gradual;  // shades_gradually

    template <class E>
    CISTULA_INLINE Hit<Real> closest(const Ray<Real, Media>& ray, const Mask& active) const {
        const Hit<Real> hit = inner.template closest<E>(ray, active);
        const Mask starts_on_face = ray.from_solid != int(no_solid);
        const Mask found = hit.found();
        const Mask counts = active & hash.counts;
        if (!any(counts)) return hit;
        const Index from = select(starts_on_face, own_numbers(ray.from_solid), Index(int(no_solid)));
        const Index solid = own_numbers(key_solid(hit.key));
        const Index place = select(is_kind(hit.key, CrossingKind::sheet), solid ^ Index(0xffffff), solid);
        const Index kind = hit.key >> LaneKey::kind_bit;
        const Index miss(ScalarOf<Index>(~0u));
        hash.add(select(found, key_face(hit.key), miss), select(found, kind << 24 | place, miss),
                 from + Index(31) * ray.from_face, counts & (found | starts_on_face));
        if (!inner.scene.textures.empty())
            for_each_lane(counts & found, [&](int lane) {
                PathHash one;
                add_texel(one, inner.scene, lane_of<InteriorList>(ray, lane), lane_of(hit, lane));
                hash.value.set(lane, T(uint32_t(hash.value[lane]) + one.value));
            });
        return hit;
    }

    template <class E>
    CISTULA_INLINE Throughput<Real, E> transmittance(const ShadowRay<Real, Media>& shadow, const Mask& active) const {
        const Throughput<Real, E> arrives = inner.template transmittance<E>(shadow, active);
        const Mask counts = active & hash.counts;
        if (any(counts)) {
            const auto light = int(shadow.light - inner.scene.lights.data);
            hash.add(told_apart(channel(arrives, 0)) + Index(3) * told_apart(channel(arrives, 1)),
                     Index(5) * told_apart(channel(arrives, 2)), Index(light + 0x10000), counts);
        }
        return arrives;
    }

  private:
    CISTULA_INLINE Index own_numbers(const Index& solid) const { return entries_of(inner.scene.numbers, solid); }

    CISTULA_INLINE Index told_apart(const Real& share) const {
        if (gradual) return select(share > Real(0), Index(1), Index(0));
        LaneArray<Real> shares(share);
        LaneArray<Index> bits;
        for (int lane = 0; lane < LaneTraits<Real>::lanes; ++lane)
            bits.of[lane] = ScalarOf<Index>(bits_as<uint32_t>(float(shares.of[lane])));
        return bits.all();
    }
};

}  // namespace cistula
