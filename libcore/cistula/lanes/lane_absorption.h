// Absorption along rays in lanes: the integer sums of single rays, one lane after the other.
#pragma once

#include "cistula/lanes/lane_hit.h"
#include "cistula/shading/absorption.h"

namespace cistula {

template <class T, int n>
struct Absorption<true, Lanes<T, n>> {
    using Real = Lanes<T, n>;
    Absorption<true> of[n];

    template <class Media, class Scene>
    CISTULA_INLINE void begin(const Scene& scene, const Media& media, const Real& t, const MaskOf<Real>& who) {
        for (Absorption<true>& one : of)
            for (PathSum& sum : one.sum) sum = PathSum();
        for_each_lane(who & (t > Real(0)), [&](int lane) { of[lane].add_all(scene, media.of(lane), t[lane], -1); });
    }

    /// Records that rays pass faces at t without shading, which changes the media around them.
    template <class Media, class Scene>
    CISTULA_INLINE void change(const Scene& scene, const Media& before, const Media& beyond, const Real& t,
                               const MaskOf<Real>& who) {
        for_each_lane(who, [&](int lane) {
            const uint32_t from = before.of(lane).bits, to = beyond.of(lane).bits;
            of[lane].add_all(scene, InteriorSet{from & ~to}, t[lane], 1);
            of[lane].add_all(scene, InteriorSet{to & ~from}, t[lane], -1);
        });
    }

    template <class Media, class Scene>
    CISTULA_INLINE void dim(const Scene& scene, const Media& media, const Real& t, Vec3<Real>& weight,
                            const MaskOf<Real>& who) {
        LaneVectors<Real> weights(weight);
        for_each_lane(who, [&](int lane) {
            Vec3<T> one = weights[lane];
            of[lane].dim(scene, media.of(lane), t[lane], one);
            weights.set(lane, one);
        });
        weight = weights.all();
    }
};

}  // namespace cistula
