// What the primary rays in a register meet first.
#pragma once

#include "cistula/lanes/lane_contact.h"
#include "cistula/lanes/lane_sums.h"
#include "cistula/lanes/lane_surface.h"
#include "cistula/transport/pixel.h"

namespace cistula {

/// Records first hits lane by lane, in pixels and, with `layers`, in their layers.
template <class Real, bool layers>
struct LaneFirstSeen {
    static constexpr int lanes = LaneTraits<Real>::lanes;
    using T = ScalarOf<Real>;

    const LaneScene<T>& scene;
    const FrameView& frame;
    uint32_t& flags;
    LanePixel* of[lanes];
    PixelWork work[lanes];  // start and facing of samples in the middle of their pixels
    uint32_t middle = 0;    // the lanes of these

    CISTULA_INLINE void surface(const Hit<Real>& hit, const Surface<Real>& s, const MaskOf<Real>& active) const {
        for_each_lane(active, [&](int lane) {
            const uint32_t number = scene.numbers[uint32_t(key_solid(hit.key)[lane])];
            Hit<T> one;
            one.t = hit.t[lane];
            one.key = make_key(CrossingKind::enter, number, 0);
            Surface<T> met;
            met.normal = lane_of(s.normal, lane);
            met.shading = lane_of(s.shading, lane);
            seen(lane).surface(one, met);
            if constexpr (layers) {
                const auto material = uint32_t(s.material.number[lane]);
                const bool textured = scene.materials[material].texture >= 0;
                const Vec2<T> uv = textured ? texture_uv(scene, lane_of(hit, lane), met.normal) : Vec2<T>();
                layered(lane).enter(number, lane_of(s.point, lane), one.t, uv, lane_of(s.color, lane), material + 1);
            }
        });
    }
    template <class Media>
    CISTULA_INLINE void light(const LaneScene<T>&, const VisibleLightHit<Real>& hit, const Ray<Real, Media>& ray,
                              const MaskOf<Real>& active) const {
        for_each_lane(active, [&](int lane) {
            const VisibleLightHit<T> one{hit.t[lane], uint32_t(hit.light[lane])};
            if constexpr (layers)
                layered(lane).light(scene, one, lane_of(ray, lane));
            else
                seen(lane).light(scene, one, lane_of(ray, lane));
        });
    }

  private:
    CISTULA_INLINE FirstSeen<T> seen(int lane) const {
        return {frame, work[lane], *of[lane]->record, (middle >> lane & 1u) != 0};
    }
    CISTULA_INLINE LayeredFirstSeen<T, LaneScene<T>> layered(int lane) const {
        return {seen(lane), scene, frame.layers, of[lane]->layers, flags};
    }
};

}  // namespace cistula
