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
        for_each_lane(who & (t > Real(0)),
                      [&](int lane) { of[lane].add_all(scene, media_of(media, lane), t[lane], -1); });
    }

    template <class Scene>
    CISTULA_INLINE void cross(const Scene& scene, const KeyOf<Real>& key, const Real& t, const MaskOf<Real>& who) {
        for_each_lane(who, [&](int lane) { of[lane].cross(scene, KeyFormat<Real>::of_lane(key, lane), t[lane]); });
    }

    template <class Media, class Scene>
    CISTULA_INLINE void dim(const Scene& scene, const Media& media, const Real& t, Vec3<Real>& weight,
                            const MaskOf<Real>& who) {
        LaneVectors<Real> weights(weight);
        for_each_lane(who, [&](int lane) {
            Vec3<T> one = weights[lane];
            of[lane].dim(scene, media_of(media, lane), t[lane], one);
            weights.set(lane, one);
        });
        weight = weights.all();
    }

  private:
    template <class Media>
    CISTULA_INLINE static SingleInterior media_of(const Media& media, int lane) {
        SingleInterior one;
        one.solid = uint32_t(media.solid[lane]);
        return one;
    }
};

}  // namespace cistula
