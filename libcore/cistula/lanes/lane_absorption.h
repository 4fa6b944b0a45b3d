// Absorption along rays in lanes: the integer sums of single rays, one lane after the other.
#pragma once

#include "cistula/lanes/lane_hit.h"
#include "cistula/lanes/lane_transmittance.h"
#include "cistula/shading/absorption.h"

namespace cistula {

template <class T, int n>
struct Absorption<true, Lanes<T, n>> {
    using Real = Lanes<T, n>;
    using Wide = Lanes<double, n>;
    Absorption<true> of[n];  // of the lanes in `summed`
    MaskOf<Real> summed;

    template <class Media, class Scene>
    CISTULA_INLINE void begin(const Scene& scene, const Media& media, const Real& t, const MaskOf<Real>& who) {
        summed = false;
        if (scene.absorbing == 0) return;
        const MaskOf<Real> from = who & (t > Real(0)) & absorbs(scene, media);
        if (any(from)) add(scene, media, t, -1, from);
    }

    /// Records that rays pass faces at t without shading, which changes the media around them.
    template <class Media, class Scene>
    CISTULA_INLINE void change(const Scene& scene, const Media& before, const Media& beyond, const Real& t,
                               const MaskOf<Real>& who) {
        if (scene.absorbing == 0) return;
        for_each_lane(who, [&](int lane) {
            const uint32_t from = before.of(lane).bits, to = beyond.of(lane).bits;
            clear(lane);
            of[lane].add_all(scene, InteriorSet{from & ~to}, t[lane], 1);
            of[lane].add_all(scene, InteriorSet{to & ~from}, t[lane], -1);
        });
    }

    template <class Media, class Scene>
    CISTULA_INLINE void dim(const Scene& scene, const Media& media, const Real& t, Vec3<Real>& weight,
                            const MaskOf<Real>& who) {
        if (scene.absorbing == 0) return;
        const MaskOf<Real> inside = who & absorbs(scene, media);
        if (any(inside | (who & summed))) dim_inside(scene, media, t, weight, inside, who);
    }

  private:
    template <class Media, class Scene>
    CISTULA_INLINE static MaskOf<Real> absorbs(const Scene& scene, const Media& media) {
        return (media.bits & IndexOf<Real>(int(scene.absorbing))) != 0;
    }
    CISTULA_INLINE void clear(int lane) {
        if ((summed.bits() >> lane & 1u) != 0) return;
        for (PathSum& sum : of[lane].sum) sum = PathSum();
        summed |= MaskOf<Real>::of_bits(1u << lane);
    }
    template <class Media, class Scene>
    CISTULA_NOINLINE void add(const Scene& scene, const Media& media, const Real& t, int sign,
                              const MaskOf<Real>& who) {
        for_each_lane(who, [&](int lane) {
            clear(lane);
            of[lane].add_all(scene, media.of(lane), t[lane], sign);
        });
    }

    template <class Media, class Scene>
    CISTULA_NOINLINE void dim_inside(const Scene& scene, const Media& media, const Real& t, Vec3<Real>& weight,
                                     const MaskOf<Real>& inside, const MaskOf<Real>& who) {
        MaskOf<Real> single = who & summed;
        const double farthest = 4 * double(scene.extent);
        for_each_value(inside & !summed, media.bits & IndexOf<Real>(int(scene.absorbing)),
                       [&](uint32_t set, const MaskOf<Real>& same) {
                           const auto& sigma = scene.materials[scene.solids[lowest_bit(set)].material].absorption;
                           if ((set & (set - 1)) != 0 || !(double(largest_component(sigma)) * farthest < 0x1p20)) {
                               single |= same;
                               return;
                           }
                           const Wide length = clamped(Wide(t), Wide(0.0), Wide(farthest));
                           for (int c = 0; c < 3; ++c) {
                               const Wide depth = floor_of(Wide(double(sigma[c])) * length * Wide(0x1p32) + Wide(0.5));
                               const Real share = uncached_transmittance<T>(absorption_loss(depth * Wide(0x1p-32)));
                               assign_where(same, weight[c], weight[c] * share);
                           }
                       });
        if (!any(single)) return;
        LaneVectors<Real> weights(weight);
        for_each_lane(single, [&](int lane) {
            clear(lane);
            Vec3<T> one = weights[lane];
            of[lane].dim(scene, media.of(lane), t[lane], one);
            weights.set(lane, one);
        });
        weight = weights.all();
    }
};

}  // namespace cistula
