// The tile renderers of one number type and instruction set, for every effect mask.
#pragma once

#include <array>
#include <atomic>
#include <utility>

#include "backend_embree/lanes/tile_functions.h"
#include "cistula/lanes/lane_tile.h"

namespace cistula {

/// A LaneTile of any effect mask.
class AnyTile {
  public:
    virtual ~AnyTile() = default;
    virtual void add(int x, int y, PixelRecord& record) = 0;
    virtual void render(const std::atomic<bool>& stop, RayCounts& rays, uint32_t& flags) = 0;
};

template <class Real, class E>
class MaskTile : public AnyTile {
  public:
    MaskTile(const LaneScene<ScalarOf<Real>>& scene, const FrameView& frame) : tile_(scene, frame) {}

    void add(int x, int y, PixelRecord& record) override { tile_.add(x, y, record); }
    void render(const std::atomic<bool>& stop, RayCounts& rays, uint32_t& flags) override {
        tile_.render([&] { return stop.load(std::memory_order_relaxed); }, rays, flags);
    }

  private:
    LaneTile<Real, E> tile_;
};

template <class Real>
AnyTile* make_mask_tile(int mask, const LaneScene<ScalarOf<Real>>& scene, const FrameView& frame) {
    using Make = AnyTile* (*)(const LaneScene<ScalarOf<Real>>&, const FrameView&);
    static constexpr auto table = []<size_t... i>(std::index_sequence<i...>) {
        return std::array<Make, sizeof...(i)>{[](const LaneScene<ScalarOf<Real>>& s, const FrameView& f) -> AnyTile* {
            return new MaskTile<Real, Effects<effect_masks[i]>>(s, f);
        }...};
    }
    (std::make_index_sequence<effect_mask_count>());
    return table[size_t(mask)](scene, frame);
}

/// The functions of a number type of lanes.
template <class Real>
constexpr TileFunctions tile_functions_of() {
    return {LaneTraits<Real>::lanes,
            [](int mask, const void* scene, const void* frame) -> void* {
                return make_mask_tile<Real>(mask, *static_cast<const LaneScene<ScalarOf<Real>>*>(scene),
                                            *static_cast<const FrameView*>(frame));
            },
            [](void* tile, int x, int y, void* record) {
                static_cast<AnyTile*>(tile)->add(x, y, *static_cast<PixelRecord*>(record));
            },
            [](void* tile, const void* stop, void* rays, uint32_t* flags) {
                static_cast<AnyTile*>(tile)->render(*static_cast<const std::atomic<bool>*>(stop),
                                                    *static_cast<RayCounts*>(rays), *flags);
            },
            [](void* tile) { delete static_cast<AnyTile*>(tile); }};
}

}  // namespace cistula
