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
    CISTULA_INLINE void begin(const Scene& scene, const Media& media, const Real& t, const MaskOf<Real>& active) {
        summed = false;
        if (!scene.absorbing.any) return;
        const MaskOf<Real> from = active & (t > Real(0)) & absorbs(scene, media);
        if (any(from)) add(scene, media, t, -1, from);
    }

    /// Records that rays pass faces at t without shading, which changes the media around them.
    template <class Media, class Scene>
    CISTULA_INLINE void change(const Scene& scene, const Media& before, const Media& beyond, const Real& t,
                               const MaskOf<Real>& active) {
        if (!scene.absorbing.any) return;
        for_each_lane(active, [&](int lane) {
            const InteriorSet from = before.of(lane);
            const InteriorSet to = beyond.of(lane);
            clear(lane);
            of[lane].add_all(scene, from.among([&](uint32_t i) { return !to.contains(i); }), t[lane], 1);
            of[lane].add_all(scene, to.among([&](uint32_t i) { return !from.contains(i); }), t[lane], -1);
        });
    }

    template <class Media, class Scene>
    CISTULA_INLINE void dim(const Scene& scene, const Media& media, const Real& t, Vec3<Real>& weight,
                            const MaskOf<Real>& active) {
        if (!scene.absorbing.any) return;
        const MaskOf<Real> inside = active & absorbs(scene, media);
        if (any(inside | (active & summed))) dim_inside(scene, media, t, weight, inside, active);
    }

  private:
    template <class Media, class Scene>
    CISTULA_INLINE static MaskOf<Real> absorbs(const Scene& scene, const Media& media) {
        return media.among(scene.absorbing) != 0;
    }
    CISTULA_INLINE void clear(int lane) {
        if ((summed.bits() >> lane & 1u) != 0) return;
        for (PathSum& sum : of[lane].sum) sum = PathSum();
        summed |= MaskOf<Real>::of_bits(1u << lane);
    }
    template <class Media, class Scene>
    CISTULA_NOINLINE void add(const Scene& scene, const Media& media, const Real& t, int sign,
                              const MaskOf<Real>& active) {
        for_each_lane(active, [&](int lane) {
            clear(lane);
            of[lane].add_all(scene, media.of(lane), t[lane], sign);
        });
    }

    template <class Media, class Scene>
    CISTULA_NOINLINE void dim_inside(const Scene& scene, const Media& media, const Real& t, Vec3<Real>& weight,
                                     const MaskOf<Real>& inside, const MaskOf<Real>& active) {
        MaskOf<Real> single = active & summed;
        const double farthest = 4 * double(scene.extent);
        Vec3<Real> sigma(Real(0));
        for_each_value(inside & !summed, media.among(scene.absorbing), [&](uint32_t bits, const MaskOf<Real>& same) {
            const InteriorSet solids{bits, media.named};
            const Vec3<T>& own = scene.materials[scene.solids[solids.last()].material].absorption;
            assign_where(same, sigma, spread<Real>(own));
            if (solids.only() == no_solid || !(double(largest_component(own)) * farthest < 0x1p20)) single |= same;
        });
        const MaskOf<Real> together = inside & !single;
        if (any(together)) {
            const Wide length = clamped(Wide(t), Wide(0.0), Wide(farthest));
            for (int c = 0; c < 3; ++c) {
                const Wide depth = floor_of(Wide(sigma[c]) * length * Wide(0x1p32) + Wide(0.5)) * Wide(0x1p-32);
                const Real share = uncached_transmittance<T>(absorption_loss(depth));
                assign_where(together, weight[c], weight[c] * share);
            }
        }
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
