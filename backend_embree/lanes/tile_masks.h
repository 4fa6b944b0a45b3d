// The tile renderers of one number type and instruction set, for the effect masks of lanes.
#pragma once

#include <atomic>

#include "backend_embree/lanes/lane_rays.h"
#include "backend_embree/lanes/tile_functions.h"
#include "cistula/lanes/lane_tile.h"

namespace cistula {

/// A LaneTile of any effect mask.
class AnyTile {
  public:
    virtual ~AnyTile() = default;
    virtual void add(const LanePixel& pixel) = 0;
    virtual void render(const std::atomic<bool>& stop, RayCounts& rays, uint32_t& flags) = 0;
};

template <class Real, class E, bool by_sample = false>
class MaskTile : public AnyTile {
  public:
    MaskTile(const LaneScene<ScalarOf<Real>>& scene, const FrameView& frame) : tile_(scene, frame) {}

    void add(const LanePixel& pixel) override { tile_.add(pixel); }
    void render(const std::atomic<bool>& stop, RayCounts& rays, uint32_t& flags) override {
        tile_.render([&] { return stop.load(std::memory_order_relaxed); }, rays, flags);
    }

  private:
    LaneTile<Real, E, by_sample> tile_;
};

/// The tile of a mask without a budget, or of layered_mask.
template <class Real, int place = 0>
AnyTile* make_mask_tile(int mask, const LaneScene<ScalarOf<Real>>& scene, const FrameView& frame) {
    if (mask == layered_mask) return new MaskTile<Real, Effects<effect_masks[layered_mask]>>(scene, frame);
    if constexpr (place + 1 < lane_mask_count)
        if (mask > lane_masks[place]) return make_mask_tile<Real, place + 1>(mask, scene, frame);
    return new MaskTile<Real, Effects<effect_masks[lane_masks[place]]>>(scene, frame);
}

/// The functions of a number type of lanes.
template <class Real>
constexpr TileFunctions tile_functions_of() {
    using Scene = LaneScene<ScalarOf<Real>>;
    TileFunctions functions{};
    functions.lanes = LaneTraits<Real>::lanes;
    functions.make = [](int mask, const void* scene, const void* frame) -> void* {
        return make_mask_tile<Real>(mask, *static_cast<const Scene*>(scene), *static_cast<const FrameView*>(frame));
    };
    functions.make_by_sample = [](const void* scene, const void* frame) -> void* {
        AnyTile* tile = new MaskTile<Real, Effects<effect_masks[limited_mask]>, true>(
            *static_cast<const Scene*>(scene), *static_cast<const FrameView*>(frame));
        return tile;
    };
    functions.add = [](void* tile, const void* pixel) {
        static_cast<AnyTile*>(tile)->add(*static_cast<const LanePixel*>(pixel));
    };
    functions.render = [](void* tile, const void* stop, void* rays, uint32_t* flags) {
        static_cast<AnyTile*>(tile)->render(*static_cast<const std::atomic<bool>*>(stop),
                                            *static_cast<RayCounts*>(rays), *flags);
    };
    functions.destroy = [](void* tile) { delete static_cast<AnyTile*>(tile); };
    using T = ScalarOf<Real>;
    functions.closest = [](const void* scene, const void* rays, int count, void* hits) {
        LaneRayQueries<Real>::closest(*static_cast<const Scene*>(scene), static_cast<const Ray<T>*>(rays), count,
                                      static_cast<Hit<T>*>(hits));
    };
    functions.transmittance = [](const void* scene, const void* shadows, int count, void* shares) {
        LaneRayQueries<Real>::transmittance(*static_cast<const Scene*>(scene),
                                            static_cast<const ShadowRay<T>*>(shadows), count,
                                            static_cast<Vec3<T>*>(shares));
    };
    return functions;
}

}  // namespace cistula
