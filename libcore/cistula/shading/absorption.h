// Absorption along a ray, as signed integer sums over its crossings, so that faces at which no medium changes leave
// every bit unchanged (Beer-Lambert; docs/rules.md, 6).
#pragma once

#include "cistula/geometry/ray.h"
#include "cistula/model/scene_view.h"
#include "cistula/numerics/transmittance.h"

namespace cistula {

/// Absorption along a ray from begin() to dim(). The `false` specialization does nothing, for scenes without
/// absorption. Lanes: whether the ray is of lanes (lane_absorption.h), or any other number type.
template <bool, class Lanes = float>
struct Absorption {
    PathSum sum[3];

    /// Adds the optical depth to the media of a ray from t on (sign -1) or up to t (sign 1).
    template <class Real, class Media, class Scene>
    CISTULA_INLINE void add_all(const Scene& scene, const Media& media, Real t, int sign) {
        media.for_each([&](uint32_t solid, int count) { add(scene, solid, count, t, sign); });
    }

    template <class Real, class Scene>
    CISTULA_INLINE void add(const Scene& scene, uint32_t solid, int count, Real t, int sign) {
        const Vec3<Real>& sigma = scene.materials[scene.solids[solid].material].absorption;
        for (int c = 0; c < 3; ++c)
            sum[c].add(count < 0 ? -sign : sign, double(sigma[c]) * (count < 0 ? -count : count), double(t),
                       4 * double(scene.extent));
    }

    template <class Real, class Media, class Scene>
    CISTULA_INLINE void begin(const Scene& scene, const Media& media, Real t) {
        for (PathSum& s : sum) s = PathSum();
        if (t > Real(0)) add_all(scene, media, t, -1);
    }

    /// Records a face that the ray passes without shading.
    template <class Real, class Scene>
    CISTULA_INLINE void cross(const Scene& scene, uint64_t key, Real t) {
        const int change = media_change(key_kind(key));
        if (change != 0) add(scene, key_solid(key), 1, t, -change);
    }

    /// Multiplies the throughput `weight` by the transmittance up to t.
    template <class Real, class Media, class Scene>
    CISTULA_INLINE void dim(const Scene& scene, const Media& media, Real t, Vec3<Real>& weight) {
        add_all(scene, media, t, 1);
        for (int c = 0; c < 3; ++c)
            if (const uint64_t loss = sum[c].loss(); loss != 0) weight[c] *= transmittance_of<Real>(loss);
    }
};

template <class Lanes>
struct Absorption<false, Lanes> {
    template <class Real, class Media, class Scene, class... Who>
    CISTULA_INLINE void begin(const Scene&, const Media&, const Real&, const Who&...) {}
    template <class Real, class Scene>
    CISTULA_INLINE void cross(const Scene&, uint64_t, const Real&) {}
    template <class Real, class Media, class Scene>
    CISTULA_INLINE void change(const Scene&, const Media&, const Media&, const Real&, const MaskOf<Real>&) {}
    template <class Real, class Media, class Weight, class Scene, class... Who>
    CISTULA_INLINE void dim(const Scene&, const Media&, const Real&, Weight&, const Who&...) {}
};

}  // namespace cistula
