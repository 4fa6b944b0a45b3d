// Tiles of a frame rendered in lanes, by the widest instruction set that the processor has.
#pragma once

#include <atomic>
#include <memory>

#include "backend_embree/lanes/tile_functions.h"
#include "cistula/transport/pixel.h"

namespace cistula {

/// Renders tiles, one after the other.
class TileRenderer {
  public:
    /// `mask`: index in effect_masks. The scene, a LaneScene of the precision of `functions`, and the frame must
    /// outlive the renderer.
    TileRenderer(const TileFunctions& functions, int mask, const void* scene, const FrameView& frame)
        : functions_(functions), tile_(functions.make(mask, scene, &frame), functions.destroy) {}

    /// Adds a pixel of the frame to the tile.
    void add(int x, int y, PixelRecord& record) { functions_.add(tile_.get(), x, y, &record); }
    /// Renders the tile's pixels, unless it is stopped, adds what they count, and begins a new tile.
    void render(const std::atomic<bool>& stop, RayCounts& rays, uint32_t& flags) {
        functions_.render(tile_.get(), &stop, &rays, &flags);
    }

  private:
    const TileFunctions& functions_;
    std::unique_ptr<void, void (*)(void*)> tile_;
};

/// The tile renderers for a frame with at most so many lanes (0: any number); null if the frame is traced one ray at a
/// time: with one lane, or with a cutoff, whose budget is spent in the order of one stack.
template <class Real>
const TileFunctions* tile_functions(const FrameView& frame, int most_lanes);

}  // namespace cistula
